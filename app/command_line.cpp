#include "command_line.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/core/suggest.hpp"

#include "config_file.hpp"
#include "deadline.hpp"
#include "help_text.hpp"
#include "names.hpp"
#include "numbers.hpp"
#include "standard_streams.hpp"
#include "system/program_start.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

namespace lamella::app {
namespace {

constexpr std::string_view config = "config";
constexpr std::string_view dump_config = "dump-config";
constexpr std::string_view help = "help";
constexpr std::string_view timeout = "timeout"; // of commands with this option

[[noreturn]] void refuse(const std::string& text) {
    throw Error(ErrorKind::usage, text);
}

/// A parsed command line, in its order. Nothing of it is applied yet, because options of a configuration file
/// are applied first.
struct Words {
    struct Word {
        Option* option;       ///< null for an operand
        std::string as_typed; ///< "--layer-height" or "-o"
        std::string text;
    };
    std::vector<Word> words;

    [[nodiscard]] const Word* last(std::string_view name) const {
        const auto found = std::find_if(words.rbegin(), words.rend(), [&](const Word& word) {
            return word.option != nullptr && word.option->name == name;
        });
        return found == words.rend() ? nullptr : &*found;
    }
};

class Splitter {
  public:
    Splitter(Command& command, std::span<const std::string> words) : command_(command), words_(words) {}

    Words split() {
        bool options_end = false;
        while (next_ < words_.size()) {
            const std::string& word = words_[next_++];
            if (options_end || word.size() < 2 || word[0] != '-')
                out_.words.push_back({nullptr, {}, word});
            else if (word == "--")
                options_end = true;
            else if (word[1] == '-')
                split_long(word);
            else
                split_short(word);
        }
        return std::move(out_);
    }

  private:
    /// Returns a hint for commands whose output is an operand.
    [[nodiscard]] std::string instead_of_output(std::string_view name) const {
        if (name != "output" && name != "o")
            return {};
        const bool written = std::any_of(command_.operands.begin(), command_.operands.end(),
                                         [](const Operand& operand) { return operand.written; });
        return written ? fmt::format("; the output is an argument: lamella {} {}", command_.name,
                                     synopsis(command_))
                       : std::string();
    }

    /// Returns a hint for a word that may be the name of a file; "" for other words.
    [[nodiscard]] static std::string if_file(const std::string& word) {
        std::error_code ignored;
        const std::string extension = extension_of(word);
        const bool looks_so = extension.size() > 1 && extension[1] >= 'a' && extension[1] <= 'z';
        if (word.find('=') != std::string::npos || (!looks_so && !std::filesystem::exists(word, ignored)))
            return {};
        return fmt::format("; if \"{0}\" is a file, write ./{0}, or -- before it", excerpt(word));
    }

    void split_long(const std::string& word) {
        const std::size_t equals = word.find('=');
        const std::string typed = word.substr(0, equals);
        Option* option = find_option(command_, typed.substr(2));
        if (option == nullptr) {
            const std::string file = if_file(word);
            refuse(fmt::format("lamella {} has no option {}{}{}", command_.name, typed,
                               instead_of_output(typed.substr(2)),
                               file.empty() ? option_suggestion(command_, typed.substr(2), "--") : file));
        }
        if (equals != std::string::npos)
            out_.words.push_back({option, typed, word.substr(equals + 1)});
        else
            take_value(*option, typed);
    }

    void split_short(const std::string& word) {
        Option* option = by_letter(word[1]);
        if (option == nullptr) {
            const std::string file = if_file(word);
            refuse(fmt::format("lamella {} has no option {}{}{}", command_.name, word.substr(0, 2),
                               instead_of_output(word.substr(1, 1)),
                               file.empty() ? fmt::format("; see lamella {} --help", command_.name) : file));
        }
        const std::string typed = word.substr(0, 2);
        if (word.size() == 2)
            take_value(*option, typed);
        else if (option->kind == ValueKind::flag)
            refuse(fmt::format("{} takes no value, but \"{}\" follows it{}", typed, excerpt(word.substr(2)),
                               if_file(word)));
        else
            out_.words.push_back({option, typed, word.substr(word[2] == '=' ? 3 : 2)});
    }

    void take_value(Option& option, const std::string& typed) {
        if (option.kind == ValueKind::flag) {
            out_.words.push_back({&option, typed, "true"});
            return;
        }
        if (next_ == words_.size() || is_option(words_[next_]))
            refuse(fmt::format("{} needs a value: {} {}", typed, typed, option.placeholder));
        out_.words.push_back({&option, typed, words_[next_++]});
    }

    /// Returns whether a word is an option. Negative numbers and "-" are values. (A value that looks like an
    /// option can be given with "=".)
    [[nodiscard]] bool is_option(const std::string& word) const {
        return word.starts_with("--") || (word.size() > 1 && word[0] == '-' && by_letter(word[1]) != nullptr);
    }

    [[nodiscard]] Option* by_letter(char letter) const {
        for (OptionGroup& group : command_.groups)
            for (Option& option : group.options)
                if (option.letter == letter)
                    return &option;
        return nullptr;
    }

