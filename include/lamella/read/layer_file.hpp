#pragma once

// Reading slice files back.

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
    /// More bytes than this, of what is unpacked and of the layers, are Error{limit}; 0: three
    /// quarters of the memory there is. They are counted before there is memory for them.
    std::uint64_t max_memory = 0;
};

/// One of the parts that a file holds.
struct LayerPart {
    /// "" where the file has none; some readers put a number behind one that is there before.
    std::string label;
    LayerStack layers;
    /// Where the file says so, the layers are scan vectors: in the order in which they are executed, not in
    /// normal form. Numbers of the parameters that it does not say are 0.
    std::optional<Exposure> exposure = {};
    bool support = false; ///< the file marks it so, as 3MF can
};

struct LayerFile {
    std::string path;
    std::string format;  ///< as in the table of formats that are written, such as "cli"
    double units_mm = 0; ///< millimetres per coordinate unit of the file; coordinates are already millimetres
    Rounding rounding = {}; ///< of coordinates and heights, by the format
    /// By which the layers were cut, where the format says it; else the usual one.
    PlaneRule rule = PlaneRule::section_above;
    std::vector<LayerPart> parts = {};      ///< at least one; all have the same planes
    std::vector<std::string> warnings = {}; ///< one line each: what was odd and what was made of it
    /// That of the warnings which says that heights are taken for bottoms of layers, where that is a guess
    /// and the format has tops.
    std::string guess = {};

    /// All parts as one: the layers of the only part, or for each plane the contours of all. O(points).
    /// Throws Error{usage} where the caller has made the parts differ in the number of their layers.
    [[nodiscard]] LayerStack merged() const;
};

/// Reads a slice file, by its content: Common Layer Interface (binary or ASCII), layered SVG, SLC, 3MF with
/// slice stacks, JSON of layers, NumPy arrays, ILT, Open Vector Format or 3MF with toolpaths, each also
/// packed with gzip. "-" reads standard input. Layers come in ascending z, and in normal form but for
/// exposures; what the format does not say is made from what it does (a Common Layer Interface layer knows
/// its top: its cut is taken half-way up). Throws Error{input} with file, byte or line, what was found and
/// what was expected.
[[nodiscard]] LayerFile read_layers(const std::string& path, const LayerReadOptions& options = {},
                                    const Execution& execution = {});

/// The same from bytes in memory; `name` stands for the path in errors.
[[nodiscard]] LayerFile read_layers(std::span<const std::byte> bytes, const std::string& name,
                                    const LayerReadOptions& options = {}, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
