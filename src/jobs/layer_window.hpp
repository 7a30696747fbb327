#pragma once

// Holds planes until their neighbours arrive.

#include "lamella/contour/layer.hpp"
#include "lamella/core/commit.hpp"
#include "lamella/slicing/plan.hpp"

#include "jobs/plane_scan.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace lamella {

/// Returns a range extended by these numbers of planes below and above, within `all`.
[[nodiscard]] PlaneRange widened(PlaneRange planes, std::uint32_t below, std::uint32_t above,
                                 PlaneRange all) noexcept;

/// Passes planes on together with their neighbours below and above. Each plane arrives once, and is processed
/// in two halves (see Commit). `prepare` stores the layers of the plane, and works on the planes whose
/// neighbours are then complete. The commit of plane i commits the planes whose last neighbour is i. So no
/// thread waits for another, and the number of layers in memory is bounded. Equal layers of adjacent planes
/// share their points.
class LayerWindow {
  public:
    /// Like PlateSink::prepare, for a plane with its neighbours.
    using Work = std::function<Commit(const PlaneLayers& plane)>;

    /// Prepares a layer of a part.
    using Make = std::function<ScanLayer(std::size_t part, const Layer& layer)>;

    /// `coming` is the range of planes that will arrive; those in `wanted` are worked on, each with up to
    /// `below` and `above` of the arriving planes.
    LayerWindow(PlaneRange coming, PlaneRange wanted, std::uint32_t below, std::uint32_t above, Make make,
                Work work);

    /// Adds the layers of all parts on a plane. May be called from any thread.
    [[nodiscard]] Commit prepare(std::uint32_t plane, std::span<const Layer> parts);

    /// Returns the number of planes whose layers are held. No other call may run at the same time.
    [[nodiscard]] std::size_t held() const noexcept { return held_.size(); }

  private:
    using Parts = std::shared_ptr<const std::vector<ScanLayer>>;
    struct Held {
        Parts parts;
        std::uint32_t users; ///< number of planes that still need the layers
    };
    struct Complete {
        std::uint32_t plane;
        std::vector<Parts> layers; ///< ascending
    };

    [[nodiscard]] PlaneRange neighbours(std::uint32_t plane) const noexcept;
    [[nodiscard]] PlaneRange users(std::uint32_t plane) const noexcept;
    [[nodiscard]] Parts held_beside(std::uint32_t plane);
    [[nodiscard]] std::vector<Complete> store(std::uint32_t plane, Parts parts);
    [[nodiscard]] Complete take(std::uint32_t plane);
    void work_on(const Complete& complete);
    void finish(std::uint32_t last, Completions& after);

    PlaneRange coming_;
    PlaneRange wanted_;
    std::uint32_t below_;
    std::uint32_t above_;
    Make make_;
    Work work_;
    std::mutex mutex_;
    std::map<std::uint32_t, Held> held_;
    std::map<std::uint32_t, std::uint32_t> missing_; ///< number of missing neighbours, if any
    std::map<std::uint32_t, Commit> ready_;
};

} // namespace lamella
