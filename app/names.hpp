#pragma once

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

} // namespace lamella::app
