#include "lamella/core/error.hpp"
#include "lamella/slicing/slicer.hpp"

#include "bindings.hpp"
#include "gil_release.hpp"
#include "placing.hpp"
#include "run.hpp"
#include "shared_layer.hpp"
#include "source_mesh.hpp"

#include <pybind11/stl.h>

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <utility>

namespace py = pybind11;

namespace lamella::python {
namespace {

/// A mesh that is prepared for single planes.
class PreparedMesh {
  public:
    PreparedMesh(const MeshPointer& mesh, const std::string& rule, unsigned threads,
                 const py::object& progress)
        : rule_(rule_named(rule)), slicer_(result_of(threads, progress, [&](const Execution& execution) {
              if (mesh->source().has_negatives())
                  throw Error(ErrorKind::usage, "part: its negative volumes cannot be subtracted from single "
                                                "sections; slice() subtracts them");
              return Slicer(mesh->mesh(), rule_, execution);
          })) {}

    [[nodiscard]] LayerPointer level(double z) const {
        const GilRelease released;
        return std::make_shared<SharedLayer>(slicer_.section(z), rule_);
    }

    [[nodiscard]] std::pair<LayerPointer, Transform> tilted(const std::array<double, 3>& origin,
                                                            const std::array<double, 3>& normal) const {
        const Point3 through{origin[0], origin[1], origin[2]};
        const Point3 along{normal[0], normal[1], normal[2]};
        // The first section takes long, because it prepares the mesh.
        PlaneSection section = is_prepared_ ? prepared_section(through, along)
                                            : result_of(1, py::none(), [&](const Execution& execution) {
                                                  return slicer_.section(through, along, execution.cancel);
                                              });
        is_prepared_ = true;
        return {std::make_shared<SharedLayer>(std::move(section.layer), rule_), section.to_mesh};
    }

  private:
    [[nodiscard]] PlaneSection prepared_section(const Point3& through, const Point3& along) const {
        const GilRelease released;
        return slicer_.section(through, along);
    }

    PlaneRule rule_;
    Slicer slicer_;
    mutable std::atomic<bool> is_prepared_ = false; ///< for planes of any direction
};

} // namespace

void bind_sections(py::module_& module) {
    py::class_<PreparedMesh, std::shared_ptr<PreparedMesh>>(module, "PreparedMesh")
        .def(py::init<const MeshPointer&, const std::string&, unsigned, const py::object&>())
        .def("level", &PreparedMesh::level)
        .def("tilted", [](const PreparedMesh& self, const std::array<double, 3>& origin,
                          const std::array<double, 3>& normal) {
            const auto [layer, map] = self.tilted(origin, normal);
            return py::make_tuple(layer, matrix_of(map));
        });
}

} // namespace lamella::python
