#include "command_line.hpp"

#include "lamella/core/error.hpp"

#include "config_file.hpp"
#include "suggest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace lamella::app {
namespace {

constexpr std::string_view config = "config";
constexpr std::string_view dump_config = "dump-config";
constexpr std::string_view help = "help";

[[noreturn]] void refuse(const std::string& text) {
    throw Error(ErrorKind::usage, text);
}

/// A command line taken apart, nothing applied yet: a file's options come first.
struct Words {
    struct Setting {
        Option* option;
        std::string as_typed; ///< "--layer-height" or "-o"
        std::string text;
    };
    std::vector<Setting> settings;
    std::vector<std::string> operands;

    [[nodiscard]] const Setting* last(std::string_view name) const {
        const auto found = std::find_if(settings.rbegin(), settings.rend(),
                                        [&](const Setting& s) { return s.option->name == name; });
        return found == settings.rend() ? nullptr : &*found;
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
                out_.operands.push_back(word);
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
    void split_long(const std::string& word) {
        const std::size_t equals = word.find('=');
        const std::string typed = word.substr(0, equals);
        Option* option = find_option(command_, typed.substr(2));
        if (option == nullptr)
            refuse(fmt::format("lamella {} has no option {}{}", command_.name, typed,
                               option_suggestion(command_, typed.substr(2), "--")));
        if (equals != std::string::npos)
            out_.settings.push_back({option, typed, word.substr(equals + 1)});
        else
            take_value(*option, typed);
    }

    void split_short(const std::string& word) {
        Option* option = by_letter(word[1]);
        if (option == nullptr)
            refuse(fmt::format("lamella {} has no option {}; see lamella {} --help", command_.name,
                               word.substr(0, 2), command_.name));
        const std::string typed = word.substr(0, 2);
        if (word.size() == 2)
            take_value(*option, typed);
        else if (option->kind == ValueKind::flag)
            refuse(fmt::format("{} takes no value, but \"{}\" follows it", typed, word.substr(2)));
        else
            out_.settings.push_back({option, typed, word.substr(word[2] == '=' ? 3 : 2)});
    }

    void take_value(Option& option, const std::string& typed) {
        if (option.kind == ValueKind::flag) {
            out_.settings.push_back({&option, typed, "true"});
            return;
        }
        if (next_ == words_.size() || is_option(words_[next_]))
            refuse(fmt::format("{} needs a value: {} {}", typed, typed, option.placeholder));
        out_.settings.push_back({&option, typed, words_[next_++]});
    }

    /// Negative numbers and "-" are values; a value that looks like an option can be given with "=".
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
    if (choices.empty() || std::ranges::find(choices, text) != choices.end())
        return;
    const std::string meant = nearest(text, choices);
    refuse(fmt::format("\"{}\" is none of {}{}", text, fmt::join(choices, ", "),
                       meant.empty() ? "" : fmt::format("; did you mean {}?", meant)));
}

void set_operands(Command& command, const std::vector<std::string>& given) {
    const std::vector<Operand>& operands = command.operands;
    for (std::size_t i = 0; i < operands.size(); ++i) {
        const Operand& operand = operands[i];
        if (i >= given.size()) {
            if (!operand.required)
                return;
            refuse(fmt::format("lamella {} needs {}: {}{}; see lamella {} --help", command.name,
                               operand.placeholder, operand.help,
                               operand.choices.empty()
                                   ? std::string()
                                   : fmt::format(" ({})", fmt::join(operand.choices, ", ")),
                               command.name));
        }
        try {
            check_choice(operand.choices, given[i]);
            operand.set(given[i]);
        } catch (const Error& error) {
            throw Error(error.kind(), fmt::format("{}: {}", operand.placeholder, error.what()));
        }
    }
    if (given.size() > operands.size())
        refuse(fmt::format("lamella {} takes {}, so what is \"{}\"? See lamella {} --help", command.name,
                           operands.empty()       ? "no arguments"
                           : operands.size() == 1 ? "one argument"
                                                  : fmt::format("{} arguments", operands.size()),
                           given[operands.size()], command.name));
}

} // namespace

OptionGroup common_options(bool configurable) {
    OptionGroup group{"General", {}};
    if (configurable) {
        group.options.push_back({.name = std::string(config),
                                 .kind = ValueKind::file,
                                 .placeholder = "FILE",
                                 .help = "take options from a .toml or .json file, with the names that they "
                                         "have here; the command line goes before it",

                                 .configurable = false});
        group.options.push_back({.name = std::string(dump_config),
                                 .help = "print the options in effect as such a file, and do nothing else",

                                 .configurable = false});
    }
    group.options.push_back({.name = std::string(help),
                             .letter = 'h',
                             .help = "show this help",

                             .configurable = false});
    return group;
}

Option* find_option(Command& command, std::string_view name) {
    for (OptionGroup& group : command.groups)
        for (Option& option : group.options)
            if (option.name == name)
                return &option;
    return nullptr;
}

void set_option(Option& option, const std::string& origin, const std::string& text) {
    try {
        if (option.kind == ValueKind::flag && text != "true" && text != "false")
            refuse(fmt::format("\"{}\" is neither true nor false", text));
        check_choice(option.choices, text);
        if (option.set)
            option.set(text);
        option.given = text;
    } catch (const Error& error) {
        throw Error(error.kind(), fmt::format("{}: {}", origin, error.what()));
    }
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

Wish parse(Command& command, std::span<const std::string> words) {
    const Words split = Splitter(command, words).split();
    if (split.last(help) != nullptr)
        return Wish::help;
    if (const Words::Setting* file = split.last(config))
        read_config(file->text, command);
    for (const Words::Setting& setting : split.settings)
        set_option(*setting.option, setting.as_typed, setting.text);
    const Words::Setting* dump = split.last(dump_config);
    if (dump != nullptr && dump->text == "true")
        return Wish::dump_config;
    set_operands(command, split.operands);
    return Wish::run;
}

} // namespace lamella::app