    Command& command_;
    std::span<const std::string> words_;
    std::size_t next_ = 0;
    Words out_;
};

void check_choice(const std::vector<std::string>& choices, const std::string& text) {
    if (choices.empty() || std::find(choices.begin(), choices.end(), text) != choices.end())
        return;
    refuse(fmt::format("\"{}\" is none of {}{}", excerpt(text), fmt::join(choices, ", "),
                       did_you_mean(text, choices)));
}

void check_path(const std::string& path) {
    if (path.empty())
        refuse("the name of a file is empty");
}

/// Returns the file name, but "-" for the system's names of standard input or output. So checks detect if
/// standard input would be read twice, or if something else would be written to standard output together with
/// the data.
std::string file_name(const std::string& text, bool written) {
    const std::string_view name = written ? "stdout" : "stdin";
    const std::string_view number = written ? "1" : "0";
    return text == fmt::format("/dev/{}", name) || text == fmt::format("/dev/fd/{}", number) ||
                   text == fmt::format("/proc/self/fd/{}", number)
               ? "-"
               : text;
}

/// Assigns options and operands to a command, one after the other.
class Assignment {
  public:
    explicit Assignment(Command& command) : command_(command) {}

    /// Sets an option. `origin` is the source of the text, for errors.
    void set(Option& option, const std::string& origin, const std::string& given) {
        const std::string text =
            is_file(option.kind) ? file_name(given, option.kind == ValueKind::output) : given;
        try {
            if (option.kind == ValueKind::flag && text != "true" && text != "false")
                refuse(fmt::format("\"{}\" is neither true nor false", excerpt(text)));
            check_choice(option.choices, text);
            if (is_file(option.kind))
                check_path(text);
            if (option.set)
                option.set(text);
        } catch (const Error& error) {
            throw Error(error.kind(), fmt::format("{}: {}", origin, error.what()));
        }
        option.given = text;
        if (!option.of_each_file)
            return;
        if (file_ != nullptr)
            file_->settings.push_back({&option, text});
        else
            option.given_for_all = text;
    }

    /// Takes an argument of the command line, which may name several files.
    void take_word(const std::string& word) {
        const std::vector<Operand>& operands = command_.operands;
        const bool is_input = !operands.empty() &&
                              operands[std::min(taken_, operands.size() - 1)].choices.empty() &&
                              !operands[std::min(taken_, operands.size() - 1)].written;
        const auto files = is_input ? files_matching(word) : std::nullopt;
        if (!files)
            return take(word);
        if (files->empty())
            refuse(fmt::format(
                "{}: no file has a name of this form; only the last part of a path may have * and ?",
                excerpt(word)));
        for (const std::string& file : *files)
            take(file);
    }

    void take(const std::string& given) {
        std::vector<Operand>& operands = command_.operands;
        if (taken_ >= operands.size() && (operands.empty() || !operands.back().repeated))
            refuse(fmt::format("lamella {} takes {}, so what is \"{}\"? See lamella {} --help", command_.name,
                               operands.empty()       ? "no arguments"
                               : operands.size() == 1 ? "one argument"
                                                      : fmt::format("{} arguments", operands.size()),
                               excerpt(given), command_.name));
        Operand& operand = operands[std::min(taken_, operands.size() - 1)];
        const std::string text = operand.choices.empty() ? file_name(given, operand.written) : given;
        ++taken_;
        try {
            check_choice(operand.choices, text);
            if (operand.choices.empty())
                check_path(text);
            operand.set(text);
        } catch (const Error& error) {
            throw Error(error.kind(), fmt::format("{}: {}", operand.placeholder, error.what()));
        }
        operand.given.push_back({text});
        if (operand.own_options)
            file_ = &operand.given.back();
    }

    [[nodiscard]] bool took_any() const { return taken_ > 0; }

    void end() const {
        if (taken_ >= command_.operands.size() || !command_.operands[taken_].required)
            return;
        const Operand& operand = command_.operands[taken_];
        refuse(fmt::format("lamella {} needs {}: {}{}; see lamella {} --help", command_.name,
                           operand.placeholder, operand.help,
                           operand.choices.empty() ? std::string()
                                                   : fmt::format(" ({})", fmt::join(operand.choices, ", ")),
                           command_.name));
    }

