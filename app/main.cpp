#include "commands.hpp"
#include "crash.hpp"
#include "interrupt.hpp"
#include "program.hpp"
#include "standard_streams.hpp"

#include <string>
#include <vector>

int main(int argc, char** argv) {
    lamella::app::block_interrupts(); // from here on, interrupts end the program in an orderly manner
    lamella::app::reserve_standard_streams();
    lamella::app::prepare_for_crashes();
    return lamella::app::run_program(lamella::app::all_commands(),
                                     std::vector<std::string>(argv + 1, argv + argc));
}
