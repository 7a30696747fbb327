#pragma once

// How far two slice files are from being the same: contours, hatch lines, heights, and what the beam does.

#include "lamella/core/point.hpp"
#include "lamella/polygon/compare.hpp"
#include "lamella/read/layer_file.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// What two layers that belong together have besides their contours.
struct PlaneDetails {
    std::uint64_t first_hatches = 0;
    std::uint64_t second_hatches = 0;
    /// The largest way from an end of a hatch line to that of the line of the same number, and where it
    /// begins; infinite where there are not as many.
    double hatch_distance_mm = 0;
    Point2 hatch_where = {};
    double height_distance_mm = 0; ///< of bottoms or of tops, whichever are farther apart
    bool heights_agree = true;
    bool exposed_alike = true;  ///< whether contours that agree all together do so exposure by exposure
    bool followed_alike = true; ///< and whether these are followed in one order, each from the same point
    bool same = false;          ///< all of it and the contours, bit for bit
};

/// A number of the parameters by which parts of one label are exposed.
struct ParameterDifference {
    std::string label;
    std::string parameter; ///< such as "power_w"
    double first = 0;
    double second = 0;
};

/// Planes, and parameters of parts, of two files.
struct FileComparison {
    /// Of all parts of a file together. `agree` is of the details, too.
    StackComparison layers;
    std::vector<PlaneDetails> details; ///< of each of the planes
    std::vector<ParameterDifference> parameters;
    /// Labels of what one file exposes and the other does not.
    std::vector<std::string> only_first;
    std::vector<std::string> only_second;
    /// Whether the exposures of files of one format come in one order. If not, no planes are the same.
    bool exposures_in_order = true;

    /// All planes, and all that is exposed.
    [[nodiscard]] bool agree() const noexcept;
};

/// Compares the contours of two files as `compare` does. Hatch lines are compared one by one, in their order:
/// exposure by exposure where each has a partner, or part by part where the same labels have some, else those
/// of all parts. Their ends agree within the tolerance; unless given, what rounding explains. Contours have
/// to agree exposure by exposure, too, where each has a partner: in order, and each from its first point. So
/// does the order of the exposures, in files of one format; other ones may keep another order. Bottoms and
/// tops agree up to what rounding explains and 1e-6 mm. Parameters of parts that expose anything, of the same
/// label, or else of the same region, kind and contour in their order, differ where files of one format say
/// other numbers; of different formats, not all of which have a place for each, where both say one. What has
/// no partner counts in files of one format. Expected O(n log n) for n points and ends of lines of both,
/// whose contours are in memory a second time.
[[nodiscard]] FileComparison compare_files(const LayerFile& first, const LayerFile& second,
                                           std::optional<double> tolerance_mm = {},
                                           const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
