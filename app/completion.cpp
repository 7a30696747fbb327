#include "completion.hpp"

#include "names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>
#include <vector>

namespace lamella::app {
namespace {

std::string with_prefixes(std::string_view text, std::string_view special, std::string_view prefix) {
    std::string out;
    for (const char c : text) {
        if (special.find(c) != std::string_view::npos)
            out += fmt::format("{}{}", prefix, c);
        else
            out += c;
    }
    return out;
}

/// Returns the text for use inside single quotes.
std::string shell_quoted(std::string_view text) {
    std::string out;
    for (const char c : text)
        out += c == '\'' ? "'\\''" : std::string(1, c);
    return out;
}

std::vector<const Option*> options_of(const Command& command) {
    std::vector<const Option*> options;
    for (const OptionGroup& group : command.groups)
        for (const Option& option : group.options)
            options.push_back(&option);
    return options;
}

std::string bash_pattern(const Option& option) {
    return option.letter != 0 ? fmt::format("-{}|--{}", option.letter, option.name) : "--" + option.name;
}

/// Returns the completion of operands. Choices of the first operand are offered until one of them is present,
/// then those of the second one, or files.
std::string bash_operands(const Command& command) {
    const auto offer = [](const Operand& operand) {
        return operand.choices.empty() ? std::string("compopt -o default; return")
                                       : fmt::format("words=\"{}\"", fmt::join(operand.choices, " "));
    };
    const std::vector<Operand>& operands = command.operands;
    if (operands.empty() || operands.front().choices.empty())
        return "compopt -o default; return";
    return fmt::format("case \" ${{COMP_WORDS[*]:2:COMP_CWORD-2}} \" in *\" {} \"*) {} ;; *) {} ;; esac",
                       fmt::join(operands.front().choices, " \"*|*\" "),
                       operands.size() > 1 ? offer(operands[1]) : "return", offer(operands.front()));
}

/// Returns the branch of the case statement for one command: values of options, option names, operands.
std::string bash_case(const Command& command) {
    std::string text = fmt::format("    {})\n        case \"$previous\" in\n", command.name);
    std::vector<std::string> names;
    for (const Option* option : options_of(command)) {
        names.push_back("--" + option->name);
        if (option->kind == ValueKind::flag)
            continue;
        const std::string action = !option->choices.empty()
                                       ? fmt::format("words=\"{}\"", fmt::join(option->choices, " "))
                                   : is_file(option->kind) ? "compopt -o default; return"
                                                           : "return";
        text += fmt::format("        {}) {} ;;\n", bash_pattern(*option), action);
    }
    text += fmt::format("        *) if [[ \"$current\" == -* ]]; then words=\"{}\"; else {}; fi ;;\n"
                        "        esac ;;\n",
                        fmt::join(names, " "), bash_operands(command));
    return text;
}

std::string zsh_value(const Option& option) {
    if (option.kind == ValueKind::flag)
        return "";
    const std::string what = with_prefixes(option.placeholder, ":", "\\");
    if (!option.choices.empty())
        return fmt::format(":{}:({})", what, fmt::join(option.choices, " "));
    return fmt::format(":{}:{}", what, is_file(option.kind) ? "_files" : "");
}

std::string zsh_option(const Option& option) {
    const bool takes_value = option.kind != ValueKind::flag;
    const std::string rest =
        shell_quoted(fmt::format("[{}]{}", with_prefixes(option.help, "[]:\\", "\\"), zsh_value(option)));
    if (option.letter == 0)
        return fmt::format("'--{}{}{}'", option.name, takes_value ? "=" : "", rest);
    return fmt::format("'(-{0} --{1})'{{-{0}{2},--{1}{3}}}'{4}'", option.letter, option.name,
                       takes_value ? "+" : "", takes_value ? "=" : "", rest);
}

std::string zsh_case(const Command& command) {
    std::string text = fmt::format("    {})\n        _arguments", command.name);
    for (const Option* option : options_of(command))
        text += " \\\n            " + zsh_option(*option);
    for (std::size_t i = 0; i < command.operands.size(); ++i) {
        const Operand& operand = command.operands[i];
        text += fmt::format(" \\\n            '{}:{}:{}'", operand.repeated ? "*" : std::to_string(i + 1),
                            operand.placeholder,
                            operand.choices.empty() ? "_files"
                                                    : fmt::format("({})", fmt::join(operand.choices, " ")));
    }
    return text + "\n        ;;\n";
}

std::string fish_option(const Command& command, const Option& option) {
    std::string text = fmt::format("complete -c lamella -n '__fish_seen_subcommand_from {}' -l {}",
                                   command.name, option.name);
    if (option.letter != 0)
        text += fmt::format(" -s {}", option.letter);
    if (is_file(option.kind))
        text += " -r -F";
    else if (option.kind != ValueKind::flag)
        text += " -x";
    if (!option.choices.empty())
        text += fmt::format(" -a '{}'", fmt::join(option.choices, " "));
    return text + fmt::format(" -d '{}'\n", with_prefixes(option.help, "'\\", "\\"));
}

/// Returns the completion of operands. If there are choices, they are offered until one of them is present.
/// In all other cases files are offered.
std::string fish_operands(const Command& command) {
    const std::string here =
        fmt::format("complete -c lamella -n '__fish_seen_subcommand_from {}", command.name);
    std::string before; // the condition that choices of the operands before this one are present
    std::string text;
    for (const Operand& operand : command.operands) {
        if (operand.choices.empty()) {
            text += fmt::format("{}{}' -F\n", here, before);
        } else {
            std::vector<std::string> others = operand.choices; // the choices except the command itself (help)
            std::erase(others, command.name);
            const std::string seen = fmt::format("__fish_seen_subcommand_from {}", fmt::join(others, " "));
            text += fmt::format("{}{}; and not {}' -a '{}'\n", here, before, seen,
                                fmt::join(operand.choices, " "));
            before += "; and " + seen;
        }
    }
    return text;
}

/// Returns a list of strings of PowerShell, in single quotes.
std::string powershell_list(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words)
        text += fmt::format("{}'{}'", text.empty() ? "" : ", ", with_prefixes(word, "'", "'"));
    return fmt::format("@({})", text);
}

/// Returns the table of one command: its options with their values, and the words that it takes.
std::string powershell_command(const Command& command) {
    std::string text = fmt::format("        '{}' = @{{\n            Summary = '{}'\n            Words = @(",
                                   command.name, with_prefixes(command.summary, "'", "'"));
    // A list with one list in it needs a comma in front of that.
    const std::string_view first = command.operands.size() == 1 ? "," : "";
    for (const Operand& operand : command.operands)
        text += fmt::format("{}{}", &operand == command.operands.data() ? first : ", ",
                            powershell_list(operand.choices));
    text += ")\n            Options = @(\n";
    for (const Option* option : options_of(command))
        text += fmt::format(
            "                @{{ Name = '--{}'; Letter = '{}'; Takes = '{}'; Values = {}; Help = '{}' }}\n",
            option->name, option->letter != 0 ? fmt::format("-{}", option->letter) : "",
            option->kind == ValueKind::flag ? "" : with_prefixes(option->placeholder, "'", "'"),
            powershell_list(option->choices), with_prefixes(option->help, "'", "'"));
    return text + "            )\n        }\n";
}

} // namespace

