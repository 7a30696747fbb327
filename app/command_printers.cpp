#include "lamella/slices/resin_printer.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "messages.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>

namespace lamella::app {
namespace {

int run_printers() {
    std::size_t widest = 0;
    for (const ResinPrinter& printer : resin_printers())
        widest = std::max(widest, printer.name.size());
    std::string text;
    for (const ResinPrinter& printer : resin_printers())
        text += fmt::format("{:<{}}  {:<8}  {:>5} x {:<5}  {:.6g} x {:.6g} x {:.6g} mm\n", printer.name,
                            widest, printer.extension, printer.pixels.x, printer.pixels.y,
                            printer.display_mm.x, printer.display_mm.y, printer.height_mm);
    print(text);
    return 0;
}

} // namespace

Command printers_command() {
    return {
        .name = "printers",
        .summary = "list resin printers",
        .description = "Lists the resin printers that the option --printer of other commands knows, with the "
                       "extension of their files, the pixels of their display, and its size with the largest "
                       "height of a part. Nobody has tried the files on most of these printers yet.",
        .groups = {common_options(false)},
        .examples = {{"lamella slice part.stl -o part.goo --printer \"Mars 4\"", "a job for one of them"}},
        .run = [](const Context& /*context*/) {
            return run_printers();
        }};
}

} // namespace lamella::app
