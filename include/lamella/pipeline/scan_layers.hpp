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
    Exposure exposure; ///< without the label of a part: the figures are those of all parts
    ScanFigures figures;
};

/// Returns the header of a slice file for scan vectors. Each part is replaced by its exposures, whose labels
/// are the label of the part followed by the name of the exposure, such as "bracket core hatch".
[[nodiscard]] LayerFileInfo with_exposures(const LayerFileInfo& info, const ScanStrategy& strategy);

/// Layers with more material of a part that no vector reaches than the strategy accepts.
struct UnreachedMaterial : AffectedLayers {
    double area_mm2 = 0; ///< of all of these layers

    /// Adds the next layer above.
    void add(double unreached_mm2, double z) noexcept;
    /// Returns "8.1 mm2 of material on 10 layers, the lowest at z = 0.5 mm, are reached by no vector: ...",
    /// with a remedy.
    [[nodiscard]] std::string text() const;
};

struct ScanResult {
    /// Figures of each exposure, over all layers and parts, in the order of execution, supports last. One
    /// beam exposes the parts of a layer one after the other. Jumps between layers are not counted.
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

/// Computes the scan vectors of the layers of parts and writes them. The stacks of all parts must have the
/// same planes. `rounding` is that of the file from which the layers were read; by default none. `info` is
/// the header for a file of these layers. `name` is the name of their file in error messages; if it is empty,
/// `path` is. `max_memory`: see layer_limits. Existing hatch lines of layers are ignored. Uses all threads,
/// each of which holds the vectors of one plane in memory. Throws the errors of `scan` and `write_layers`,
/// and, with LayerWriteOptions::strict, Error{defect} for material that no vector reaches.
[[nodiscard]] ScanResult scan_layers(const std::string& path, const LayerFormat& format,
                                     std::span<const LayerStack> parts, const Rounding& rounding,
                                     const LayerFileInfo& info, const ScanStrategy& strategy,
                                     const LayerWriteOptions& options = {}, const Execution& execution = {},
                                     std::uint64_t max_memory = 0, const std::string& name = {});

} // namespace lamella
LAMELLA_API_END
