#include "lamella/core/error.hpp"
#include "lamella/slicing/slice.hpp"

#include "slicing/sweep.hpp"

#include <fmt/format.h>

#include <array>
#include <string>

namespace lamella {

namespace {

// One row for each engine: help texts, the benchmarks and the tests of agreement all read this table.
constexpr std::array table{
    Engine{"sweep", "links every cut edge once, then writes contours at memory speed", "", run_sweep},
};

} // namespace

std::span<const Engine> engines() noexcept {
    return table;
}

const Engine& engine(std::string_view name) {
    std::string names;
    for (const Engine& candidate : table) {
        if (candidate.name == name)
            return candidate;
        names += names.empty() ? "" : ", ";
        names += candidate.name;
    }
    throw Error(ErrorKind::usage,
                fmt::format("there is no engine named '{}'; the engines are: {}", name, names));
}

} // namespace lamella
