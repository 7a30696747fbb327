#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/slicing/slice.hpp"

#include <fmt/format.h>

#include <array>
#include <string>

namespace lamella {

// Each function is defined in the source named after it. It needs no header because only this table uses it.
using SliceFunction = void(const SliceJob& job);
SliceFunction slice_by_sweep;
SliceFunction slice_by_conventional;
SliceFunction slice_by_ecc;
SliceFunction slice_by_ecc_edge_match;
SliceFunction slice_by_eecc;

namespace {

// One row per engine. Help texts, manuals, Python and the tests of all engines read this table.
constexpr std::array table{
    Engine{"sweep", "links every cut edge once, then writes contours at memory speed", "", false,
           slice_by_sweep},
    Engine{"conventional", "sorts the segments of each plane by their end points",
           "King, Rennie, Bennett 2021, Fig. 1", true, slice_by_conventional},
    Engine{"ecc", "efficient contour construction: inserts intersections into lists by their edges",
           "Zhang, Joshi 2015", true, slice_by_ecc},
    Engine{"ecc-edge-match", "ecc that searches only once on each pair of edges",
           "King, Rennie, Bennett 2021, section 3.2", true, slice_by_ecc_edge_match},
    Engine{"eecc", "enhanced efficient contour construction: ecc-edge-match without completed lists",
           "King, Rennie, Bennett 2021", true, slice_by_eecc},
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
                fmt::format("there is no engine named '{}'; the engines are: {}", excerpt(name), names));
}

} // namespace lamella
