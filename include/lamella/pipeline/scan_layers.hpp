#pragma once

// Layers that are there already: their scan vectors, written to a file.

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

/// What one of the `exposures` of a strategy takes, or one of its `support_exposures`.
struct ExposureResult {
    Exposure exposure; ///< of no part: of all of them
    ScanFigures figures;
};

/// The head of a slice file for scan vectors: in the place of each part its exposures, called by the label of
/// the part and their own name, such as "bracket core hatch".
[[nodiscard]] LayerFileInfo with_exposures(const LayerFileInfo& info, const ScanStrategy& strategy);

/// Layers with more material that no vector reaches than the strategy accepts of a part.
struct UnreachedMaterial : AffectedLayers {
    double area_mm2 = 0; ///< of all of these layers

    /// Of the next layer above.
    void add(double unreached_mm2, double z) noexcept;
    /// "8.1 mm2 of material on 10 layers, the lowest at z = 0.5 mm, are reached by no vector: ...", with the
    /// cure.
    [[nodiscard]] std::string text() const;
};

struct ScanResult {
    /// In the order in which they are executed, all layers and parts together, those of supports last. A beam
    /// goes through the parts of a layer one after the other; how it comes from layer to layer does not
    /// count.
    std::vector<ExposureResult> exposures;
    /// For each layer what each of these takes.
    std::vector<std::vector<ScanFigures>> layers;
    /// And the hash of its vectors: see LayerStatistics::scan_hash.
    std::vector<std::uint64_t> hashes;
    UnreachedMaterial unreached;
    double scan_seconds = 0; ///< of all threads
    std::uint64_t bytes = 0; ///< written
    std::vector<std::string> warnings;
};

/// Scans the layers of parts, whose stacks have the same planes, and writes the vectors. `rounding`: of the
/// file that they come from, none for layers just cut; `info`: the head of a file of these layers. Hatches
/// that layers have already do not count. On all threads, each of which holds the vectors of one plane.
/// Throws what `scan` and `write_layers` throw, and Error{defect} for material that no
/// vector reaches with LayerWriteOptions::strict.
[[nodiscard]] ScanResult scan_layers(const std::string& path, const LayerFormat& format,
                                     std::span<const LayerStack> parts, const Rounding& rounding,
                                     const LayerFileInfo& info, const ScanStrategy& strategy,
                                     const LayerWriteOptions& options = {}, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
