#include "source_plate.hpp"

#include "lamella/core/error.hpp"
#include "lamella/meshes/mesh_file.hpp"

#include "bindings.hpp"
#include "placing.hpp"
#include "run.hpp"
#include "texts.hpp"

#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>

namespace py = pybind11;

namespace lamella::python {
namespace {

/// Scale factors, degrees about x, y and z, and a translation.
using Pose = std::array<std::array<double, 3>, 3>;

/// A lamella.Part: mesh, pose, matrix, copies, spacing, label, whether it is a support, and whether it is
/// negative.
using Part = std::tuple<MeshPointer, Pose, Matrix, std::uint64_t, double, std::string, bool, bool>;

/// Returns the placement of a part, composed as that of an input of the program.
Transform placement_of(const Part& part) {
    const auto& [scale, degrees, position] = std::get<Pose>(part);
    Transform map =
        compose(scaling(scale[0], scale[1], scale[2]), transform_of(std::get<Matrix>(part), "matrix"));
    for (std::size_t axis = 0; axis < 3; ++axis)
        map = compose(rotation("xyz"[axis], degrees[axis]), map);
    return compose(translation(position[0], position[1], position[2]), map);
}

/// Returns the plate of a mesh, of which all parts are one.
PlatePointer plate_of_mesh(const MeshPointer& mesh, const Mending& mending, unsigned threads,
                           const py::object& progress) {
    const RepairPolicies policies = policies_of(mending);
    return result_of(threads, progress, [&](const Execution& execution) {
        auto plate = std::make_shared<SourcePlate>();
        plate->label = mesh->origin().label;
        plate->matrix = mesh->origin().matrix;
        const bool together = !mesh->source().has_negatives();
        plate->placed = together ? mesh->plate() : mesh->source().plate(execution);
        plate->mended = plate->placed;
        if (!policies.change_the_mesh())
            return plate;
        Plate bodies = mended(mesh->source().plate(execution), policies, plate->repairs, execution);
        if (together)
            plate->mended.shapes.front().mesh = joined(bodies, execution);
        else
            plate->mended = std::move(bodies);
        return plate;
    });
}

/// Returns the transforms of the parts. Copies of an input differ by an offset.
std::vector<Transform> matrices_of(const Plate& plate, const std::vector<PlateInput>& inputs,
                                   const std::vector<Transform>& of_inputs) {
    std::vector<std::vector<std::size_t>> parts(inputs.size());
    std::vector<Transform> matrices;
    for (std::size_t i = 0; i < plate.parts.size(); ++i) {
        const std::size_t input = plate.shapes[plate.parts[i].shape].input;
        parts[input].push_back(i);
        matrices.push_back(of_inputs[input]);
    }
    for (std::size_t input = 0; input < inputs.size(); ++input) {
        const std::size_t of_copy = parts[input].size() / inputs[input].copies;
        for (std::size_t k = of_copy; k < parts[input].size(); ++k) {
            const Point3& first = plate.parts[parts[input][k % of_copy]].box.min;
            const Point3& moved = plate.parts[parts[input][k]].box.min;
            Transform& matrix = matrices[parts[input][k]];
            matrix = compose(translation(moved.x - first.x, moved.y - first.y, 0), matrix);
        }
    }
    return matrices;
}

/// Returns the plate of several parts; `rows` and `direction` place the whole plate.
PlatePointer plate_of_parts(const std::vector<Part>& parts, const std::optional<Matrix>& rows,
                            const std::optional<std::array<double, 3>>& direction, const Mending& mending,
                            std::uint64_t max_memory, unsigned threads, const py::object& progress) {
    Transform whole = rows ? transform_of(*rows) : Transform{};
    if (direction)
        whole = compose(upright({(*direction)[0], (*direction)[1], (*direction)[2]}), whole);
    std::vector<PlateInput> inputs;
    std::vector<MeshFile> files;
    std::vector<Transform> of_inputs;
    for (const Part& part : parts) {
        const SourceMesh& mesh = *std::get<MeshPointer>(part);
        const std::string& path = mesh.origin().path;
        const std::string& label = std::get<std::string>(part);
        const Transform placement = compose(whole, placement_of(part));
        inputs.push_back({.path = path.empty() ? "part \"" + label + "\"" : path,
                          .unit_mm = mesh.source().unit_mm,
                          .placement = compose(placement, mesh.source().placement),
                          .copies = std::get<std::uint64_t>(part),
                          .spacing_mm = std::get<double>(part),
                          .label = label,
                          .support = std::get<6>(part),
                          .negative = std::get<7>(part)});
        files.push_back(*mesh.source().file);
        of_inputs.push_back(compose(placement, mesh.origin().matrix));
        if (!finite(inputs.back().placement))
            throw Error(ErrorKind::usage,
                        inputs.back().path + ": is put where its coordinates are no finite numbers");
    }
    return result_of(threads, progress, [&](const Execution& execution) {
        auto plate = std::make_shared<SourcePlate>();
        plate->apart = true;
        plate->matrix = whole;
        plate->placed = load_plate(inputs, std::move(files), execution, max_memory);
        plate->matrices = matrices_of(plate->placed, inputs, of_inputs);
        plate->mended = plate->placed;
        if (const RepairPolicies policies = policies_of(mending); policies.change_the_mesh())
            plate->mended = mended(plate->placed, policies, plate->repairs, execution);
        if (!plate->several()) {
            plate->label = plate->placed.parts.front().label;
            plate->matrix = plate->matrices.front();
        }
        return plate;
    });
}

} // namespace

void bind_plates(py::module_& module) {
    py::class_<SourcePlate, PlatePointer>(module, "Plate")
        .def_property_readonly("bottom", [](const SourcePlate& self) { return self.placed.box.min.z; })
        .def_property_readonly("bounds", [](const SourcePlate& self) { return bounds_of(self.placed.box); })
        .def_property_readonly("labels",
                               [](const SourcePlate& self) {
                                   std::vector<py::str> labels;
                                   for (const PlatePart& part : self.placed.parts)
                                       labels.push_back(path_text(part.label));
                                   return labels;
                               })
        .def_property_readonly("names", [](const SourcePlate& self) {
            std::vector<py::str> names;
            for (const PlateFile& file : self.placed.files)
                names.push_back(path_text(file.path));
            return names;
        });
    module.def("plate_of_mesh", &plate_of_mesh);
    module.def("plate_of_parts", &plate_of_parts);
}

} // namespace lamella::python
