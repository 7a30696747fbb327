#include "manual.hpp"

#include "lamella/core/version.hpp"
#include "lamella/slices/layer_writer.hpp"
#include "lamella/slicing/slice.hpp"

#include "help_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>

namespace lamella::app {
namespace {

/// Returns the text escaped so that troff prints it unchanged.
std::string plain(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
    }
    // A line must not begin like a troff request.
    if (out.starts_with('.') || out.starts_with('\''))
        out.insert(0, "\\&");
    return out;
}

std::string tagged(std::string_view header, std::string_view body) {
    return fmt::format(".TP\n.B {}\n{}\n", plain(header), plain(body));
}

std::string command_section(const Command& command) {
    std::string text = fmt::format(".SS lamella {}\n.B lamella {} {}\n.PP\n{}\n", command.name, command.name,
                                   plain(synopsis(command)), plain(command.description));
    for (const Operand& operand : command.operands)
        text += tagged(operand.placeholder, operand_body(operand));
    for (const OptionGroup& group : command.groups) {
        text += fmt::format(".PP\n.I {}\n", plain(group.title));
        if (!group.note.empty())
            text += fmt::format(".PP\n{}\n", plain(group.note));
        for (const Option& option : group.options)
            text += tagged(option_header(option), option_body(option));
    }
    for (const Example& example : command.examples)
        text += fmt::format(".PP\nExample, {}:\n.PP\n.nf\n.RS\n{}\n.RE\n.fi\n", plain(example.effect),
                            plain(example.line));
    return text;
}

} // namespace

std::string manual_page(std::span<const Command> commands) {
    std::string text = fmt::format(".TH LAMELLA 1 \"\" \"lamella {}\" \"User Commands\"\n"
                                   ".SH NAME\nlamella \\- slice triangle meshes into closed contours\n"
                                   ".SH SYNOPSIS\n",
                                   version());
    for (const Command& command : commands)
        text += fmt::format("{}.B lamella {}\n{}\n", &command == commands.data() ? "" : ".br\n", command.name,
                            plain(synopsis(command)));
    text += ".SH DESCRIPTION\n"
            "Lamella cuts a triangle mesh into layers and writes their contours in formats that "
            "additive\\-manufacturing machines and tools read.\n"
            "Lengths are millimetres and angles are degrees; the file name \\- is standard input or output.\n"
            "Values follow their option behind a blank or an equals sign; \\-\\- ends the options.\n"
            "lamella \\-\\-version (or \\-V, version) prints the version.\n"
            ".SH COMMANDS\n";
    for (const Command& command : commands)
        text += command_section(command);
    text += ".SH FORMATS\nSlice files that can be written:\n";
    for (const LayerFormat& format : layer_formats())
        text += tagged(fmt::format("{} {}", format.name, format.extension), format.summary);
    text += ".SH ENGINES\n";
    for (const Engine& engine : engines())
        text += tagged(engine.name, engine.source.empty()
                                        ? std::string(engine.summary)
                                        : fmt::format("{} ({})", engine.summary, engine.source));
    text += ".SH EXIT STATUS\n";
    for (const ExitCode& code : exit_codes())
        text += tagged(std::to_string(code.code), code.meaning);
    text +=
        ".SH ENVIRONMENT\n" +
        tagged("TMPDIR", "the folder of temporary files, of meshes and outputs that do not fit into memory; "
                         "/var/tmp unless set") +
        tagged("SOURCE_DATE_EPOCH", "seconds since 1970, written into files as the time when they were made");
    return text;
}

} // namespace lamella::app
