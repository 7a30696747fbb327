#include "messages.hpp"

#include "lamella/core/printable.hpp"

#include "failure.hpp"
#include "standard_streams.hpp"
#include "system/program_start.hpp"
#include "text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>

namespace lamella::app {
namespace {

void put(const std::string& text) {
    // A single call, so that lines of several programs on one terminal do not mix. A failure of standard
    // error is ignored, because there is no other place to report it.
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
    static_cast<void>(std::fflush(stderr));
}

void put_json(const Json& object) {
    put(compact_json(object) + "\n");
}

/// Returns whether a terminal may interpret a byte as anything other than a character or a part of one. Tabs
/// are permitted.
bool may_be_unfit(char c) {
    return (c >= 0 && c < ' ' && c != '\t') || c == '\x7f' || c < 0;
}

/// Returns the text of a result, several lines, in a form that is safe for a terminal.
std::string printable_lines(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        if (std::any_of(line.begin(), line.end(), may_be_unfit))
            result += printable(line);
        else
            result += line;
        if (end < text.size())
            result += '\n';
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return result;
}

} // namespace

std::string_view deed(Stage stage) {
    constexpr std::array<std::string_view, 6> deeds{"reading", "welding", "linking",
                                                    "slicing", "making",  "writing"};
    return deeds.at(static_cast<std::size_t>(stage));
}

std::string result_line(std::string_view name, std::string_view value) {
    return fmt::format("  {:<11} {}\n", name, value);
}

std::string one_line(std::string_view text) {
    // Names in a message may be of any length, and what is found and expected stands after them.
    constexpr std::size_t most = 2000;
    std::string line = printable(text);
    if (line.size() <= most)
        return line;
    const auto boundary = [&](std::size_t at) { // not within a character
        while (at < line.size() && (static_cast<unsigned char>(line[at]) & 0xC0U) == 0x80U)
            ++at;
        return at;
    };
    return line.substr(0, boundary(most / 2)) + "..." + line.substr(boundary(line.size() - most / 2));
}

std::string compact_json(const Json& value) {
    // Names of files need not be UTF-8.
    const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    // JSON requires escapes only for control characters below the space. Other ones, and those of lines and
    // of bidirectional text, occur in strings only, and are escaped here.
    const auto byte = [&](std::size_t i) -> unsigned {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
    };
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = byte(i) < 0x80 ? 1 : byte(i) < 0xe0 ? 2 : byte(i) < 0xf0 ? 3 : 4;
        const std::string_view character = std::string_view(text).substr(i, length);
        unsigned code = byte(i);
        if (length == 2)
            code = (code & 0x1fU) << 6 | (byte(i + 1) & 0x3fU);
        else if (length == 3)
            code = (code & 0xfU) << 12 | (byte(i + 1) & 0x3fU) << 6 | (byte(i + 2) & 0x3fU);
        if (code != '\n' && length < 4 && code >= 0x7f && printable(character) != character)
            result += fmt::format("\\u{:04x}", code);
        else
            result += character;
        i += length;
    }
    return result;
}

void Messages::progress(const Progress& progress) {
    if (style_ != ProgressStyle::bar && style_ != ProgressStyle::json)
        return;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start_;
    if (style_ == ProgressStyle::json) {
        // A process that waits for others sends the same report repeatedly.
        if (last_ && last_->stage == progress.stage && last_->done == progress.done &&
            last_->total == progress.total)
            return;
        last_ = progress;
        put_json({{"stage", stage_name(progress.stage)},
                  {"done", progress.done},
                  {"total", progress.total},
                  {"seconds", seconds.count()}});
    } else {
        draw_bar(progress, seconds.count());
    }
}

void Messages::result(std::string_view text) {
    if (is_silent())
        return;
    clear_bar();
    print(printable_lines(text));
}

void Messages::warn_of(const std::string& name, const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings)
        warn(name + ": " + warning);
}

void Messages::warn(const std::string& text) {
    if (is_silent())
        return;
    clear_bar();
    const std::string warning = with_options(text);
    if (style_ == ProgressStyle::json)
        put_json({{"warning", warning}});
    else
        put("lamella: warning: " + one_line(warning) + "\n");
}

void Messages::error(const std::string& text, int exit_code) {
    if (is_silent())
        return;
    clear_bar();
    put(error_line(text, exit_code));
}

void Messages::note(const std::string& text) {
    clear_bar();
    if (style_ != ProgressStyle::json && style_ != ProgressStyle::quiet && !is_silent())
        put(printable_lines(text));
}

void Messages::written(const std::string& text, std::string_view output) {
    if (style_ == ProgressStyle::quiet)
        clear_bar();
    else if (output == "-")
        note(text);
    else if (!output_is_closed())
        result(text);
}

void Messages::sum_up(const std::string& text, const std::string& json) {
    clear_bar();
    if (style_ != ProgressStyle::quiet)
        put(style_ == ProgressStyle::json ? json + "\n" : text);
}

std::string Messages::last_words(const std::string& text, int exit_code) const {
    // A bar may be on the line.
    return is_silent() ? std::string()
                       : (style_ == ProgressStyle::json ? "" : "\n") + error_line(text, exit_code);
}

std::string Messages::error_line(const std::string& text, int exit_code) const {
    return style_ == ProgressStyle::json ? compact_json({{"error", text}, {"exit_code", exit_code}}) + "\n"
                                         : "lamella: error: " + one_line(text) + "\n";
}

void Messages::draw_bar(const Progress& progress, double seconds) {
    constexpr double patience = 0.3;
    if (seconds < patience || progress.total == 0)
        return;
    const double part =
        std::min(1.0, static_cast<double>(progress.done) / static_cast<double>(progress.total));
    std::string line = fmt::format("{:8} ", deed(progress.stage));
    const std::string figures = fmt::format("{:3.0f} %  {:.0f} s ", part * 100, seconds);
    // A line that fills the last column would wrap, and the next one would not overwrite it. The width is
    // looked up each time, because people resize windows.
    constexpr std::size_t usual_columns = 80;
    const std::size_t room = std::max<std::size_t>(terminal_columns().value_or(usual_columns), 1) - 1;
    constexpr std::size_t longest = 40;
    constexpr std::size_t least = 5;
    constexpr std::string_view frame = "[] ";
    const std::size_t others = line.size() + frame.size() + figures.size();
    if (room >= others + least) {
        const std::size_t width = std::min(room - others, longest);
        const auto filled = static_cast<std::size_t>(part * static_cast<double>(width));
        line += fmt::format("[{:#<{}}{:.<{}}] ", "", filled, "", width - filled);
    }
    line += figures;
    put("\r" + line.substr(0, room));
    bar_drawn_ = true;
}

void Messages::clear_bar() {
    if (bar_drawn_)
        put("\r\033[K");
    bar_drawn_ = false;
}

} // namespace lamella::app
