#include "commands.hpp"
#include "crash.hpp"
#include "program.hpp"
#include "system/program_ending.hpp"
#include "system/program_start.hpp"
#include "system/program_workers.hpp"

int main(int argc, char** argv) {
    lamella::block_interrupts(); // from here on, interrupts end the program in an orderly manner
    lamella::prepare_standard_streams();
    lamella::app::prepare_for_crashes();
    return lamella::app::run_program(lamella::app::all_commands(), lamella::program_arguments(argc, argv),
                                     !lamella::is_started_as_worker());
}
