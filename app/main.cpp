#include "lamella/core/error.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "config_file.hpp"
#include "crash.hpp"
#include "failure.hpp"
#include "help_text.hpp"
#include "interrupt.hpp"
#include "messages.hpp"
#include "names.hpp"
#include "suggest.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <exception>
#include <filesystem>
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

int run(const std::vector<std::string>& words, Messages& messages) {
    std::vector<Command> commands = all_commands();
    if (words.empty() || words[0] == "--help" || words[0] == "-h") {
        print(program_help(commands));
        return 0;
    }
    if (words[0] == "--version") {
        print("lamella " LAMELLA_VERSION "\nMIT licence\n");
        return 0;
    }
    const auto command = std::ranges::find(commands, words[0], &Command::name);
    if (command == commands.end())
        refuse_command(words[0], commands);
    switch (parse(*command, std::span(words).subspan(1))) {
    case Wish::help:
        print(command_help(*command));
        return 0;
    case Wish::dump_config:
        print(config_text(*command));
        return 0;
    case Wish::run:
        break;
    }
    const Interrupt interrupt(messages);
    return command->run({*command, messages, interrupt.token()});
}

int guarded_run(const std::vector<std::string>& words) {
    Messages messages;
    try {
        const int code = run(words, messages);
        finish_printing();
        return code;
    } catch (...) {
        const Failure failure = failure_of(std::current_exception());
        messages.error(failure.text, failure.exit_code);
        return failure.exit_code;
    }
}

} // namespace
} // namespace lamella::app

int main(int argc, char** argv) {
    // A reader that went away and a file that grew too large are errors of writing, not ends of the program.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    lamella::app::prepare_for_crashes();
    return lamella::app::guarded_run(std::vector<std::string>(argv + 1, argv + argc));
}
