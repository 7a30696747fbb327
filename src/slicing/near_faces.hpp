#pragma once

// Faces that would lie on a plane if coordinates were not rounded. Rounding decides on which side of the
// plane such faces are.

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

/// Triangles near one plane that are horizontal except for rounding.
struct NearFaces {
    std::uint32_t plane = 0;
    std::uint32_t unused = 0; ///< padding, so that processes send no uninitialised bytes
    std::uint64_t area = 0;   ///< in the unit of the NearFaceFinder
    double farthest_mm = 0;   ///< largest distance of a corner from the plane

    void add(const NearFaces& other) noexcept;
};

/// Finds the triangles whose corners all lie within rounding of a plane, but at least one of them on the side
/// of the plane to which corners exactly on it do not belong (see PlaneRule).
///
/// "Within rounding" means coordinate_rounding, but at most a thousandth of the smallest layer height. Plans
/// ignore the same fraction of a layer at the top of a part.
///
/// Areas are summed as integers, so the sums do not depend on the order of triangles and threads.
class NearFaceFinder {
  public:
    /// `box` is the bounding box of the placed meshes.
    NearFaceFinder(const Plan& plan, const Box3& box);

    /// Returns false if no triangle can be found because all vertices within rounding of a plane snap to it.
    [[nodiscard]] bool any() const noexcept { return reach_mm_ > ranks_.snap_mm(); }

    /// Adds the triangles [begin, end). May be called from any thread. O(end - begin).
    void add(const Mesh& mesh, std::uint64_t begin, std::uint64_t end);
    /// Returns the faces found so far, by ascending plane.
    [[nodiscard]] std::vector<NearFaces> found() const;
    /// Adds faces that other processes found in the same mesh.
    void add(std::span<const NearFaces> others);

    [[nodiscard]] double area_mm2(const NearFaces& faces) const noexcept {
        return static_cast<double>(faces.area) * unit_mm2_;
    }
    /// Returns whether the area is larger than the change of area that rounding of walls along the whole
    /// perimeter of the box can cause.
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

/// Adds all triangles of a mesh, on all threads.
void add_near_faces(NearFaceFinder& finder, const Mesh& mesh, const Execution& execution);

} // namespace lamella
