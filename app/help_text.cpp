#include "help_text.hpp"

#include "lamella/core/version.hpp"

#include "numbers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace lamella::app {
namespace {

constexpr std::size_t width = 80;

/// Wraps words into lines of at most `width`; each line after the first is indented by `indent` spaces.
std::string wrapped(std::string_view text, std::size_t indent) {
    std::string out;
    std::size_t column = indent;
    while (!text.empty()) {
        const std::size_t end = text.find(' ');
        const std::string_view word = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (column > indent && column + 1 + word.size() > width) {
            out.append(1, '\n').append(indent, ' ');
            column = indent;
        } else if (column > indent) {
            out += ' ';
            ++column;
        }
        out += word;
        column += word.size();
    }
    return out;
}

std::string entry(std::string_view header, std::string_view body, std::size_t indent) {
    if (header.size() + 4 > indent)
        return fmt::format("  {}\n{}{}\n", header, std::string(indent, ' '), wrapped(body, indent));
    return fmt::format("  {:<{}}{}\n", header, indent - 2, wrapped(body, indent));
}

} // namespace

std::string synopsis(const Command& command) {
    std::string text;
    for (const Operand& operand : command.operands)
        text += fmt::format("{}{}{}{} ", operand.required ? "" : "[", operand.placeholder,
                            operand.repeated ? "..." : "", operand.required ? "" : "]");
    return text + "[options]";
}

std::string option_header(const Option& option) {
    std::string text = option.letter != 0 ? fmt::format("-{}, ", option.letter) : "";
    text.append("--").append(option.name);
    if (option.kind != ValueKind::flag)
        text.append(" ").append(option.placeholder);
    return text;
}

std::string option_body(const Option& option) {
    std::string text = option.help;
    if (!option.choices.empty())
        text += fmt::format(": {}", fmt::join(option.choices, ", "));
    if (!option.preset.empty())
        text += fmt::format(" [{}]", option.preset);
    return text;
}

std::string program_help(std::span<const Command> commands) {
    std::string text = fmt::format("lamella {}: triangle mesh in, closed contours out, layer by layer\n\n"
                                   "usage: lamella COMMAND [options]\n\n",
                                   version());
    for (const Command& command : commands)
        text += entry(command.name, command.summary, 14);
    text += "\nTo begin with, make a chess rook, look at it, slice it and check the result:\n\n"
            "  lamella make rook\n"
            "  lamella info rook.stl\n"
            "  lamella slice rook.stl -o rook.cli --layer-height 0.1\n"
            "  lamella verify rook.cli --mesh rook.stl\n"
            "  lamella convert rook.cli rook.svg\n\n"
            "lamella COMMAND --help describes a command, lamella help --man all commands.\n"
            "lamella --version (or -V, version) prints the version.\n"
            "Lengths are millimetres, angles are degrees, - is standard input or output.\n\n"
            "exit codes:\n";
    for (const ExitCode& code : exit_codes())
        text += fmt::format("  {:>3}  {}\n", code.code, code.meaning);
    return text;
}

std::string command_help(const Command& command) {
    std::string text =
        fmt::format("lamella {}: {}\n\nusage: lamella {} {}\n\n{}\n", command.name, command.summary,
                    command.name, synopsis(command), wrapped(command.description, 0));
    if (!command.operands.empty())
        text += "\n";
    constexpr std::size_t indent = 28;
    for (const Operand& operand : command.operands)
        text += entry(operand.placeholder,
                      operand.choices.empty()
                          ? operand.help
                          : fmt::format("{}: {}", operand.help, fmt::join(operand.choices, ", ")),
                      indent);
    for (const OptionGroup& group : command.groups) {
        text += fmt::format("\n{}:\n", group.title);
        for (const Option& option : group.options)
            text += entry(option_header(option), option_body(option), indent);
    }
    if (!command.examples.empty())
        text += "\nExamples:\n";
    for (const Example& example : command.examples)
        text += fmt::format("  {}\n      {}\n", example.line, example.effect);
    return text;
}

} // namespace lamella::app
