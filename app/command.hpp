#pragma once

// What a command of the program is: its operands, its options and what it does. One table of these feeds the
// parser, --help, the man page, shell completion and configuration files.

#include "lamella/core/execution.hpp"

#include "messages.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::app {

struct Command;

/// What the text of an option's value stands for; configuration files and statistics take the same.
enum class ValueKind {
    flag,
    count,
    number,
    numbers,
    text,
    choice,
    input, ///< a file to read; "-" is standard input
    output ///< a file to write; "-" is standard output
};
[[nodiscard]] constexpr bool is_file(ValueKind kind) noexcept {
    return kind == ValueKind::input || kind == ValueKind::output;
}

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
    /// The name of an option without which this one says nothing; "" for none.
    std::string goes_with = {};
    /// Given after a file, it holds for that one; before the first file, for all (Operand::own_options).
    bool of_each_file = false;
    /// What the command line or the configuration file gave, once parsed: the last of several values.
    std::optional<std::string> given = {};
    /// The same, of what was given for all files.
    std::optional<std::string> given_for_all = {};
};

/// An option with the text of its value.
struct Setting {
    const Option* option;
    std::string text;
};

struct OptionGroup {
    std::string title;
    std::vector<Option> options;
};

/// What an operand was given.
struct GivenOperand {
    std::string text;
    std::vector<Setting> settings = {}; ///< for it alone
};

/// An argument without a name, such as the file to slice.
struct Operand {
    std::string placeholder; ///< such as "FILE"
    std::string help;
    std::vector<std::string> choices = {}; ///< empty: the name of a file; "-" is a standard stream
    bool written = false;                  ///< of a file: it is written, not read
    bool required = true;
    bool repeated = false;    ///< may be given any number of times; the last one only
    bool own_options = false; ///< options behind it may hold for it alone (Option::of_each_file)
    std::function<void(const std::string& text)> set;
    std::vector<GivenOperand> given = {}; ///< once parsed
};

struct Example {
    std::string line;
    std::string effect;
};

/// What a running command is given.
struct Context {
    const Command& command;
    Messages& messages;
    const CancelFlag* cancel;
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

/// The option of that name, or nullptr.
[[nodiscard]] Option* find_option(Command& command, std::string_view name);
[[nodiscard]] const Option* find_option(const Command& command, std::string_view name);

/// A file that was given, and by what, such as "--stats".
struct NamedFile {
    std::string name;
    std::string path;
};
/// Files to read or to write (ValueKind::input or output).
[[nodiscard]] std::vector<NamedFile> files_of(const Command& command, ValueKind kind);

/// All commands, in the order in which help lists them.
[[nodiscard]] std::vector<Command> all_commands();

/// The exit codes of the program, for help texts, the man page and main.
struct ExitCode {
    int code;
    const char* meaning;
};
[[nodiscard]] std::span<const ExitCode> exit_codes() noexcept;

} // namespace lamella::app
