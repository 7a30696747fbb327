// One job on several processes or machines: mpirun -n 4 lamella-mpi slice part.stl -o part.cli

#include "lamella/core/error.hpp"

#include "commands.hpp"
#include "crash.hpp"
#include "interrupt.hpp"
#include "mpi_ranks.hpp"
#include "program.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <string>
#include <vector>

using namespace lamella::app;
using lamella::RankFigures;

namespace {

nlohmann::ordered_json ranks_json(const std::vector<RankFigures>& figures) {
    nlohmann::ordered_json ranks = nlohmann::ordered_json::array();
    for (const RankFigures& rank : figures)
        ranks.push_back({{"triangles_read", rank.triangles_read},
                         {"triangles_sliced", rank.triangles_sliced},
                         {"bytes_sent", rank.bytes_sent},
                         {"planes", rank.planes},
                         {"points", rank.points},
                         {"seconds",
                          {{"read", rank.read_seconds},
                           {"exchange", rank.exchange_seconds},
                           {"slice", rank.slice_seconds},
                           {"write", rank.write_seconds}}}});
    return ranks;
}

Slicing by_all(MpiRanks& ranks, std::vector<RankFigures>& figures) {
    Slicing together;
    together.slice = [&](const lamella::FileJob& job, const lamella::Execution& execution) {
        return slice_file(job, ranks, execution, &figures);
    };
    together.tells = ranks.rank() == 0;
    together.add_to_stats = [&](nlohmann::ordered_json& stats) {
        stats["ranks"] = ranks_json(figures);
    };
    together.many_files = false;
    return together;
}

} // namespace

int main(int argc, char** argv) {
    prepare_for_crashes();
    block_interrupts(); // before MPI has threads of its own
    MpiRanks ranks;
    std::vector<RankFigures> figures;
    const int code = run_program({slice_command(by_all(ranks, figures))},
                                 std::vector<std::string>(argv + 1, argv + argc), ranks.rank() == 0);
    // All fail together, but for what nobody foresaw: then the others wait for this one in vain.
    constexpr std::chrono::seconds patience{10};
    constexpr std::chrono::hours for_ever{24 * 365};
    if (!ranks.meet(code == 0 ? for_ever : patience))
        MpiRanks::abort(code);
    return code;
}
