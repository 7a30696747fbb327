#include "program.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/version.hpp"

#include "command_line.hpp"
#include "config_file.hpp"
#include "failure.hpp"
#include "heap.hpp"
#include "help_text.hpp"
#include "interrupt.hpp"
#include "messages.hpp"
#include "names.hpp"
#include "suggest.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <vector>

namespace lamella::app {
namespace {

[[noreturn]] void refuse_command(const std::string& word, const std::vector<Command>& commands) {
    const std::string meant = nearest(word, names_of(commands));
    std::error_code ignored;
    if (!meant.empty())
        throw Error(ErrorKind::usage,
                    fmt::format("there is no command \"{}\"; did you mean lamella {}?", word, meant));
    if (std::filesystem::exists(word, ignored))
        throw Error(
            ErrorKind::usage,
            fmt::format("\"{}\" is a file; say what to do with it, such as: lamella info {}", word, word));
    throw Error(ErrorKind::usage, fmt::format("there is no command \"{}\"; lamella --help lists them", word));
}

int run(std::vector<Command>& commands, const std::vector<std::string>& words, Messages& messages,
        const CancelFlag& cancel) {
    if (words.empty() || words[0] == "--help" || words[0] == "-h") {
        messages.result(program_help(commands));
        return 0;
    }
    if (words[0] == "--version") {
        messages.result(fmt::format("lamella {}\nMIT licence\n", version()));
        return 0;
    }
    const auto command = std::find_if(commands.begin(), commands.end(),
                                      [&](const Command& one) { return one.name == words[0]; });
    if (command == commands.end())
        refuse_command(words[0], commands);
    switch (parse(*command, std::span(words).subspan(1), messages)) {
    case Wish::help:
        messages.result(command_help(*command));
        return 0;
    case Wish::dump_config:
        messages.result(config_text(*command));
        return 0;
    case Wish::run:
        break;
    }
    return command->run({*command, messages, &cancel});
}

} // namespace

int run_program(std::vector<Command> commands, const std::vector<std::string>& words, bool speaks) {
    keep_freed_memory();
    Messages messages;
    if (!speaks)
        messages.set_style(ProgressStyle::silent);
    // From the first file that is opened to the last word: a pipe may keep the program waiting at any of
    // them.
    std::optional<Interrupt> interrupt;
    int code = 0;
    try {
        interrupt.emplace(messages);
        code = run(commands, words, messages, interrupt->flag());
        finish_printing();
    } catch (...) {
        const Failure failure = failure_of(std::current_exception());
        messages.error(failure.text, failure.exit_code);
        code = failure.exit_code;
        static_cast<void>(std::fflush(stdout)); // later nobody would hear a signal; it has failed already
    }
    return code;
}

} // namespace lamella::app
