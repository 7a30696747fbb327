#include "lamella/pipeline/scan_layers.hpp"

#include "lamella/core/error.hpp"

#include "core/stopwatch.hpp"
#include "pipeline/plane_scan.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>

namespace lamella {

LayerFileInfo with_exposures(const LayerFileInfo& info, const ScanStrategy& strategy) {
    LayerFileInfo exposed = info;
    exposed.parts.clear();
    for (const PartInfo& part : info.parts)
        for (const Exposure& exposure :
             part.support ? support_exposures(strategy, part.label) : exposures(strategy, part.label))
            exposed.parts.push_back({exposure.label(), part.box, exposure, part.support});
    return exposed;
}

namespace {

/// Planes of several stacks.
class Stacks {
  public:
    Stacks(std::span<const LayerStack> parts, const Rounding& rounding) {
        planes_.resize(parts.empty() ? 0 : parts.front().size());
        for (const LayerStack& part : parts) {
            if (part.size() != planes_.size())
                throw Error(ErrorKind::usage, "parts of one file must have the same planes");
            for (std::size_t i = 0; i < part.size(); ++i) {
                ScanLayer& layer = planes_[i].emplace_back(part[i], rounding);
                if (i > 0)
                    layer.share_points(planes_[i - 1][planes_[i].size() - 1]);
            }
        }
    }

    [[nodiscard]] std::size_t size() const noexcept { return planes_.size(); }

    /// A plane with the neighbours that a strategy asks for.
    [[nodiscard]] PlaneLayers plane(std::size_t i, const ScanStrategy& strategy) const {
        PlaneLayers found{.parts = planes_[i]};
        for (std::size_t k = 1; k <= std::min<std::size_t>(strategy.downskin.layers, i); ++k)
            found.below.emplace_back(planes_[i - k]);
        for (std::size_t k = 1; k <= std::min<std::size_t>(strategy.upskin.layers, size() - 1 - i); ++k)
            found.above.emplace_back(planes_[i + k]);
        return found;
    }

  private:
    std::vector<std::vector<ScanLayer>> planes_; ///< of all parts
};

} // namespace

ScanResult scan_layers(const std::string& path, const LayerFormat& format, std::span<const LayerStack> parts,
                       const Rounding& rounding, const LayerFileInfo& info, const ScanStrategy& strategy,
                       const LayerWriteOptions& options, const Execution& execution) {
    check_strategy(strategy);
    const Stacks stacks(parts, rounding);
    ScanResult result;
    std::vector<bool> supports;
    for (const PartInfo& part : info.parts)
        supports.push_back(part.support);
    for (Exposure& exposure : plane_exposures(supports, strategy))
        result.exposures.push_back({std::move(exposure), {}});
    result.layers.resize(stacks.size());
    std::vector<ScanMemory> memories(supports.size());
    std::atomic<std::uint64_t> nanoseconds{0};
    const std::unique_ptr<LayerWriter> writer =
        open_layer_writer(path, format, with_exposures(info, strategy), options);
    const auto vectors_of = [&](std::size_t i) {
        const Stopwatch scanning;
        PlaneVectors vectors = scan_plane(stacks.plane(i, strategy), supports, strategy, memories);
        nanoseconds.fetch_add(static_cast<std::uint64_t>(1e9 * scanning.seconds()),
                              std::memory_order_relaxed);
        result.layers[i] = std::move(vectors.figures);
        return std::move(vectors.layers);
    };
    write_planes(*writer, stacks.size(), vectors_of, execution);
    writer->finish();
    for (const std::vector<ScanFigures>& layer : result.layers)
        for (std::size_t i = 0; i < layer.size(); ++i)
            result.exposures[i].figures += layer[i];
    result.scan_seconds = 1e-9 * static_cast<double>(nanoseconds);
    result.bytes = writer->bytes();
    result.warnings = writer->warnings();
    return result;
}

} // namespace lamella
