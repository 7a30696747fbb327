#include "core/distinct_names.hpp"

#include <fmt/format.h>

namespace lamella {

std::string DistinctNames::of(const std::string& name) {
    if (taken_.try_emplace(name, 1).second)
        return name;
    const std::string stem = name.empty() ? "part" : name;
    std::uint64_t& number = taken_[name];
    std::string distinct;
    do
        distinct = fmt::format("{} {}", stem, ++number);
    while (!taken_.try_emplace(distinct, 1).second);
    if (changed_++ == 0)
        first_changed_ = distinct;
    return distinct;
}

} // namespace lamella
