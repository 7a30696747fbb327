#pragma once

// Reads slice files.

#include "lamella/contour/exposure.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/contour/plane_rule.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// The layers that stay in memory while a file is open. All others are parsed again; see LayerStream.
enum class LayersKept {
    all,
    /// All if `max_memory` is at least eight times the size of the decompressed file, otherwise none. For
    /// layers that take long to process and that are needed more than once.
    if_ample,
    /// Only those of text formats (ASCII Common Layer Interface, SVG, JSON, 3MF), which take long to
    /// parse, and only if `max_memory` is at least eight times the size of the text.
    if_faster,
    none, ///< none if the format allows it
};

struct LayerReadOptions {
    /// Largest number of bytes that the decompressed file and the layers may take; otherwise Error{limit} is
    /// thrown before they are allocated. 0: three quarters of the available memory.
    std::uint64_t max_memory = 0;
    /// Bytes of `max_memory` that previously read files still take (see `memory_of`).
    std::uint64_t held = 0;
    LayersKept layers = LayersKept::all;
};

/// A part of a slice file.
struct LayerPart {
    /// "" if the file has no label. Some readers append a number to make labels unique.
    std::string label;
    LayerStack layers;
    /// Set if the layers are scan vectors. These have the order of execution and are not in normal form.
    /// Parameters that the file does not specify are 0.
    std::optional<Exposure> exposure = {};
    bool support = false; ///< true if the file marks it as a support; only 3MF files can
    /// Hatch lines of each layer, two points for each line; empty if the part has none.
    std::vector<PointArray> hatches = {};

    [[nodiscard]] std::span<const Point2> hatches_of(std::size_t layer) const {
        return hatches.empty() ? std::span<const Point2>() : hatches[layer].span();
    }
    /// Returns the number of hatch lines of all layers.
    [[nodiscard]] std::uint64_t hatch_lines() const noexcept;
};

/// The contents of a plane, all parts together.
struct PlaneContent {
    bool contours = false;
    std::uint64_t hatch_lines = 0;
};

/// The layers of a file that is parsed twice: once for what is known of the whole file, and then plane by
/// plane, when a plane is needed. So only a few layers are in memory at a time. The bytes of the file stay in
/// memory, or in a temporary file if they are large.
struct LayerStream {
    /// The planes as layers without contours, ascending.
    LayerStack planes = {};
    std::vector<Box3> boxes = {};                ///< of each part, like `part_box`
    std::vector<std::uint64_t> hatch_lines = {}; ///< number of hatch lines of each part
    std::vector<PlaneContent> contents = {};     ///< of each plane
    double largest_coordinate = 0;               ///< of contours: largest absolute value
    double largest_hatch_coordinate = 0;         ///< of hatch lines
    std::uint64_t bytes = 0;                     ///< memory that it takes
    std::uint64_t plane_bytes = 0;               ///< memory for parsing the largest plane
    std::uint64_t spare_bytes = 0; ///< memory that `max_memory` leaves for planes; used for `for_planes`
    /// Parses the contours and hatch lines of the plane at this position, without its heights. May be called
    /// by any number of threads at once.
    std::function<ScanVectors(std::size_t position)> parse = {};
};

struct LayerFile {
    std::string path;
    std::string format;  ///< name of the format as in `layer_formats`, such as "cli"
    double units_mm = 0; ///< millimetres per coordinate unit of the file; coordinates are already millimetres
    Rounding rounding = {}; ///< rounding of coordinates and heights by the format
    /// The rule by which the layers were cut, if the format specifies it; otherwise section_above.
    PlaneRule rule = PlaneRule::section_above;
    std::vector<LayerPart> parts = {};      ///< at least one; all have the same planes
    std::vector<std::string> warnings = {}; ///< one line each: the irregularity, and how the reader treated
                                            ///< it
    /// The warning that the heights in the file are interpreted as bottoms of layers although the format
    /// defines them as tops; empty unless the reader guessed so.
    std::string guess = {};
    /// Set if the layers are not in memory: then parts have no layers and no hatch lines, and `planes`,
    /// `hatch_lines` and `plane` return those of the stream. Not set with LayersKept::all.
    std::shared_ptr<const LayerStream> stream = nullptr;

    /// Returns the layers of the first part, whose heights are those of all parts. If the layers are not in
    /// memory, they have no contours.
    [[nodiscard]] const LayerStack& planes() const noexcept;
    /// Returns the number of hatch lines of a part.
    [[nodiscard]] std::uint64_t hatch_lines(std::size_t part) const;
    /// Returns what each plane holds. O(layers), without parsing.
    [[nodiscard]] std::vector<PlaneContent> contents() const;

    /// Parses all layers of a stream, so that they are in memory. Parallel. Throws the errors of
    /// `read_layers` for these options.
    void keep_layers(const LayerReadOptions& options = {}, const Execution& execution = {});

    /// Returns all parts as one stack: the layers of the only part, or one layer per plane with the contours
    /// of all parts. O(points), parallel. Throws as `check(const LayerFile&)` does, and Error{cancelled}.
    [[nodiscard]] LayerStack merged(const Execution& execution = {.threads = 1}) const;

    /// Returns `execution` with no more threads than there may be planes of the stream in memory at the same
    /// time, but at least one.
    [[nodiscard]] Execution for_planes(const Execution& execution) const;

    /// Returns the layers of all parts on a plane, with their hatch lines. O(contours), or, if the layers are
    /// not in memory, the time for parsing them.
    [[nodiscard]] ScanVectors plane(std::size_t position) const;
};

/// Throws Error{usage} if the caller changed the parts so that their numbers of layers differ.
void check(const LayerFile& file);

/// Returns the bytes that the layers of a file take. O(layers).
[[nodiscard]] std::uint64_t memory_of(const LayerFile& file) noexcept;

/// Reads a slice file and recognises its format by the content: Common Layer Interface (binary or ASCII),
/// layered SVG, SLC, 3MF with slice stacks, layers as JSON, NumPy arrays, ILT, Open Vector Format or 3MF with
/// toolpaths. Each may be compressed with gzip. "-" reads standard input. Layers are in ascending z. Layers
/// without an exposure are in normal form. Values that the format does not store are derived from others. For
/// example, the Common Layer Interface stores only the tops of layers, so the cut is assumed to be half-way
/// up. Throws Error{input} that reports the file, the byte or line, the text found and the text expected.
[[nodiscard]] LayerFile read_layers(const std::string& path, const LayerReadOptions& options = {},
                                    const Execution& execution = {});

/// Reads bytes in memory; `name` replaces the path in errors.
[[nodiscard]] LayerFile read_layers(std::span<const std::byte> bytes, const std::string& name,
                                    const LayerReadOptions& options = {}, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
