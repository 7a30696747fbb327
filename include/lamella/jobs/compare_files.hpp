#pragma once

// Comparison of two slice files: contours, hatch lines, heights, and exposures.

#include "lamella/core/point.hpp"
#include "lamella/polygon/compare.hpp"
#include "lamella/slices/layer_file.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Comparison of two corresponding layers in everything but their contours.
struct PlaneDetails {
    std::uint64_t first_hatches = 0;
    std::uint64_t second_hatches = 0;
    /// Largest distance between corresponding ends of hatch lines with the same index, and the location of
    /// the first of the two; infinite if the numbers of lines differ.
    double hatch_distance_mm = 0;
    Point2 hatch_where = {};
    double height_distance_mm = 0; ///< of bottoms or of tops, whichever is larger
    bool heights_agree = true;
    bool exposed_alike = true;  ///< false if contours agree only in total, not exposure by exposure
    bool followed_alike = true; ///< false if they agree, but in another order or from other first points
    /// If both planes have images with the same pixels: the number of pixels that differ, and the largest
    /// difference of their values, which are 0 to 255. Contours are then compared only if pixels differ.
    std::optional<std::uint64_t> other_pixels = {};
    unsigned largest_pixel_difference = 0;
    /// Area of the symmetric difference of the contours, if asked for.
    double area_difference_mm2 = 0;
    bool same = false; ///< all of this and the contours are equal, bit for bit
};

/// A parameter that differs between exposures of parts with the same label.
struct ParameterDifference {
    std::string label;     ///< of the part; of jobs for resin printers, "job" or the layer
    std::string parameter; ///< such as "power_w"
    double first = 0;
    double second = 0;
};

/// Differences in planes, and in parameters of parts, of two files.
struct FileComparison {
    /// Comparison of the contours, with all parts of a file taken together. `ComparedPlane::agree` includes
    /// the details.
    StackComparison layers;
    std::vector<PlaneDetails> details; ///< one for each of the planes
    std::vector<ParameterDifference> parameters;
    /// Labels of exposed parts that only one of the files contains.
    std::vector<std::string> only_first;
    std::vector<std::string> only_second;
    /// False if both files have the same format but their exposures are in different orders. Then
    /// `PlaneDetails::same` is false for all planes.
    bool exposures_in_order = true;

    /// Returns whether all planes and all exposures agree.
    [[nodiscard]] bool agree() const noexcept;
};

struct FileComparisonOptions {
    /// The largest distance that is no difference; by default the sum of the rounding errors of both formats.
    std::optional<double> tolerance_mm = {};
    bool area_difference = false; ///< compute the areas that only one of the files has
    std::uint64_t max_memory = 0; ///< limit of the memory for these areas; see layer_limits
};

/// Compares the contours of two files as `compare` does, and the following details:
///
/// - Hatch lines are compared one by one, in their order: exposure by exposure if each exposure has a
///   partner; else part by part if the same labels have hatch lines; else for all parts together. Their ends
///   must agree within the tolerance, by default the sum of the rounding errors of both formats.
/// - If each exposure has a partner, contours must also agree exposure by exposure, in their order, and each
///   from its first point. Between files of one format the exposures must be in the same order; between
///   formats the order may differ.
/// - Bottoms and tops agree up to rounding and 1e-6 mm.
/// - Parameters are compared between exposures with the same label, or else between exposures of the same
///   region, kind and contour number, in their order. Between files of one format, any unequal value is a
///   difference. Between formats a parameter that only one file has is not a difference, because some formats
///   cannot store it.
/// - Between files of one format, an unmatched exposure is a difference.
/// - If both files have images with the same pixels, planes agree if all of these are equal.
/// - Of two jobs for resin printers, the exposures of layers are compared and, between files of one format,
///   the movements of the plate.
///
/// Expected O(n log n) for n points and ends of lines of both files, parallel over planes. Takes memory for
/// the contours of a plane for each thread, also if the layers of a file are not in memory. Throws
/// Error{usage} for a tolerance that is negative or NaN, and if parts of a file have different numbers of
/// layers.
[[nodiscard]] FileComparison compare_files(const LayerFile& first, const LayerFile& second,
                                           const FileComparisonOptions& options = {},
                                           const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
