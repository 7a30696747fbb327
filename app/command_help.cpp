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
        std::string section;
        bool man = false;
    };
    const auto arguments = std::make_shared<HelpArguments>();
    return {
        .name = "help",
        .summary = "print help on the program or a command, or the man page",
        .description = "Prints the help of the program, of a command, or of one section of its options.",
        .operands = {{.placeholder = "COMMAND",
                      .help = "the command to describe",
                      .choices = {"slice", "info", "verify", "convert", "make", "completion", "help"},
                      .required = false,
                      .set =
                          [arguments](const std::string& text) {
                              arguments->topic = text;
                          }},
                     {.placeholder = "SECTION",
                      .help = "the section of its options",
                      .choices = {"output"},
                      .required = false,
                      .set =
                          [arguments](const std::string& text) {
                              arguments->section = text;
                          }}},
        .groups = {{"output", "Output", {flag("man", "print the man page (troff source)", arguments->man)}},
                   common_options(false)},
        .examples = {{"lamella help slice", "the same as lamella slice --help"},
                     {"lamella help slice scan", "only the options of scan vectors"},
                     {"lamella help --man | man -l -", "the man page, which describes all commands"}},
        .run = [arguments](const Context& /*context*/) {
            const std::vector<Command> commands = all_commands();
            const auto topic = std::find_if(commands.begin(), commands.end(),
                                            [&](const Command& one) { return one.name == arguments->topic; });
            if (arguments->man)
                print(manual_page(commands));
            else if (topic == commands.end())
                print(program_help(commands, help_width()));
            else if (arguments->section.empty())
                print(command_help(*topic, help_width()));
            else
                print(section_help(*topic, arguments->section, help_width()));
            return 0;
        }};
}

} // namespace lamella::app
