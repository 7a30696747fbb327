#pragma once

// Output of a running command: results on standard output; errors, warnings, notes and progress on standard
// error, for people or (JSON lines) for programs.

#include "lamella/core/execution.hpp"

#include <nlohmann/json_fwd.hpp>

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::app {

/// JSON whose keys keep their order.
using Json = nlohmann::ordered_json;

/// Returns a line of a result for people: a name, and in the next column its value.
[[nodiscard]] std::string result_line(std::string_view name, std::string_view value);

/// Returns a word for the activity of a stage, such as "reading".
[[nodiscard]] std::string_view deed(Stage stage);

enum class ProgressStyle {
    bar,
    json, ///< every line on standard error is a JSON object
    none,
    quiet,  ///< no progress and no summary
    silent, ///< no output, not even results and errors, because another process reports for this one
};

class Messages {
  public:
    Messages() = default;
    ~Messages() { clear_bar(); }
    Messages(const Messages&) = delete;
    Messages& operator=(const Messages&) = delete;

    /// Sets the style, unless it is silent.
    void set_style(ProgressStyle style) {
        if (!is_silent())
            style_ = style;
    }

    /// Prints progress. Must be called from one thread at a time, like Execution::progress.
    void progress(const Progress& progress);

    /// Prints a result on standard output. Throws Error{output}.
    void result(std::string_view text);
    /// Prints "lamella: warning: ..." on one line, with options in place of fields (`with_options`).
    void warn(const std::string& text);
    /// Prints the warnings of a file, each with the name of the file (see input_name and output_name).
    void warn_of(const std::string& name, const std::vector<std::string>& warnings);
    /// Prints "lamella: error: ...", on one line.
    void error(const std::string& text, int exit_code);
    /// Prints a text for people that cannot be a result because standard output carries data. Does nothing in
    /// the style for programs and in the quiet style.
    void note(const std::string& text);
    /// Prints a summary after `output` was written: as a result, or as a note if `output` is standard output.
    /// A closed standard output is not an error here. Does nothing in the quiet style.
    void written(const std::string& text, std::string_view output);
    /// Prints a summary of many files: `text` for people, `json` for programs, or nothing in the quiet style.
    void sum_up(const std::string& text, const std::string& json);
    /// Returns the line of an error for a run that is ended at once, in any state, so that a caller can write
    /// it without a lock. Returns "" if nothing must be printed.
    [[nodiscard]] std::string last_words(const std::string& text, int exit_code) const;

  private:
    [[nodiscard]] bool is_silent() const { return style_ == ProgressStyle::silent; }
    [[nodiscard]] std::string error_line(const std::string& text, int exit_code) const;
    void draw_bar(const Progress& progress, double seconds);
    void clear_bar();

    std::atomic<ProgressStyle> style_ = ProgressStyle::none;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    bool bar_drawn_ = false;
    std::optional<Progress> last_; ///< the last report in the style for programs
};

/// Returns the text on one line of valid UTF-8 with control characters escaped, which is safe for a terminal.
[[nodiscard]] std::string one_line(std::string_view text);

/// Returns the value on one line of valid UTF-8: invalid bytes are replaced, and control characters are
/// escaped.
[[nodiscard]] std::string compact_json(const Json& value);

} // namespace lamella::app
