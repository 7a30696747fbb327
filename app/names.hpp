#pragma once

#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

namespace lamella::app {

/// The names of commands, formats, engines, ...: of anything with a member `name`.
template <class Range>
[[nodiscard]] std::vector<std::string> names_of(const Range& things) {
    std::vector<std::string> names;
    names.reserve(std::size(things));
    for (const auto& thing : things)
        names.emplace_back(thing.name);
    return names;
}

/// Of a file's name, with its dot, in lower case: what tells the format.
[[nodiscard]] inline std::string extension_of(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return extension;
}

/// The only name of a file, which need not exist: where links to it lead. Where the system does not tell,
/// such as in a folder that may not be searched, the name as it is, without "." and "..".
[[nodiscard]] std::filesystem::path place_of(const std::string& name);

} // namespace lamella::app
