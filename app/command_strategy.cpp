#include "lamella/scan/strategy_fields.hpp"

#include "commands.hpp"
#include "settings_command.hpp"
#include "strategy_file.hpp"

#include <string>

namespace lamella::app {

Command strategy_command() {
    return settings_command(
        {.name = "strategy",
         .summary = "print or check a scan strategy",
         .description =
             "show prints a complete scan strategy as a TOML file, with units and meanings: the strategy in "
             "FILE, or the default one. check checks whether FILE is a strategy; if not, the error names the "
             "line.",
         .file_help = "the strategy file; - is standard input",
         .missing = "the strategy to check",
         .confirmation = "is a strategy",
         .examples = {{"lamella strategy show > 316l.toml", "the default strategy, as a file to edit"},
                      {"lamella strategy check 316l.toml", "whether the file is a strategy"}},
         .text = [](const std::string& file) {
             return strategy_text(file.empty() ? ScanStrategy{} : read_strategy(file));
         }});
}

} // namespace lamella::app
