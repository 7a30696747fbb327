// One job on several processes or machines: mpirun -n 4 lamella-mpi slice part.stl -o part.cli

#include "lamella/core/error.hpp"

#include "commands.hpp"
#include "crash.hpp"
#include "interrupt.hpp"
#include "mpi_processes.hpp"
#include "program.hpp"
#include "standard_streams.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <string>
#include <vector>

using namespace lamella::app;
using lamella::ProcessFigures;

namespace {

Json processes_json(const std::vector<ProcessFigures>& figures) {
    Json processes = Json::array();
    for (const ProcessFigures& one : figures)
        processes.push_back({{"triangles_read", one.triangles_read},
                             {"triangles_sliced", one.triangles_sliced},
                             {"bytes_sent", one.bytes_sent},
                             {"planes", one.planes},
                             {"points", one.points},
                             {"seconds",
                              {{"read", one.read_seconds},
                               {"exchange", one.exchange_seconds},
                               {"slice", one.slice_seconds},
                               {"write", one.write_seconds}}}});
    return processes;
}

Slicing by_all(MpiProcesses& processes, std::vector<ProcessFigures>& figures) {
    Slicing together;
    together.slice = [&](const lamella::FileJob& job, const lamella::Execution& execution) {
        lamella::FileResult result = slice_file(job, execution, processes);
        figures = result.processes;
        return result;
    };
    together.tells = processes.process() == 0;
    together.add_to_stats = [&](Json& stats) {
        stats["processes"] = processes_json(figures);
    };
    together.many_files = false;
    return together;
}

} // namespace

int main(int argc, char** argv) {
    reserve_standard_streams();
    prepare_for_crashes();
    block_interrupts(); // before MPI has threads of its own
    MpiProcesses processes;
    std::vector<ProcessFigures> figures;
    const int code = run_program({slice_command(by_all(processes, figures))},
                                 std::vector<std::string>(argv + 1, argv + argc), processes.process() == 0);
    // All fail together, but for what nobody foresaw: then the others wait for this one in vain.
    constexpr std::chrono::seconds patience{10};
    constexpr std::chrono::hours for_ever{24 * 365};
    if (!processes.meet(code == 0 ? for_ever : patience))
        MpiProcesses::abort(code);
    return code;
}