std::string bash_completion(std::span<const Command> commands) {
    std::string text = fmt::format(
        "# bash completion for lamella; made by: lamella completion bash\n"
        "_lamella() {{\n"
        "    local current=\"${{COMP_WORDS[COMP_CWORD]}}\" previous=\"${{COMP_WORDS[COMP_CWORD-1]}}\"\n"
        "    local words=\"\"\n"
        "    COMPREPLY=()\n"
        "    # bash takes --option=value for three words\n"
        "    if [[ \"$current\" == \"=\" ]]; then\n"
        "        current=\"\"\n"
        "    elif [[ \"$previous\" == \"=\" ]] && ((COMP_CWORD > 2)); then\n"
        "        previous=\"${{COMP_WORDS[COMP_CWORD-2]}}\"\n"
        "    fi\n"
        "    if ((COMP_CWORD == 1)); then\n"
        "        COMPREPLY=($(compgen -W \"{} --help --version\" -- \"$current\"))\n"
        "        return\n"
        "    fi\n"
        "    case \"${{COMP_WORDS[1]}}\" in\n",
        fmt::join(names_of(commands), " "));
    for (const Command& command : commands)
        text += bash_case(command);
    return text + "    esac\n"
                  "    COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
                  "}\n"
                  "complete -F _lamella lamella\n";
}

