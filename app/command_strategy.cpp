#include "lamella/core/error.hpp"
#include "lamella/scan/strategy_fields.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "messages.hpp"
#include "strategy_file.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

namespace lamella::app {
namespace {

struct StrategyArguments {
    std::string action;
    std::string file;
};

int run_strategy(const StrategyArguments& arguments) {
    if (arguments.action == "check" && arguments.file.empty())
        throw Error(ErrorKind::usage, "lamella strategy check needs FILE: the strategy to check");
    const ScanStrategy strategy = arguments.file.empty() ? ScanStrategy{} : read_strategy(arguments.file);
    print(arguments.action == "show" ? strategy_text(strategy)
                                     : fmt::format("{}: is a strategy\n", one_line(arguments.file)));
    return 0;
}

} // namespace

Command strategy_command() {
    const auto arguments = std::make_shared<StrategyArguments>();
    return {
        .name = "strategy",
        .summary = "print or check a scan strategy",
        .description =
            "show prints a complete scan strategy as a TOML file, with units and meanings: the strategy in "
            "FILE, or the default one. check checks whether FILE is a strategy; if not, the error names the "
            "line.",
        .operands = {{.placeholder = "ACTION",
                      .help = "the action",
                      .choices = {"show", "check"},
                      .set =
                          [arguments](const std::string& text) {
                              arguments->action = text;
                          }},
                     {.placeholder = "FILE",
                      .help = "the strategy file; - is standard input",
                      .required = false,
                      .set =
                          [arguments](const std::string& text) {
                              arguments->file = text;
                          }}},
        .groups = {common_options(false)},
        .examples = {{"lamella strategy show > 316l.toml", "the default strategy, as a file to edit"},
                     {"lamella strategy check 316l.toml", "whether the file is a strategy"}},
        .run = [arguments](const Context& /*context*/) {
            return run_strategy(*arguments);
        }};
}

} // namespace lamella::app
