#include "commands.hpp"

#include "names.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace lamella::app {

std::vector<Command> all_commands() {
    std::vector<Command> commands{
        slice_command(),   info_command(), check_command(),    verify_command(),     compare_command(),
        convert_command(), scan_command(), strategy_command(), printers_command(),   resin_command(),
        merge_command(),   view_command(), make_command(),     completion_command(), help_command()};
    std::vector<std::string> sections;
    for (const Command& command : commands)
        for (const OptionGroup& group : command.groups)
            if (std::find(sections.begin(), sections.end(), group.name) == sections.end())
                sections.push_back(group.name);
    std::vector<Operand>& of_help = commands.back().operands;
    of_help.front().choices = names_of(commands);
    of_help.back().choices = std::move(sections);
    return commands;
}

std::span<const ExitCode> exit_codes() noexcept {
    static constexpr std::array<ExitCode, 9> codes{
        {{0, "all went well"},
         {1, "a fault of Lamella itself: please report it"},
         {2, "a wrong or impossible request in the command line, a configuration file, a scan strategy or a "
             "list of heights; also a part that does not fit the display, the build volume or 16-bit "
             "coordinates"},
         {3, "an input cannot be read or holds nothing to work on"},
         {4, "defects: of the mesh with --strict, or layers that fail a check (verify, compare, check "
             "--strict)"},
         {5, "a limit was hit, such as memory or --timeout"},
         {6, "an output cannot be written; nothing was left at its path, but other outputs of the run may be "
             "complete"},
         {7, "some files of a batch failed; the results name them and the reasons"},
         {130, "cancelled by Ctrl-C, by the terminate signal, or because the terminal was closed"}}};
    return codes;
}

} // namespace lamella::app