std::string zsh_completion(std::span<const Command> commands) {
    std::string text = "#compdef lamella\n"
                       "# zsh completion for lamella; made by: lamella completion zsh\n"
                       "_lamella() {\n"
                       "    local -a commands\n"
                       "    commands=(\n";
    for (const Command& command : commands)
        text += fmt::format("        '{}:{}'\n", command.name,
                            shell_quoted(with_prefixes(command.summary, ":", "\\")));
    text += "    )\n"
            "    if ((CURRENT == 2)); then\n"
            "        _describe command commands\n"
            "        return\n"
            "    fi\n"
            "    local command=$words[2]\n"
            "    shift words\n"
            "    ((CURRENT--))\n"
            "    case $command in\n";
    for (const Command& command : commands)
        text += zsh_case(command);
    return text + "    esac\n"
                  "}\n"
                  "# As a file in the function path, or read by: source <(lamella completion zsh)\n"
                  "if [[ $funcstack[1] == _lamella ]]; then\n"
                  "    _lamella \"$@\"\n"
                  "else\n"
                  "    compdef _lamella lamella\n"
                  "fi\n";
}

std::string fish_completion(std::span<const Command> commands) {
    std::string text =
        "# fish completion for lamella; made by: lamella completion fish\n"
        "complete -c lamella -f\n"
        "complete -c lamella -n __fish_use_subcommand -l version -d 'print version and licence'\n";
    for (const Command& command : commands) {
        text += fmt::format("complete -c lamella -n __fish_use_subcommand -a {} -d '{}'\n", command.name,
                            with_prefixes(command.summary, "'\\", "\\"));
        text += fish_operands(command);
        for (const Option* option : options_of(command))
            text += fish_option(command, *option);
    }
    return text;
}

std::string powershell_completion(std::span<const Command> commands) {
    std::string text = "# PowerShell completion for lamella; made by: lamella completion powershell\n"
                       "Register-ArgumentCompleter -Native -CommandName lamella, lamella.exe -ScriptBlock {\n"
                       "    param($wordToComplete, $commandAst, $cursorPosition)\n"
                       "    $commands = [ordered]@{\n";
    for (const Command& command : commands)
        text += powershell_command(command);
    return text + R"(    }
    $offer = {
        param($word, $tip, $before = '')
        if ("$before$word".StartsWith($wordToComplete)) {
            [System.Management.Automation.CompletionResult]::new("$before$word", $word, 'ParameterValue', $tip)
        }
    }
    # The words in front of the one to complete.
    $words = @($commandAst.CommandElements | Where-Object { $_.Extent.EndOffset -lt $cursorPosition } |
        ForEach-Object { $_.ToString() })
    if ($words.Count -le 1) {
        foreach ($name in $commands.Keys) { & $offer $name $commands[$name].Summary }
        foreach ($name in '--help', '--version') { & $offer $name $name }
        return
    }
    $command = $commands[$words[1]]
    if ($null -eq $command) { return }
    if ($wordToComplete -match '^(--[a-z-]+)=') {
        $start = $Matches[0]
        foreach ($option in $command.Options | Where-Object { "$($_.Name)=" -eq $start }) {
            foreach ($value in $option.Values) { & $offer $value $option.Help $start }
        }
        return
    }
    $last = $words[-1]
    foreach ($option in $command.Options | Where-Object { $_.Takes -and ($_.Name -eq $last -or $_.Letter -ceq $last) }) {
        foreach ($value in $option.Values) { & $offer $value $option.Help }
        return # without values, PowerShell offers files
    }
    if ($wordToComplete.StartsWith('-')) {
        foreach ($option in $command.Options) { & $offer $option.Name $option.Help }
        return
    }
    # The words of the first argument until one of them is there, then those of the second.
    foreach ($choices in $command.Words) {
        if ($choices.Count -eq 0) { return }
        if (-not ($words | Select-Object -Skip 2 | Where-Object { $choices -contains $_ })) {
            foreach ($word in $choices) { & $offer $word $word }
            return
        }
    }
}
)";
}

} // namespace lamella::app
