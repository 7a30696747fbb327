#include "settings_command.hpp"

#include "lamella/core/error.hpp"

#include "command_line.hpp"
#include "messages.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

namespace lamella::app {
namespace {

struct SettingsArguments {
    SettingsCommand texts;
    std::string action;
    std::string file;
};

int run_settings(const SettingsArguments& arguments) {
    const SettingsCommand& texts = arguments.texts;
    const bool check = arguments.action == "check";
    if (check && arguments.file.empty())
        throw Error(ErrorKind::usage,
                    fmt::format("lamella {} check needs FILE: {}", texts.name, texts.missing));
    const std::string text = texts.text(arguments.file);
    print(check ? fmt::format("{}: {}\n", one_line(arguments.file), texts.confirmation) : text);
    return 0;
}

} // namespace

Command settings_command(SettingsCommand texts) {
    const auto arguments = std::make_shared<SettingsArguments>(SettingsArguments{std::move(texts), {}, {}});
    return {.name = arguments->texts.name,
            .summary = arguments->texts.summary,
            .description = arguments->texts.description,
            .operands = {{.placeholder = "ACTION",
                          .help = "the action",
                          .choices = {"show", "check"},
                          .set =
                              [arguments](const std::string& text) {
                                  arguments->action = text;
                              }},
                         {.placeholder = "FILE",
                          .help = arguments->texts.file_help,
                          .required = false,
                          .set =
                              [arguments](const std::string& text) {
                                  arguments->file = text;
                              }}},
            .groups = {common_options(false)},
            .examples = arguments->texts.examples,
            .run = [arguments](const Context& /*context*/) {
                return run_settings(*arguments);
            }};
}

} // namespace lamella::app
