#pragma once

// Cuts a mesh with single planes, one at a time.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/plane_rule.hpp"
#include "lamella/contour/plane_source.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/slicing/plan.hpp"

#include <memory>

LAMELLA_API_BEGIN
namespace lamella {

/// The section of a mesh with a plane of any direction.
struct PlaneSection {
    /// The contours, in coordinates within the plane whose origin is the given point. The heights are 0.
    /// Seen from the side that the normal points to, material is to the left of the contours.
    Layer layer;
    /// Maps (x, y, 0) of the layer to the coordinates of the mesh.
    Transform to_mesh;

    /// Returns a point of the layer in the coordinates of the mesh.
    [[nodiscard]] Point3 point(const Point2& p) const noexcept { return to_mesh({p.x, p.y, 0}); }
};

/// Cuts one mesh with many single planes, for example while somebody moves a plane through it. The mesh is
/// prepared once; then the cost of a plane depends mainly on the number of triangles that it cuts. Use
/// the function lamella::slice for the layers of a whole part.
///
/// Immutable: any number of threads may use it at once. Cheap to move, and the mesh is shared.
class Slicer {
  public:
    /// Prepares horizontal planes. O(n log n) for n triangles: it links all edges, where lamella::slice links
    /// only those that its planes cut. Takes about 64 bytes for each edge. Throws Error{limit} for about 2^32
    /// / 3 triangles or more, and Error{cancelled}. The preparation uses `execution.threads`.
    explicit Slicer(Mesh mesh, PlaneRule rule = PlaneRule::section_above, const Execution& execution = {});
    ~Slicer();
    Slicer(Slicer&&) noexcept;
    Slicer& operator=(Slicer&&) noexcept;
    Slicer(const Slicer&) = delete;
    Slicer& operator=(const Slicer&) = delete;

    [[nodiscard]] const Mesh& mesh() const noexcept;

    /// Returns the layer at height z: bit for bit the contours that lamella::slice returns for it. Its index
    /// is 0, and its bottom and top are z. A plane that misses the mesh gives a layer without contours.
    /// Throws Error{usage} if z is not finite. O(log n + k log k) for k triangles that the plane cuts,
    /// provided that few other triangles end just below it. Runs on the calling
    /// thread.
    [[nodiscard]] Layer section(double z) const;

    /// Returns the layers of a plan as a source, which cuts each plane when it is needed, and shares the
    /// prepared mesh. PlaneSource::contents is empty. Throws the error of `check` for a plan, and
    /// Error{usage} for another rule than that of the slicer, or a snap distance. O(layers + size of the
    /// mesh), on the calling thread.
    [[nodiscard]] PlaneSource slice(const Plan& plan) const;

    /// Returns the section with the plane through `origin` perpendicular to `normal`, which has any length.
    /// The rule of the plane applies with "above" on the side that the normal points to: the side of each
    /// vertex v is decided exactly, by the sign of (v - origin) . normal for the given numbers, before
    /// anything is rotated or rounded. Under section_above, a plane through a face gives the face if the
    /// material is on the side of the normal, and nothing if it is on the other side. Only the triangles near
    /// the plane are
    /// rotated. The first call prepares the mesh for this in O(n log n), with the number of threads given to
    /// the constructor; it throws Error{cancelled} once `cancel` is requested. Throws Error{usage} unless all
    /// numbers are finite and the normal is not 0. Later calls take O(log n + k log k) for k triangles near
    /// the plane, on the calling thread.
    [[nodiscard]] PlaneSection section(const Point3& origin, const Point3& normal,
                                       const CancelFlag* cancel = nullptr) const;

  private:
    struct Prepared;
    std::shared_ptr<const Prepared> prepared_;
};

} // namespace lamella
LAMELLA_API_END
