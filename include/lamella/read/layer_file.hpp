#pragma once

// Reads slice files.

#include "lamella/contour/exposure.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/contour/plane_rule.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/execution.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

struct LayerReadOptions {
    /// Largest number of bytes that the decompressed file and the layers may take; otherwise Error{limit} is
    /// thrown before they are allocated. 0: three quarters of the available memory.
    std::uint64_t max_memory = 0;
    /// Bytes of `max_memory` that previously read files still take (see `memory_of`).
    std::uint64_t held = 0;
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

    /// Returns all parts as one stack: the layers of the only part, or one layer per plane with the contours
    /// of all parts. O(points). Throws Error{usage} if the caller changed the parts so that their numbers of
    /// layers differ.
    [[nodiscard]] LayerStack merged() const;

    /// Returns the layers of all parts on a plane, with their hatch lines. O(contours).
    [[nodiscard]] ScanVectors plane(std::size_t position) const;
};

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
