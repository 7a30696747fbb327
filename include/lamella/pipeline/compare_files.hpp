#pragma once

// Comparison of two slice files: contours, hatch lines, heights, and exposures.

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

/// Details of two corresponding layers besides their contours.
struct PlaneDetails {
    std::uint64_t first_hatches = 0;
    std::uint64_t second_hatches = 0;
    /// Largest distance from an end of a hatch line to that of the line with the same index, and the location
    /// of that end; infinite if the numbers of lines differ.
    double hatch_distance_mm = 0;
    Point2 hatch_where = {};
    double height_distance_mm = 0; ///< of bottoms or of tops, whichever is larger
    bool heights_agree = true;
    bool exposed_alike = true;  ///< contours that agree in total also agree exposure by exposure
    bool followed_alike = true; ///< and are exposed in one order, each from the same point
    bool same = false;          ///< these and the contours are equal, bit for bit
};

/// A parameter that differs between the exposures of parts of one label.
struct ParameterDifference {
    std::string label;
    std::string parameter; ///< such as "power_w"
    double first = 0;
    double second = 0;
};

/// Differences in planes, and in parameters of parts, of two files.
struct FileComparison {
    /// Comparison of all parts of a file together. `agree` covers the details, too.
    StackComparison layers;
    std::vector<PlaneDetails> details; ///< one for each of the planes
    std::vector<ParameterDifference> parameters;
    /// Labels of parts that only one file exposes.
    std::vector<std::string> only_first;
    std::vector<std::string> only_second;
    /// True if the exposures of files of one format are in one order. If not, no planes are the same.
    bool exposures_in_order = true;

    /// Returns whether all planes and all exposures agree.
    [[nodiscard]] bool agree() const noexcept;
};

/// Compares the contours of two files as `compare` does, and these details:
///
/// - Hatch lines are compared one by one, in their order: exposure by exposure if each exposure has a
///   partner; else part by part if the same labels have hatch lines; else those of all parts together. Their
///   ends agree within the tolerance, by default that explained by rounding.
/// - Contours must also agree exposure by exposure, if each has a partner: in order, and each from its first
///   point. So must the order of the exposures in files of one format; between formats it may differ.
/// - Bottoms and tops agree up to rounding and 1e-6 mm.
/// - Parameters are compared between exposed parts of the same label, or else of the same region, kind and
///   contour in their order. Between files of one format any other number is a difference; formats cannot all
///   hold each parameter, so between formats it is one only if both files have the parameter.
/// - Between files of one format, an unmatched exposure is a difference.
///
/// Expected O(n log n) for n points and ends of lines of both files. Contours are copied once in memory.
[[nodiscard]] FileComparison compare_files(const LayerFile& first, const LayerFile& second,
                                           std::optional<double> tolerance_mm = {},
                                           const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
