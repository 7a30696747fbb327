#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/slices/resin_printer.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "failure.hpp"
#include "figures.hpp"
#include "messages.hpp"
#include "options.hpp"
#include "text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::app {
namespace {

/// Returns whether a name has this word, in any case of letters.
bool has_word(std::string_view name, std::string_view word) {
    const auto lower = [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    };
    return std::search(name.begin(), name.end(), word.begin(), word.end(),
                       [&](char a, char b) { return lower(a) == lower(b); }) != name.end() ||
           word.empty();
}

Json printers_json(const std::vector<ResinPrinter>& printers) {
    Json list = Json::array();
    for (const ResinPrinter& printer : printers)
        list.push_back({{"name", printer.name},
                        {"format", printer.format},
                        {"extension", printer.extension},
                        {"pixels", {printer.pixels.x, printer.pixels.y}},
                        {"display_mm", {printer.display_mm.x, printer.display_mm.y}},
                        {"height_mm", printer.height_mm},
                        {"grey", printer.grey}});
    return list;
}

std::string printers_text(const std::vector<ResinPrinter>& printers) {
    std::size_t widest = 0;
    for (const ResinPrinter& printer : printers)
        widest = std::max(widest, printer.name.size());
    std::string text;
    for (const ResinPrinter& printer : printers)
        text += fmt::format("{:<{}}  {:<8}  {:>5} x {:<5}  {:.6g} x {:.6g} x {:.6g} mm\n", printer.name,
                            widest, printer.extension, printer.pixels.x, printer.pixels.y,
                            printer.display_mm.x, printer.display_mm.y, printer.height_mm);
    return text;
}

int run_printers(std::string_view word, bool json) {
    std::vector<ResinPrinter> printers(resin_printers().begin(), resin_printers().end());
    std::erase_if(printers, [&](const ResinPrinter& printer) { return !has_word(printer.name, word); });
    if (printers.empty())
        throw Error(
            ErrorKind::usage,
            fmt::format("no printer has '{}' in its name; lamella printers lists all", excerpt(word)));
    print(json ? json_text(printers_json(printers)) : printers_text(printers));
    return 0;
}

} // namespace

Command printers_command() {
    struct Arguments {
        std::string word;
        bool json = false;
    };
    const auto arguments = std::make_shared<Arguments>();
    return {
        .name = "printers",
        .summary = "list resin printers",
        .description = "Lists the resin printers that the option --printer of other commands knows, with the "
                       "extension of their files, the pixels of their display, and its size with the largest "
                       "height of a part. Nobody has tried the files on any of these printers yet.",
        .operands = {{.placeholder = "WORD",
                      .help = "lists only printers with this word, or part of one, in their names",
                      .required = false,
                      .set =
                          [arguments](const std::string& text) {
                              arguments->word = text;
                          }}},
        .groups = {{"output", "Output", {flag("json", "print JSON", arguments->json)}},
                   common_options(false)},
        .examples = {{"lamella printers elegoo", "the printers of Elegoo"},
                     {"lamella slice part.stl -o part.goo --printer \"Mars 4\"", "a job for one of them"}},
        .run = [arguments](const Context& /*context*/) {
            return run_printers(arguments->word, arguments->json);
        }};
}

} // namespace lamella::app
