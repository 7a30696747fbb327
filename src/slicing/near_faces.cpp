#include "slicing/near_faces.hpp"

#include "core/executor.hpp"
#include "mesh/coordinate_rounding.hpp"
#include "slicing/stacking.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <span>

namespace lamella {
namespace {

double reach_of(const Plan& plan, const Box3& box) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const PlannedLayer& layer : plan.layers)
        lowest = std::min(lowest, layer.top - layer.bottom);
    return std::min(coordinate_rounding(box), negligible * lowest);
}

} // namespace

void NearFaces::add(const NearFaces& other) noexcept {
    area += other.area;
    farthest_mm = std::max(farthest_mm, other.farthest_mm);
}

/// Sums the faces that one thread finds. Most neighbours in a file belong to the same face, so the finder is
/// locked only when the plane changes.
class NearFaceFinder::Batch {
  public:
    explicit Batch(NearFaceFinder& finder)
        : finder_(finder), ranks_(finder.ranks_), reach_(finder.reach_mm_) {}
    Batch(const Batch&) = delete;
    Batch& operator=(const Batch&) = delete;
    ~Batch() { put_down(); }

    /// Returns whether a triangle between these heights may be near a plane.
    [[nodiscard]] bool may_be(double low, double high) {
        if (!(high - low <= 2 * reach_))
            return false;
        // The candidate is the uppermost plane below the highest corner or, under section_below, the lowest
        // plane above the lowest corner.
        const bool above = ranks_.rule() == PlaneRule::section_above;
        const double wrong = above ? high : low;
        if (wrong != last_) {
            last_ = wrong;
            const std::uint32_t rank = ranks_(wrong);
            plane_ = above ? rank - 1 : rank; // too large a number if there is no such plane
        }
        return plane_ < ranks_.count() && std::abs(high - ranks_.z(plane_)) <= reach_ &&
               std::abs(low - ranks_.z(plane_)) <= reach_;
    }

    /// Adds a triangle for which `may_be` returned true.
    void add(const Triangle3& t, double low, double high) {
        const auto [ux, uy] = std::array{t[1].x - t[0].x, t[1].y - t[0].y};
        const auto [vx, vy] = std::array{t[2].x - t[0].x, t[2].y - t[0].y};
        const double twice = std::abs(ux * vy - uy * vx);
        const double longest = std::sqrt(
            std::max({ux * ux + uy * uy, vx * vx + vy * vy, (vx - ux) * (vx - ux) + (vy - uy) * (vy - uy)}));
        // A steep triangle is not part of a horizontal face. It is near the plane because it is small.
        constexpr double steepest = 0.01;
        if (!(twice > 0 && (high - low) * longest <= steepest * twice))
            return;
        if (plane_ != now_.plane)
            put_down();
        now_.plane = plane_;
        now_.add(
            {.area = static_cast<std::uint64_t>(twice / 2 / finder_.unit_mm2_),
             .farthest_mm = std::max(std::abs(high - ranks_.z(plane_)), std::abs(low - ranks_.z(plane_)))});
    }

  private:
    void put_down() {
        if (now_.area > 0)
            finder_.add(std::span(&now_, 1));
        now_ = {};
    }

    NearFaceFinder& finder_;
    const Ranks& ranks_;
    double reach_;
    double last_ = std::numeric_limits<double>::quiet_NaN();
    std::uint32_t plane_ = 0; ///< the plane that belongs to `last_`
    NearFaces now_;
};

NearFaceFinder::NearFaceFinder(const Plan& plan, const Box3& box)
    : ranks_(plan), reach_mm_(reach_of(plan, box)),
      perimeter_mm_(2 * (box.max.x - box.min.x) + 2 * (box.max.y - box.min.y)),
      unit_mm2_(0x1p-40 * (box.max.x - box.min.x) * (box.max.y - box.min.y)) {}

void NearFaceFinder::add(const Mesh& mesh, std::uint64_t begin, std::uint64_t end) {
    Batch batch(*this);
    const auto add = [&](std::uint64_t i, const std::array<double, 3>& z) {
        const double low = std::min({z[0], z[1], z[2]});
        const double high = std::max({z[0], z[1], z[2]});
        if (batch.may_be(low, high))
            batch.add(mesh.triangle(i), low, high);
    };
    if (const TriangleSoup* const soup = mesh.soup(); soup != nullptr && !soup->has_placement()) {
        for (std::uint64_t i = begin; i < end; ++i) {
            const std::byte* const triangle = soup->data() + i * soup->stride();
            std::array<float, 3> z;
            for (std::size_t k = 0; k < 3; ++k)
                std::memcpy(&z[k], triangle + 12 * k + 8, sizeof z[k]);
            add(i, {z[0], z[1], z[2]});
        }
    } else {
        for (std::uint64_t i = begin; i < end; ++i) {
            const Triangle3 t = mesh.triangle(i);
            add(i, {t[0].z, t[1].z, t[2].z});
        }
    }
}

void NearFaceFinder::add(std::span<const NearFaces> others) {
    const std::lock_guard lock(mutex_);
    for (const NearFaces& faces : others) {
        NearFaces& all = found_[faces.plane];
        all.plane = faces.plane;
        all.add(faces);
    }
}

std::vector<NearFaces> NearFaceFinder::found() const {
    const std::lock_guard lock(mutex_);
    std::vector<NearFaces> all;
    for (const auto& [plane, faces] : found_)
        all.push_back(faces);
    return all;
}

void add_near_faces(NearFaceFinder& finder, const Mesh& mesh, const Execution& execution) {
    if (!finder.any())
        return;
    Executor executor(execution);
    constexpr std::uint64_t chunk = std::uint64_t{1} << 15;
    executor.for_chunks(mesh.size(), chunk, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
        finder.add(mesh, begin, end);
    });
    executor.check_cancelled();
}

} // namespace lamella
