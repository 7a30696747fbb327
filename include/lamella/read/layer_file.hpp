#pragma once

// Reads slice files.

#include "lamella/contour/plane_source.hpp"
#include "lamella/core/execution.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// The planes of a slice file that stay in memory. All others are parsed again when they are needed; the
/// bytes of the file then stay in memory, or in a temporary file if they are large.
enum class KeptPlanes : std::uint8_t {
    all,
    /// Those of text formats (ASCII Common Layer Interface, SVG, JSON, 3MF), which take long to parse, and
    /// only if `max_memory` is at least eight times the size of the text.
    if_faster,
    none,
};

struct LayerReadOptions {
    /// Largest number of bytes that the decompressed file and the layers may take; otherwise Error{limit} is
    /// thrown before they are allocated. 0: three quarters of the available memory.
    std::uint64_t max_memory = 0;
    /// Bytes of `max_memory` that previously read files still take (see PlaneSource::bytes).
    std::uint64_t held = 0;
    KeptPlanes kept = KeptPlanes::all;
};

/// The planes of a slice file, which has at least one part. Coordinates are in millimetres.
struct LayerFile : PlaneSource {
    std::string format = {};                ///< name of the format as in `layer_formats`, such as "cli"
    double units_mm = 0;                    ///< millimetres per coordinate unit of the file
    std::vector<std::string> warnings = {}; ///< one line each: the irregularity, and how the reader treated
                                            ///< it
    /// The warning that the heights in the file are interpreted as bottoms of layers although the format
    /// defines them as tops; empty unless the reader guessed so.
    std::string guess = {};
};

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
