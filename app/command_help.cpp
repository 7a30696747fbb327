#include "command_line.hpp"
#include "commands.hpp"
#include "help_text.hpp"
#include "manual.hpp"
#include "options.hpp"
#include "text_file.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace lamella::app {

Command help_command() {
    struct HelpArguments {
        std::string topic;
        bool man = false;
    };
    const auto arguments = std::make_shared<HelpArguments>();
    return {.name = "help",
            .summary = "help on the program or a command; the man page",
            .description = "Prints the help of a command, or of the program.",
            .operands = {{.placeholder = "COMMAND",
                          .help = "the command",
                          .choices = {"slice", "info", "verify", "convert", "make", "completion", "help"},
                          .required = false,
                          .set =
                              [arguments](const std::string& text) {
                                  arguments->topic = text;
                              }}},
            .groups = {{"What is printed", {flag("man", "the man page (troff source)", arguments->man)}},
                       common_options(false)},
            .examples = {{"lamella help slice", "the same as lamella slice --help"},
                         {"lamella help --man | man -l -", "all about all commands"}},
            .run = [arguments](const Context& /*context*/) {
                const std::vector<Command> commands = all_commands();
                const auto topic = std::find_if(commands.begin(), commands.end(), [&](const Command& one) {
                    return one.name == arguments->topic;
                });
                if (arguments->man)
                    print(manual_page(commands));
                else
                    print(topic == commands.end() ? program_help(commands) : command_help(*topic));
                return 0;
            }};
}

} // namespace lamella::app
