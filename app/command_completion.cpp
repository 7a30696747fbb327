#include "command_line.hpp"
#include "commands.hpp"
#include "completion.hpp"
#include "text_file.hpp"

#include <memory>
#include <string>
#include <vector>

namespace lamella::app {

Command completion_command() {
    const auto shell = std::make_shared<std::string>();
    return {.name = "completion",
            .summary = "print a script that completes commands in a shell",
            .description =
                "Prints a script for bash, zsh or fish. An installed Lamella has put it in place already.",
            .operands = {{.placeholder = "SHELL",
                          .help = "which shell",
                          .choices = {"bash", "zsh", "fish"},
                          .set =
                              [shell](const std::string& text) {
                                  *shell = text;
                              }}},
            .groups = {common_options(false)},
            .examples = {{"source <(lamella completion bash)", "for this shell only"},
                         {"lamella completion bash > ~/.local/share/bash-completion/completions/lamella",
                          "for good"}},
            .run = [shell](const Context& /*context*/) {
                const std::vector<Command> commands = all_commands();
                print(*shell == "bash"  ? bash_completion(commands)
                      : *shell == "zsh" ? zsh_completion(commands)
                                        : fish_completion(commands));
                return 0;
            }};
}

} // namespace lamella::app
