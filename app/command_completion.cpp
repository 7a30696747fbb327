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
    return {
        .name = "completion",
        .summary = "print a script that completes commands in a shell",
        .description =
            "Prints a script for a shell, which completes commands, options and their values. Packages and "
            "make install put the scripts for bash, zsh and fish into their folders.",
        .operands = {{.placeholder = "SHELL",
                      .help = "the shell",
                      .choices = {"bash", "zsh", "fish", "powershell"},
                      .set =
                          [shell](const std::string& text) {
                              *shell = text;
                          }}},
        .groups = {common_options(false)},
        .examples = {{"source <(lamella completion bash)",
                      "for bash: in this shell, or as a line of ~/.bashrc in all"},
                     {"lamella completion powershell | Out-String | Invoke-Expression",
                      "for PowerShell: in this shell, or as a line of $PROFILE in all"}},
        .run = [shell](const Context& /*context*/) {
            const std::vector<Command> commands = all_commands();
            print(*shell == "bash"   ? bash_completion(commands)
                  : *shell == "zsh"  ? zsh_completion(commands)
                  : *shell == "fish" ? fish_completion(commands)
                                     : powershell_completion(commands));
            return 0;
        }};
}

} // namespace lamella::app
