#pragma once

#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

namespace lamella::app {

/// Returns the names of objects that have a member `name`, such as commands, formats or engines.
template <class Range>
[[nodiscard]] std::vector<std::string> names_of(const Range& things) {
    std::vector<std::string> names;
    names.reserve(std::size(things));
    for (const auto& thing : things)
        names.emplace_back(thing.name);
    return names;
}

/// Returns the extension of a file name with its dot, in lower case; it determines the format.
[[nodiscard]] inline std::string extension_of(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return extension;
}

/// Returns the canonical path of a file, which need not exist, with all links resolved. If the system cannot
/// determine it, for example in a folder without search permission, returns the path without "." and "..".
[[nodiscard]] std::filesystem::path place_of(const std::string& name);

} // namespace lamella::app
