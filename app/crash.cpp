#include "crash.hpp"

#include "lamella/system/whole_file.hpp"

#include "failure.hpp"
#include "system/program_ending.hpp"

#include <atomic>
#include <exception>
#include <new>
#include <string_view>

namespace lamella::app {
namespace {

// Global, because a signal handler has no parameter for it; atomic, because it runs at any time.
std::atomic<ProgressStyle> told_as = ProgressStyle::none;

// Begins with a line break, because a progress bar may be on the current line.
constexpr std::string_view time_is_up =
    "\nlamella: error: the processor time that a process may take is used up (see ulimit -t)\n";
constexpr std::string_view time_is_up_json =
    "{\"error\":\"the processor time that a process may take is used up (see ulimit "
    "-t)\",\"exit_code\":5}\n";

void at_time_limit() noexcept {
    const ProgressStyle style = told_as;
    if (style != ProgressStyle::silent)
        leave_at_once(style == ProgressStyle::json ? time_is_up_json : time_is_up, limit_exit_code);
}

constexpr std::string_view no_memory = "lamella: error: memory ran out (see ulimit -v)\n";
constexpr std::string_view no_memory_json =
    "{\"error\":\"memory ran out (see ulimit -v)\",\"exit_code\":5}\n";

// Global, as `told_as`.
std::terminate_handler otherwise = nullptr;

/// Ends the program where memory runs out before, or while, an error can be reported.
void at_terminate() {
    try {
        if (const std::exception_ptr failure = std::current_exception())
            std::rethrow_exception(failure);
    } catch (const std::bad_alloc&) {
        leave_at_once(told_as == ProgressStyle::json     ? no_memory_json
                      : told_as == ProgressStyle::silent ? std::string_view()
                                                         : no_memory,
                      limit_exit_code);
    } catch (...) { // reported by the other handler
    }
    otherwise();
}

} // namespace

void leave_at_once(std::string_view last_words, int exit_code) noexcept {
    remove_unfinished();
    write_last_words(last_words); // a blocked standard error may be the reason why the program is stuck
    leave(exit_code);
}

void prepare_for_crashes() noexcept {
    handle_crashes(remove_unfinished, at_time_limit);
    otherwise = std::set_terminate(at_terminate);
}

void report_crashes(ProgressStyle style) noexcept {
    told_as = style;
}

} // namespace lamella::app
