#include "commands.hpp"
#include "resin_settings_file.hpp"
#include "settings_command.hpp"

#include <string>

namespace lamella::app {

Command resin_command() {
    return settings_command(
        {.name = "resin",
         .summary = "print or check settings for resin",
         .description =
             "show prints all settings of a print in resin as a TOML file, with units and meanings: those in "
             "FILE, or the defaults. check checks whether FILE has such settings; if not, the error names "
             "the "
             "line. The option --resin of other commands reads such a file.",
         .file_help = "the file of settings; - is standard input",
         .missing = "the settings to check",
         .confirmation = "valid settings for resin",
         .examples = {{"lamella resin show > grey.toml", "the default settings, as a file to edit"},
                      {"lamella resin check grey.toml", "whether the file has settings"}},
         .text = [](const std::string& file) {
             return resin_settings_text(file.empty() ? ResinSettings{} : read_resin_settings(file));
         }});
}

} // namespace lamella::app
