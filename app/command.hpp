#pragma once

// Commands of the program: their operands, options and actions. One table of commands feeds the parser,
// --help, the man page, shell completion and configuration files.

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

/// Type of an option's value; configuration files and statistics use the same types.
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
    char letter = 0;  ///< letter of the short form; 0 if there is none
    ValueKind kind = ValueKind::flag;
    std::string placeholder = {}; ///< name of the value in help texts, such as "MM"
    std::string help;
    std::vector<std::string> choices = {}; ///< for ValueKind::choice
    std::string preset = {};               ///< default value, as text; may be empty
    /// Takes the value ("true" or "false" for a flag). Throws Error{usage} that describes an invalid value;
    /// the parser prepends the option.
    std::function<void(const std::string& text)> set = {};
    /// True if the option is allowed in a configuration file.
    bool configurable = true;
    /// Name of an option without which this one has no effect; "" for none.
    std::string goes_with = {};
    /// True if the option, given after a file, applies to that file only; before the first file it applies to
    /// all files (Operand::own_options).
    bool of_each_file = false;
    /// The last value in the command line or the configuration file; set by the parser.
    std::optional<std::string> given = {};
    /// The last value that was given for all files.
    std::optional<std::string> given_for_all = {};
};

/// An option with the text of its value.
struct Setting {
    const Option* option;
    std::string text;
};

/// A section of the help.
struct OptionGroup {
    std::string name; ///< one word, for `lamella help COMMAND NAME`
    std::string title;
    std::vector<Option> options;
    std::string note = {}; ///< sentences about all options of the section; may be empty
};

/// Value of an operand.
struct GivenOperand {
    std::string text;
    std::vector<Setting> settings = {}; ///< options that apply to it alone
};

/// An argument without a name, such as the file to slice.
struct Operand {
    std::string placeholder; ///< such as "FILE"
    std::string help;
    std::vector<std::string> choices = {}; ///< the permitted words; if empty, the operand is a file, and "-"
                                           ///< is a standard stream
    bool written = false;                  ///< the file is written, not read
    bool required = true;
    bool repeated = false;    ///< may be repeated; only the last operand can be
    bool own_options = false; ///< options after it may apply to it alone (Option::of_each_file)
    std::function<void(const std::string& text)> set;
    std::vector<GivenOperand> given = {}; ///< the values, set by the parser
};

struct Example {
    std::string line;
    std::string effect;
};

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

/// Returns the option of this name; nullptr if there is none.
[[nodiscard]] Option* find_option(Command& command, std::string_view name);
[[nodiscard]] const Option* find_option(const Command& command, std::string_view name);

/// A file that was given, and the option or operand that names it, such as "--stats".
struct NamedFile {
    std::string name;
    std::string path;
};
/// Returns the files to read or to write (ValueKind::input or output).
[[nodiscard]] std::vector<NamedFile> files_of(const Command& command, ValueKind kind);

/// Returns all commands, in the order in which help lists them.
[[nodiscard]] std::vector<Command> all_commands();

/// An exit code of the program, for help texts, the man page and main.
struct ExitCode {
    int code;
    const char* meaning;
};
[[nodiscard]] std::span<const ExitCode> exit_codes() noexcept;

} // namespace lamella::app
