// lamella-mpi: one job on several processes or machines, such as: mpirun -n 4 lamella-mpi slice part.stl -o
// part.cli

#include "lamella/core/error.hpp"

#include "commands.hpp"
#include "crash.hpp"
#include "interrupt.hpp"
#include "mpi_ranks.hpp"
#include "program.hpp"

#include <chrono>
#include <string>
#include <vector>

using namespace lamella::app;

int main(int argc, char** argv) {
    prepare_for_crashes();
    block_interrupts(); // before MPI has threads of its own
    MpiRanks ranks;
    const bool first = ranks.rank() == 0;
    const Slicing together{
        .slice = [&](const lamella::FileJob& job,
                     const lamella::Execution& execution) { return slice_file(job, ranks, execution); },
        .tells = first,
        .many_files = false};
    const int code =
        run_program({slice_command(together)}, std::vector<std::string>(argv + 1, argv + argc), first);
    // All fail together, but for what nobody foresaw: then the others wait for this one in vain.
    constexpr std::chrono::seconds patience{10};
    if (code != 0 && !ranks.meet(patience))
        MpiRanks::abort(code);
    if (code == 0)
        static_cast<void>(ranks.meet(std::chrono::hours{24 * 365}));
    return code;
}
