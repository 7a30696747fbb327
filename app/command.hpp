#pragma once

// What a command of the program is: its operands, its options and what it does. One table of these feeds the
// parser, --help, the man page, shell completion and configuration files.

#include "messages.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace lamella::app {

struct Command;

/// What the text of an option's value stands for; configuration files and statistics take the same.
enum class ValueKind { flag, count, number, numbers, text, choice, file };

struct Option {
    std::string name; ///< without hyphens
    char letter = 0;  ///< of the short form, or 0
    ValueKind kind = ValueKind::flag;
    std::string placeholder = {}; ///< of the value in help texts, such as "MM"
    std::string help;
    std::vector<std::string> choices = {}; ///< for ValueKind::choice
    std::string preset = {};               ///< the value where none is given, as text; may be empty
    /// Takes the value ("true" or "false" for a flag). Throws Error{usage} whose text says what is wrong with
    /// it; the parser puts the option in front.
    std::function<void(const std::string& text)> set = {};
    /// Whether it makes sense in a configuration file.
    bool configurable = true;
    /// What the command line or the configuration file gave, once parsed.
    std::optional<std::string> given = {};
};

struct OptionGroup {
    std::string title;
    std::vector<Option> options;
};

/// An argument without a name, such as the file to slice.
struct Operand {
    std::string placeholder; ///< such as "FILE"
    std::string help;
    std::vector<std::string> choices = {}; ///< empty: the name of a file
    bool required = true;
    bool repeated = false; ///< may be given any number of times; the last one only
    std::function<void(const std::string& text)> set;
};

struct Example {
    std::string line;
    std::string effect;
};

/// What a running command is given.
struct Context {
    const Command& command;
    Messages& messages;
    std::stop_token cancel;
};

struct Command {
    std::string name;
    std::string summary;     ///< a few words for the list of commands
    std::string description; ///< one paragraph
    std::vector<Operand> operands = {};
    std::vector<OptionGroup> groups = {};
    std::vector<Example> examples = {};
    /// Returns the exit code.
    std::function<int(const Context&)> run;
};

/// All commands, in the order in which help lists them.
[[nodiscard]] std::vector<Command> all_commands();

/// The exit codes of the program, for help texts, the man page and main.
struct ExitCode {
    int code;
    const char* meaning;
};
[[nodiscard]] std::span<const ExitCode> exit_codes() noexcept;

} // namespace lamella::app
