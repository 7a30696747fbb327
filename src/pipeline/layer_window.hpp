#pragma once

// Planes that wait for their neighbours.

#include "lamella/contour/layer.hpp"
#include "lamella/slicing/plan.hpp"

#include "pipeline/plane_scan.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace lamella {

/// Planes with so many below and above them, as far as there are any among `all`.
[[nodiscard]] PlaneRange widened(PlaneRange planes, std::uint32_t below, std::uint32_t above,
                                 PlaneRange all) noexcept;

/// Hands planes on together with the planes beneath and on top. Each comes once, in two halves as those of a
/// PlateSink: in the parallel half its layers are stored, and whichever planes have all of their neighbours
/// by it are worked on there; in the ordered half of plane i those become ready of which i is the last
/// neighbour. So nobody waits for anybody, and memory has a window of layers. A layer that is the same as one
/// beside it shares its points.
class LayerWindow {
  public:
    /// As PlateSink, for a plane with its neighbours.
    using Work = std::function<std::function<void()>(const PlaneLayers& plane)>;

    /// `coming`: the planes that will come, of which those `wanted` are worked on, with so many planes below
    /// and above each as there are of those that come, and no more than asked for.
    LayerWindow(PlaneRange coming, PlaneRange wanted, std::uint32_t below, std::uint32_t above, Work work);

    /// The layers of all parts on a plane. From any thread.
    [[nodiscard]] std::function<void()> operator()(std::uint32_t plane, std::span<const Layer> parts);

    /// How many planes have layers here; while nobody brings any.
    [[nodiscard]] std::size_t held() const noexcept { return held_.size(); }

  private:
    using Parts = std::shared_ptr<const std::vector<ScanLayer>>;
    struct Held {
        Parts parts;
        std::uint32_t users; ///< planes that will ask for it still
    };
    /// A plane with all of its neighbours.
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
    void finish(std::uint32_t last);

    PlaneRange coming_;
    PlaneRange wanted_;
    std::uint32_t below_;
    std::uint32_t above_;
    Work work_;
    std::mutex mutex_;
    std::map<std::uint32_t, Held> held_;
    std::map<std::uint32_t, std::uint32_t> missing_; ///< how many neighbours, of planes that have some
    std::map<std::uint32_t, std::function<void()>> ready_;
};

} // namespace lamella
