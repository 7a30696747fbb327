#pragma once

// Faces that lie on a plane but for rounding: on which side of it they are cut is an accident.

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/slicing/plan.hpp"

#include "slicing/ranks.hpp"

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <vector>

namespace lamella {

/// Triangles that are level but for rounding, near one plane.
struct NearFaces {
    std::uint32_t plane = 0;
    std::uint32_t unused = 0; ///< fills the gap: between processes nothing uninitialised is sent
    std::uint64_t area = 0;   ///< in the units of a NearFaceFinder
    double farthest_mm = 0;   ///< the largest distance of a corner from the plane

    void add(const NearFaces& other) noexcept;
};

/// Finds the triangles whose corners all lie within rounding of a plane, one of them at least on another side
/// of it than a corner on the plane would (Ranks).
///
/// Rounding is that of coordinates (coordinate_rounding), and no more than a thousandth of the lowest layer,
/// which counts as nothing where parts end, too.
///
/// Areas are summed as integers, so that the order of triangles and threads cannot be seen in them.
class NearFaceFinder {
  public:
    /// `box`: of the meshes, as they are placed.
    NearFaceFinder(const Plan& plan, const Box3& box);

    /// False where no triangle can be found: vertices that near a plane count as on it.
    [[nodiscard]] bool any() const noexcept { return reach_mm_ > ranks_.snap_mm(); }

    /// Triangles [begin, end). From any thread. O(end - begin).
    void add(const Mesh& mesh, std::uint64_t begin, std::uint64_t end);
    /// What was found so far, by ascending planes.
    [[nodiscard]] std::vector<NearFaces> found() const;
    /// What other processes found of the same mesh.
    void add(std::span<const NearFaces> others);

    [[nodiscard]] double area_mm2(const NearFaces& faces) const noexcept {
        return static_cast<double>(faces.area) * unit_mm2_;
    }
    /// Whether the area is more than what the rounding of walls all around the box may add or take away.
    [[nodiscard]] bool matters(const NearFaces& faces) const noexcept {
        return area_mm2(faces) > reach_mm_ * perimeter_mm_;
    }

  private:
    class Batch;

    Ranks ranks_;
    double reach_mm_;
    double perimeter_mm_;
    double unit_mm2_;
    mutable std::mutex mutex_;
    std::map<std::uint32_t, NearFaces> found_;
};

/// Adds a whole mesh, on all threads.
void add_near_faces(NearFaceFinder& finder, const Mesh& mesh, const Execution& execution);

} // namespace lamella
