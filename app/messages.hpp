#pragma once

// What a running command says: results on standard output; errors, warnings, notes and progress on standard
// error, for people or (JSON lines) for programs.

#include "lamella/core/execution.hpp"

#include <nlohmann/json_fwd.hpp>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::app {

/// As the program writes it: keys stay in their order.
using Json = nlohmann::ordered_json;

/// A line of a result for people: a name, and in the next column what there is to say of it.
[[nodiscard]] std::string result_line(std::string_view name, std::string_view value);

/// What a stage does: "reading".
[[nodiscard]] std::string_view deed(Stage stage);

enum class ProgressStyle {
    bar,  ///< a bar, but only where standard error is a terminal
    json, ///< everything on standard error is one JSON object a line
    none,
    silent, ///< not even results and errors: of a process for which another one speaks
};

class Messages {
  public:
    Messages() = default;
    ~Messages() { clear_bar(); }
    Messages(const Messages&) = delete;
    Messages& operator=(const Messages&) = delete;

    /// What is silent stays so.
    void set_style(ProgressStyle style) {
        if (!is_silent())
            style_ = style;
    }

    /// To be called from one thread at a time, as Execution::progress is.
    void progress(const Progress& progress);

    /// Prints a result on standard output. Throws Error{output}.
    void result(std::string_view text);
    /// "lamella: warning: ...", on one line.
    void warn(const std::string& text);
    /// Those of a file: each names it, as input_name or output_name does.
    void warn_of(const std::string& name, const std::vector<std::string>& warnings);
    /// "lamella: error: ...", on one line.
    void error(const std::string& text, int exit_code);
    /// What is no result here because standard output carries data. Programs are spared it.
    void note(const std::string& text);
    /// How the writing of `output` went: a result, or a note where the output itself is standard output. It
    /// is no error that nobody is there to be told.
    void written(const std::string& text, std::string_view output);
    /// How a run of many files went: for people, or as a JSON object for programs.
    void sum_up(const std::string& text, const std::string& json);
    /// The line of an error, for a run that is ended at once, in whatever state it is: whoever writes it may
    /// hold no lock. "" where nothing is to be said.
    [[nodiscard]] std::string last_words(const std::string& text, int exit_code) const;

  private:
    [[nodiscard]] bool is_silent() const { return style_ == ProgressStyle::silent; }
    [[nodiscard]] std::string error_line(const std::string& text, int exit_code) const;
    void draw_bar(const Progress& progress, double seconds);
    void clear_bar();

    std::atomic<ProgressStyle> style_ = ProgressStyle::none;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    const bool on_terminal_ = isatty(STDERR_FILENO) != 0;
    bool bar_drawn_ = false;
    std::optional<Progress> last_; ///< that programs were told
};

/// The text on one line of valid UTF-8, control characters escaped: what a terminal can be shown.
[[nodiscard]] std::string one_line(std::string_view text);

/// The value on one line of valid UTF-8: what is none is replaced, and control characters are escaped.
[[nodiscard]] std::string compact_json(const Json& value);

} // namespace lamella::app