  private:
    Command& command_;
    std::size_t taken_ = 0;
    GivenOperand* file_ = nullptr; ///< the last operand with its own options
};

template <class AnyOption, class AnyCommand>
AnyOption* option_named(AnyCommand& command, std::string_view name) {
    for (auto& group : command.groups)
        for (AnyOption& option : group.options)
            if (option.name == name)
                return &option;
    return nullptr;
}

bool is_on(const std::optional<std::string>& given) {
    return given && *given != "false";
}

/// Throws for an option that has no effect without another one that is missing.
void check_company(const Command& command) {
    const auto says = [](const GivenOperand& file, const Option& option) {
        return std::any_of(file.settings.begin(), file.settings.end(),
                           [&](const Setting& setting) { return setting.option == &option; });
    };
    const auto check = [&](const Option& option) {
        if (option.goes_with.empty() || !is_on(option.given))
            return;
        const Option& other = *find_option(command, option.goes_with);
        if (!is_on(other.given))
            refuse(fmt::format("--{} goes with --{}", option.name, other.name));
        for (const Operand& operand : command.operands)
            for (const GivenOperand& file : operand.given)
                if (says(file, option) && !says(file, other) && !other.given_for_all)
                    refuse(fmt::format("{}: --{} goes with --{}", file.text, option.name, other.name));
    };
    for (const OptionGroup& group : command.groups)
        std::for_each(group.options.begin(), group.options.end(), check);
}

void check_standard_input(const Command& command) {
    std::vector<NamedFile> inputs = files_of(command, ValueKind::input);
    std::erase_if(inputs, [](const NamedFile& file) { return file.path != "-"; });
    if (inputs.size() > 1)
        refuse(fmt::format("{} and {} contradict each other: standard input holds one file only",
                           inputs[0].name, inputs[1].name));
}

Configuration config_in_time(const std::string& path, const Words& words, Command& command,
                             const Messages& messages) {
    const Words::Word* const limit = words.last(timeout);
    if (limit == nullptr)
        return read_config(path, command);
    double seconds = 0;
    try {
        seconds = parse_positive(limit->text);
    } catch (const Error& error) {
        throw Error(error.kind(), fmt::format("{}: {}", limit->as_typed, error.what()));
    }
    const Execution execution;
    const Deadline deadline(seconds, one_line(input_name(path)), messages, execution);
    return read_config(path, command);
}

} // namespace

OptionGroup common_options(bool configurable) {
    OptionGroup group{"general", "General", {}};
    if (configurable) {
        group.options.push_back({.name = std::string(config),
                                 .kind = ValueKind::input,
                                 .placeholder = "FILE",
                                 .help =
                                     "read options from a TOML file, with the names that they have here; the "
                                     "command line overrides it",
                                 .configurable = false});
        group.options.push_back({.name = std::string(dump_config),
                                 .help = "print the options in effect as such a file, and do nothing else",
                                 .configurable = false});
    }
    group.options.push_back(
        {.name = std::string(help), .letter = 'h', .help = "print this help", .configurable = false});
    return group;
}

Option* find_option(Command& command, std::string_view name) {
    return option_named<Option>(command, name);
}

const Option* find_option(const Command& command, std::string_view name) {
    return option_named<const Option>(command, name);
}

std::vector<NamedFile> files_of(const Command& command, ValueKind kind) {
    std::vector<NamedFile> files;
    const auto add = [&files](const std::string& name, const std::string& path) {
        files.push_back({path == "-" ? name + " -" : name, path});
    };
    for (const Operand& operand : command.operands)
        if (operand.choices.empty() && operand.written == (kind == ValueKind::output))
            for (const GivenOperand& given : operand.given)
                add(operand.placeholder, given.text);
    for (const OptionGroup& group : command.groups)
        for (const Option& option : group.options)
            if (option.kind == kind && option.given)
                add("--" + option.name, *option.given);
    return files;
}

std::string option_suggestion(const Command& command, std::string_view name, std::string_view hyphens) {
    std::vector<std::string> names;
    for (const OptionGroup& group : command.groups)
        for (const Option& option : group.options)
            if (option.configurable || !hyphens.empty())
                names.push_back(option.name);
    const std::string meant = nearest(name, names);
    if (meant.empty())
        return fmt::format("; see lamella {} --help", command.name);
    return fmt::format("; did you mean {}{}?", hyphens, meant);
}

Wish parse(Command& command, std::span<const std::string> words, const Messages& messages) {
    const Words split = Splitter(command, words).split();
    if (split.last(help) != nullptr)
        return Wish::help;
    Configuration configured;
    if (const Words::Word* file = split.last(config); file != nullptr && !file->text.empty())
        configured = config_in_time(file->text, split, command, messages);
    Assignment assignment(command);
    const auto set = [&](const ConfigEntry& entry) {
        assignment.set(*entry.option, fmt::format("{}: {}", entry.location, entry.option->name), entry.text);
    };
    std::for_each(configured.options.begin(), configured.options.end(), set);
    for (const Words::Word& word : split.words) {
        if (word.option != nullptr)
            assignment.set(*word.option, word.as_typed, word.text);
        else
            assignment.take_word(word.text);
    }
    if (!assignment.took_any()) {
        for (const ConfiguredInput& input : configured.inputs) {
            assignment.take(input.path);
            for (const ConfigEntry& entry : input.options)
                if (split.last(entry.option->name) == nullptr)
                    set(entry);
        }
    }
    const Words::Word* dump = split.last(dump_config);
    if (dump != nullptr && dump->text == "true")
        return Wish::dump_config;
    assignment.end();
    check_company(command);
    check_standard_input(command);
    return Wish::run;
}

} // namespace lamella::app
