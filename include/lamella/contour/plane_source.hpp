#pragma once

// Planes of one or more parts whose contents are made one plane at a time: those of a slice file, or of
// layers in memory.

#include "lamella/contour/exposure.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/contour/plane_rule.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/contour/run_image.hpp"
#include "lamella/core/commit.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// A part of all planes, or one exposure of a part.
struct PartInfo {
    std::string label = "part";
    Box3 box = {}; ///< mm, of contours and hatch lines; empty if there are none, or if it is unknown
    /// If set, the contours and hatch lines are scan vectors; see `scan`. Parameters that a file does not
    /// specify are 0.
    std::optional<Exposure> exposure = {};
    bool support = false;          ///< true for a support, which has parameters of its own; 3MF files mark it
    std::uint64_t hatch_lines = 0; ///< on all planes of a source; the header of a file does not need it
};

/// The contents of a plane, all parts together.
struct PlaneContent {
    std::uint64_t points = 0; ///< of contours
    std::uint64_t hatch_lines = 0;
};

/// The layers of a part in memory.
struct LayerPart {
    std::string label = {}; ///< "" if the part has none
    LayerStack layers = {};
    /// Set if the layers are scan vectors, which have the order of execution and are not in normal form.
    std::optional<Exposure> exposure = {};
    bool support = false;
    /// Hatch lines of each layer, two points for each line; empty if the part has none.
    std::vector<PointArray> hatches = {};

    [[nodiscard]] std::span<const Point2> hatches_of(std::size_t layer) const {
        return hatches.empty() ? std::span<const Point2>() : hatches[layer].span();
    }
};

/// Which planes of a slice file stay in memory, if its format can parse single planes again. The others are
/// parsed again when they are needed; the bytes of the file then stay in memory, or in a temporary file if
/// they are large.
enum class KeptPlanes : std::uint8_t {
    all,
    /// Planes of text formats (ASCII Common Layer Interface, SVG, JSON, 3MF), which take long to parse, stay
    /// if `max_memory` is at least eight times the size of the text.
    if_faster,
    none,
};

/// Takes a plane of a source, at a position; see PlaneSource::run.
using PlaneSink = std::function<Commit(std::size_t position, Plane plane)>;
/// Takes a plane of a source, at a position, on a thread with this number; see PlaneSource::visit.
using PlaneVisitor = std::function<void(std::size_t position, Plane plane, unsigned worker)>;

/// Planes whose contents are made when they are needed.
struct PlaneSource {
    std::string path = {};  ///< of the file, for errors; may be ""
    LayerStack planes = {}; ///< index and heights of each plane, without contours; those of a file ascend
    std::vector<PartInfo> parts = {};        ///< at least one if there are planes; labels may be ""
    std::vector<PlaneContent> contents = {}; ///< of each plane; empty if they are unknown
    Rounding rounding = {};                  ///< of coordinates and heights
    /// The rule by which the layers were cut, as far as it is known.
    PlaneRule rule = PlaneRule::section_above;
    double largest_coordinate = 0;       ///< largest absolute value of the coordinates of contours
    double largest_hatch_coordinate = 0; ///< largest absolute value of the coordinates of hatch lines
    /// The pixels of Plane::image, which each plane then has.
    std::optional<PixelGrid> grid = {};

    std::uint64_t bytes = 0;       ///< memory that the source takes
    std::uint64_t plane_bytes = 0; ///< memory for making the largest plane; 0 if all planes are in memory
    /// Memory that a limit leaves for making planes.
    std::uint64_t spare_bytes = std::numeric_limits<std::uint64_t>::max();

    /// Makes the contours and hatch lines of the plane at this position, for each part. It need not set
    /// heights and indices, which `plane` does. May be called by any number of threads at once.
    std::function<Plane(std::size_t position)> make = {};

    /// Returns the contours and hatch lines of all parts on a plane, with its heights. O(contours) if all
    /// planes are in memory, otherwise the time for making them. May be called by any number of threads.
    [[nodiscard]] Plane plane(std::size_t position) const;

    /// Passes all planes to `sink`, on all threads, and calls the commits that it returns in ascending order
    /// (see Commit). Each thread holds one plane. Reports the progress of this stage. Throws the errors of
    /// `plane` and of the sink, and Error{cancelled}.
    void run(Stage stage, const PlaneSink& sink, const Execution& execution = {}) const;
    /// Passes all planes to `visitor`, on all threads and in any order, with the number of the thread. Throws
    /// the errors of `plane` and of the visitor, and Error{cancelled}.
    void visit(Stage stage, const PlaneVisitor& visitor, const Execution& execution = {}) const;

    /// Returns the number of hatch lines of all parts. O(parts).
    [[nodiscard]] std::uint64_t hatch_lines() const noexcept;

    /// Returns the layers of all parts. Parallel. Throws the errors of `plane`, and Error{cancelled}.
    [[nodiscard]] std::vector<LayerPart> in_memory(const Execution& execution = {.threads = 1}) const;

    /// Returns all parts as one stack: the layers of the only part, or one layer for each plane with the
    /// contours of all parts. O(points), parallel. Throws the errors of `plane`, and Error{cancelled}.
    [[nodiscard]] LayerStack merged(const Execution& execution = {.threads = 1}) const;

    /// Returns `execution` with at most as many threads as planes fit into `spare_bytes`, and at least one.
    [[nodiscard]] Execution for_planes(const Execution& execution) const;
};

/// Returns a source of planes in memory, which have these parts; boxes and numbers of hatch lines are
/// computed. O(points), parallel. Throws Error{usage} if a plane has another number of parts, or does not
/// pass `check`.
[[nodiscard]] PlaneSource source_of(std::vector<Plane> planes, std::vector<PartInfo> parts,
                                    std::string path = {}, const Execution& execution = {.threads = 1});

/// Returns a source of layers in memory. `path` is a name for errors. O(points), parallel. Throws
/// Error{usage} if the parts do not have the same planes (number, indices and heights), if a part has hatch
/// lines for another number of layers, or if a plane does not pass `check`.
[[nodiscard]] PlaneSource source_of(std::vector<LayerPart> parts, std::string path = {},
                                    const Execution& execution = {.threads = 1});

/// Returns a source of these stacks, each as one part without a label.
[[nodiscard]] PlaneSource source_of(std::vector<LayerStack> parts, const Rounding& rounding = {},
                                    const Execution& execution = {.threads = 1});

/// Returns the source with only the parts at these positions, ascending. Contents and largest coordinates
/// remain those of all parts. Images are dropped unless all parts remain.
[[nodiscard]] PlaneSource with_parts(const PlaneSource& source, std::vector<std::size_t> parts);

} // namespace lamella
LAMELLA_API_END
