#include "program.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/core/suggest.hpp"
#include "lamella/core/version.hpp"

#include "command_line.hpp"
#include "config_file.hpp"
#include "failure.hpp"
#include "heap.hpp"
#include "help_text.hpp"
#include "interrupt.hpp"
#include "messages.hpp"
#include "names.hpp"
#include "numbers.hpp"
#include "standard_streams.hpp"
#include "system/program_ending.hpp"
#include "system/program_start.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace lamella::app {
namespace {

[[noreturn]] void refuse_command(const std::string& word, const std::vector<Command>& commands) {
    const std::string meant = nearest(word, names_of(commands));
    std::error_code ignored;
    if (!meant.empty())
        throw Error(ErrorKind::usage, fmt::format("there is no command \"{}\"; did you mean lamella {}?",
                                                  excerpt(word), meant));
    if (std::filesystem::exists(word, ignored))
        throw Error(ErrorKind::usage,
                    fmt::format("\"{}\" is a file; say what to do with it, such as: lamella view {}", word,
                                quoted_for_shell(word)));
    throw Error(ErrorKind::usage,
                fmt::format("there is no command \"{}\"; lamella --help lists them", excerpt(word)));
}

/// Runs a command. If an error about data does not name a file, adds the names of the inputs at its
/// beginning.
int run_command(const Command& command, const Context& context) {
    const auto inputs = [&] {
        const std::vector<NamedFile> files = files_of(command, ValueKind::input);
        if (files.empty())
            return std::string();
        return input_name(files.front().path) +
               (files.size() > 1 ? fmt::format(" and {}", counted(files.size() - 1, "more file")) : "") +
               ": ";
    };
    const auto is_named = [&](std::string_view text) {
        for (const ValueKind kind : {ValueKind::input, ValueKind::output})
            for (const NamedFile& file : files_of(command, kind))
                if (text.find(kind == ValueKind::input ? input_name(file.path) : output_name(file.path)) !=
                    std::string_view::npos)
                    return true;
        return false;
    };
    try {
        return command.run(context);
    } catch (const Error& error) {
        const std::string text = error.what();
        if (text.starts_with("-: ") || text.starts_with("-, ") || text.starts_with("- and ")) // its path
            throw Error(error.kind(), input_name("-") + text.substr(1));
        const bool of_data = error.kind() == ErrorKind::limit || error.kind() == ErrorKind::input ||
                             error.kind() == ErrorKind::defect || error.kind() == ErrorKind::internal;
        if (!of_data || is_named(text))
            throw;
        throw Error(error.kind(), inputs() + text);
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::limit, inputs() + std::string(out_of_memory));
    }
}

/// Sets the style before the command line is parsed, so that errors in the command line are JSON, too.
void set_early_style(const std::vector<std::string>& words, Messages& messages) {
    constexpr std::string_view option = "--progress";
    std::string_view style;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string_view word = words[i];
        if (word == option && i + 1 < words.size())
            style = words[i + 1];
        else if (word.starts_with(option) && word.substr(option.size()).starts_with('='))
            style = word.substr(option.size() + 1);
    }
    if (style == "json")
        messages.set_style(ProgressStyle::json);
}

int run(std::vector<Command>& commands, const std::vector<std::string>& words, Messages& messages,
        const CancelFlag& cancel) {
    set_early_style(words, messages);
    const bool asks_help = !words.empty() && (words[0] == "--help" || words[0] == "-h");
    const bool asks_about_command = asks_help && words.size() > 1 && !words[1].starts_with('-');
    if (words.empty() || (asks_help && !asks_about_command)) {
        messages.result(program_help(commands, help_width()));
        return 0;
    }
    // Comparable programs have one or another of these words; a command has none of these letters.
    constexpr std::array<std::string_view, 4> for_version{"--version", "-V", "-v", "version"};
    if (std::find(for_version.begin(), for_version.end(), words[0]) != for_version.end()) {
        messages.result(fmt::format("lamella {}\nMIT licence\n", version()));
        return 0;
    }
    const std::string_view name = asks_about_command ? "help" : std::string_view(words[0]);
    const auto command =
        std::find_if(commands.begin(), commands.end(), [&](const Command& one) { return one.name == name; });
    if (command == commands.end())
        refuse_command(words[0], commands);
    switch (parse(*command, std::span(words).subspan(1), messages)) {
    case Wish::help:
        messages.result(command_help(*command, help_width()));
        return 0;
    case Wish::dump_config:
        messages.result(config_text(*command));
        return 0;
    case Wish::run:
        break;
    }
    return run_command(*command, {*command, messages, &cancel});
}

/// Returns whether a pipe without a reader is the reason of the failure.
bool reader_has_gone(const std::exception_ptr& failure) {
    try {
        std::rethrow_exception(failure);
    } catch (const Error& error) {
        return error.kind() == ErrorKind::output && error.system_error() == EPIPE;
    } catch (...) {
        return false;
    }
}

} // namespace

int run_program(std::vector<Command> commands, const std::vector<std::string>& words, bool speaks) {
    keep_freed_memory();
    Messages messages;
    if (!speaks)
        messages.set_style(ProgressStyle::silent);
    // Exists from before the first file is opened until after the last message, because a pipe may block the
    // program at any time.
    std::optional<Interrupt> interrupt;
    int code = 0;
    try {
        interrupt.emplace(messages);
        code = run(commands, words, messages, interrupt->flag());
        finish_printing();
    } catch (...) {
        if (reader_has_gone(std::current_exception()))
            end_by_broken_pipe();
        const Failure failure = failure_of(std::current_exception());
        messages.error(failure.text, failure.exit_code);
        code = failure.exit_code;
        static_cast<void>(
            std::fflush(stdout)); // flushed here while signals are still handled; the run has failed already
    }
    // Without a command, the program was perhaps started by a click on it, or by files dropped on it.
    if (words.empty() || std::none_of(commands.begin(), commands.end(),
                                      [&](const Command& command) { return command.name == words[0]; }))
        keep_window_open();
    return code;
}

} // namespace lamella::app
