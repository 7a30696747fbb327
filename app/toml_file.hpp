#pragma once

// Reads TOML files as values with their locations in the file.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lamella::app {

struct TomlEntry;
struct TomlValue;
/// Ordered by key.
using TomlTable = std::vector<TomlEntry>;
using TomlList = std::vector<TomlValue>;

struct TomlValue {
    std::string location; ///< file and line of its key or, in a list, of the value itself: "job.toml:3"
    /// Empty for dates and times.
    std::variant<std::monostate, std::string, bool, std::int64_t, double, TomlList, TomlTable> value;

    template <class Kind>
    [[nodiscard]] const Kind* as() const noexcept {
        return std::get_if<Kind>(&value);
    }
};

struct TomlEntry {
    std::string key;
    TomlValue value;
};

/// Reads a file; "-" is standard input. Throws Error{usage} with the line for invalid TOML, and Error{input}
/// if the file cannot be read.
[[nodiscard]] TomlTable read_toml(const std::string& path);

/// Throws Error{usage}: "job.toml:3: ...".
[[noreturn]] void refuse_toml(const std::string& location, std::string_view text);

/// Throws Error{usage}: "job.toml:3: NAME is FOUND, but has to be EXPECTED".
[[noreturn]] void refuse_value(const TomlValue& value, const std::string& name, const std::string& expected);

/// Returns the candidate that an unknown key may mean, or all of them: "; did you mean KEY?".
[[nodiscard]] std::string meant_text(std::string_view word, const std::vector<std::string>& candidates);

} // namespace lamella::app
