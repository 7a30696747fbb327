// One job on several processes or machines: mpirun -n 4 lamella-mpi slice part.stl -o part.cli

#include "commands.hpp"
#include "crash.hpp"
#include "mpi_processes.hpp"
#include "program.hpp"
#include "system/program_ending.hpp"
#include "system/program_start.hpp"

#include <chrono>

using namespace lamella::app;

int main(int argc, char** argv) {
    lamella::block_interrupts(); // from here on, interrupts end the program in an orderly manner, even if
                                 // threads of MPI receive them
    lamella::prepare_standard_streams();
    prepare_for_crashes();
    MpiProcesses processes;
    const int code = run_program({slice_command(&processes)}, lamella::program_arguments(argc, argv),
                                 processes.process() == 0);
    // All processes fail together, except for unforeseen errors, after which the others would wait for this
    // one in vain.
    constexpr std::chrono::seconds patience{10};
    constexpr std::chrono::hours for_ever{24 * 365};
    if (!processes.meet(code == 0 ? for_ever : patience))
        MpiProcesses::abort(code);
    return code;
}
