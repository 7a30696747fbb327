#include "help_text.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/version.hpp"

#include "names.hpp"
#include "system/program_start.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace lamella::app {
namespace {

constexpr std::size_t usual_width = 80;
constexpr std::size_t least_width = 40;
constexpr std::size_t most_width = 100; // longer lines are hard to read

/// Wraps words into lines of at most `width`; each line after the first is indented by `indent` spaces. The
/// first one begins at `column`.
std::string wrapped(std::string_view text, std::size_t width, std::size_t indent, std::size_t column) {
    std::string out;
    bool begins = true;
    while (!text.empty()) {
        const std::size_t end = text.find(' ');
        const std::string_view word = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (!begins && column + 1 + word.size() > width) {
            out.append(1, '\n').append(indent, ' ');
            column = indent;
        } else if (!begins) {
            out += ' ';
            ++column;
        }
        out += word;
        column += word.size();
        begins = false;
    }
    return out;
}

std::string paragraph(std::string_view text, std::size_t width) {
    return wrapped(text, width, 0, 0) + "\n";
}

/// Returns a command line; one that is too long goes on in lines that are indented more.
std::string line_of_command(std::string_view text, std::size_t width) {
    constexpr std::size_t indent = 2;
    constexpr std::size_t of_next_lines = 6;
    return std::string(indent, ' ') + wrapped(text, width, of_next_lines, indent) + "\n";
}

/// Returns a name and its description side by side. A narrow text has the description below the name.
std::string entry(std::string_view header, std::string_view body, std::size_t indent, std::size_t width) {
    constexpr std::size_t least_for_body = 26;
    constexpr std::size_t below = 6;
    if (indent + least_for_body > width)
        return fmt::format("  {}\n{}{}\n", header, std::string(below, ' '),
                           wrapped(body, width, below, below));
    if (header.size() + 4 > indent)
        return fmt::format("  {}\n{}{}\n", header, std::string(indent, ' '),
                           wrapped(body, width, indent, indent));
    return fmt::format("  {:<{}}{}\n", header, indent - 2, wrapped(body, width, indent, indent));
}

constexpr std::size_t indent_of_options = 28;

std::string section_text(const OptionGroup& group, std::size_t width) {
    std::string text = paragraph(group.title + ":", width);
    if (!group.note.empty())
        text += "  " + wrapped(group.note, width, 2, 2) + "\n";
    for (const Option& option : group.options)
        text += entry(option_header(option), option_body(option), indent_of_options, width);
    return text;
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
        text += fmt::format(" (default: {})", option.preset);
    return text;
}

std::string operand_body(const Operand& operand) {
    return operand.choices.empty() ? operand.help
                                   : fmt::format("{}: {}", operand.help, fmt::join(operand.choices, ", "));
}

std::size_t help_width() {
    const char* const given = std::getenv("COLUMNS");
    std::size_t width = given != nullptr ? std::strtoul(given, nullptr, 10) : 0;
    if (width == 0)
        width = output_columns().value_or(usual_width);
    return std::clamp(width, least_width, most_width);
}

std::string program_help(std::span<const Command> commands, std::size_t width) {
    std::string text =
        paragraph(fmt::format("lamella {}: cuts triangle meshes into layers of closed contours", version()),
                  width) +
        "\nusage: lamella COMMAND [options]\n\n";
    constexpr std::size_t indent_of_commands = 14;
    for (const Command& command : commands)
        text += entry(command.name, command.summary, indent_of_commands, width);
    text += "\n" +
            paragraph("To begin with, make a chess rook, inspect it, slice it, check the result and convert "
                      "it:",
                      width) +
            "\n";
    for (const std::string_view line :
         {"lamella make rook", "lamella info rook.stl",
          "lamella slice rook.stl -o rook.cli --layer-height 0.1", "lamella verify rook.cli --mesh rook.stl",
          "lamella convert rook.cli rook.svg"})
        text += line_of_command(line, width);
    text += "\n";
    for (const std::string_view sentence :
         {"lamella COMMAND --help describes a command, lamella help COMMAND SECTION a part of its options, "
          "and "
          "lamella help --man all commands.",
          "lamella --version (or -V, version) prints the version.",
          "Lengths are in millimetres, angles in degrees; - is standard input or output."})
        text += paragraph(sentence, width);
    text += "\nExit codes:\n";
    constexpr std::size_t indent_of_meaning = 7;
    for (const ExitCode& code : exit_codes())
        text += fmt::format("  {:>3}  {}\n", code.code,
                            wrapped(code.meaning, width, indent_of_meaning, indent_of_meaning));
    return text;
}

std::string command_help(const Command& command, std::size_t width) {
    constexpr std::size_t indent_of_usage = 6;
    std::string text = paragraph(fmt::format("lamella {}: {}", command.name, command.summary), width) + "\n" +
                       wrapped(fmt::format("usage: lamella {} {}", command.name, synopsis(command)), width,
                               indent_of_usage, 0) +
                       "\n\n" + paragraph(command.description, width);
    if (!command.operands.empty())
        text += "\n";
    for (const Operand& operand : command.operands)
        text += entry(operand.placeholder, operand_body(operand), indent_of_options, width);
    if (constexpr std::size_t many = 4; command.groups.size() > many)
        text += "\n" + paragraph(fmt::format("lamella help {} SECTION prints one section of the options: {}.",
                                             command.name, fmt::join(names_of(command.groups), ", ")),
                                 width);
    for (const OptionGroup& group : command.groups)
        text += "\n" + section_text(group, width);
    if (!command.examples.empty())
        text += "\nExamples:\n";
    constexpr std::size_t indent_of_effect = 6;
    for (const Example& example : command.examples)
        text += line_of_command(example.line, width) + std::string(indent_of_effect, ' ') +
                wrapped(example.effect, width, indent_of_effect, indent_of_effect) + "\n";
    return text;
}

std::string section_help(const Command& command, std::string_view name, std::size_t width) {
    const auto group = std::find_if(command.groups.begin(), command.groups.end(),
                                    [&](const OptionGroup& one) { return one.name == name; });
    if (group == command.groups.end())
        throw Error(ErrorKind::usage,
                    fmt::format("the help of lamella {} has no section {}; its sections are {}", command.name,
                                name, fmt::join(names_of(command.groups), ", ")));
    return section_text(*group, width);
}

} // namespace lamella::app
