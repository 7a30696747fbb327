#include "lamella/core/error.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "messages.hpp"
#include "resin_settings_file.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

namespace lamella::app {
namespace {

struct ResinArguments {
    std::string action;
    std::string file;
};

int run_resin(const ResinArguments& arguments) {
    if (arguments.action == "check" && arguments.file.empty())
        throw Error(ErrorKind::usage, "lamella resin check needs FILE: the settings to check");
    const ResinSettings settings =
        arguments.file.empty() ? ResinSettings{} : read_resin_settings(arguments.file);
    print(arguments.action == "show" ? resin_settings_text(settings)
                                     : fmt::format("{}: are settings for resin\n", one_line(arguments.file)));
    return 0;
}

} // namespace

Command resin_command() {
    const auto arguments = std::make_shared<ResinArguments>();
    return {
        .name = "resin",
        .summary = "print or check settings for resin",
        .description =
            "show prints all settings of a print in resin as a TOML file, with units and meanings: those in "
            "FILE, or the defaults. check checks whether FILE has such settings; if not, the error names the "
            "line. The option --resin of other commands reads such a file.",
        .operands = {{.placeholder = "ACTION",
                      .help = "the action",
                      .choices = {"show", "check"},
                      .set =
                          [arguments](const std::string& text) {
                              arguments->action = text;
                          }},
                     {.placeholder = "FILE",
                      .help = "the file of settings; - is standard input",
                      .required = false,
                      .set =
                          [arguments](const std::string& text) {
                              arguments->file = text;
                          }}},
        .groups = {common_options(false)},
        .examples = {{"lamella resin show > grey.toml", "the default settings, as a file to edit"},
                     {"lamella resin check grey.toml", "whether the file has settings"}},
        .run = [arguments](const Context& /*context*/) {
            return run_resin(*arguments);
        }};
}

} // namespace lamella::app
