#pragma once

// Scan vectors of existing layers, written to a file.

#include "lamella/contour/exposure.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/pipeline/layer_warnings.hpp"
#include "lamella/scan/scan.hpp"
#include "lamella/scan/strategy.hpp"
#include "lamella/write/layer_writer.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Figures of one of the `exposures` of a strategy, or of one of its `support_exposures`.
struct ExposureResult {
    Exposure exposure; ///< of all parts, so without a part
    ScanFigures figures;
};

/// Returns the header of a slice file for scan vectors: each part is replaced by its exposures, with the
/// label of the part and their own name, such as "bracket core hatch".
[[nodiscard]] LayerFileInfo with_exposures(const LayerFileInfo& info, const ScanStrategy& strategy);

/// Layers with more material out of reach of all vectors than the strategy accepts for a part.
struct UnreachedMaterial : AffectedLayers {
    double area_mm2 = 0; ///< of all of these layers

    /// Adds the next layer above.
    void add(double unreached_mm2, double z) noexcept;
    /// Returns "8.1 mm2 of material on 10 layers, the lowest at z = 0.5 mm, are reached by no vector: ...",
    /// with a remedy.
    [[nodiscard]] std::string text() const;
};

struct ScanResult {
    /// Figures in the order of execution, over all layers and parts, supports last. A beam exposes the parts
    /// of a layer one after the other; its jumps between layers are not counted.
    std::vector<ExposureResult> exposures;
    /// The same figures for each layer.
    std::vector<std::vector<ScanFigures>> layers;
    /// Hash of the vectors of each layer: see LayerStatistics::scan_hash.
    std::vector<std::uint64_t> hashes;
    UnreachedMaterial unreached;
    double scan_seconds = 0; ///< sum over all threads
    std::uint64_t bytes = 0; ///< written
    std::vector<std::string> warnings;
};

/// Scans the layers of parts, whose stacks have the same planes, and writes the vectors. `rounding` is that
/// of their file, none for layers just cut; `info` is the header of a file of these layers. Existing hatches
/// of layers are ignored. Runs on all threads, each of which holds the vectors of one plane. Throws the
/// errors of `scan` and `write_layers`, and, with LayerWriteOptions::strict, Error{defect} for material that
/// no vector reaches. `max_memory`: see layer_limits. `name` is what errors call the file that the layers
/// come from.
[[nodiscard]] ScanResult scan_layers(const std::string& path, const LayerFormat& format,
                                     std::span<const LayerStack> parts, const Rounding& rounding,
                                     const LayerFileInfo& info, const ScanStrategy& strategy,
                                     const LayerWriteOptions& options = {}, const Execution& execution = {},
                                     std::uint64_t max_memory = 0, const std::string& name = {});

} // namespace lamella
LAMELLA_API_END
