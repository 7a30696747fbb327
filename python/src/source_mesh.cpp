#include "source_mesh.hpp"

#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/jobs/repair_policies.hpp"
#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/slicing/slice.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "classes.hpp"
#include "gil_release.hpp"
#include "input.hpp"
#include "layer_of_arrays.hpp"
#include "placing.hpp"
#include "run.hpp"
#include "texts.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace lamella::python {
namespace {

std::vector<Point3> vertices_of(const Doubles& rows) {
    std::vector<Point3> points(static_cast<std::size_t>(rows.shape(0)));
    const double* x = rows.data();
    for (Point3& p : points) {
        p = {x[0] + 0.0, x[1] + 0.0, x[2] + 0.0};
        x += 3;
    }
    return points;
}

std::vector<std::array<std::uint32_t, 3>> triangles_of(const Numbers& rows, std::size_t vertices) {
    std::vector<std::array<std::uint32_t, 3>> triangles(static_cast<std::size_t>(rows.shape(0)));
    const std::int64_t* number = rows.data();
    for (std::size_t i = 0; i < triangles.size(); ++i)
        for (std::uint32_t& corner : triangles[i]) {
            if (*number < 0 || static_cast<std::uint64_t>(*number) >= vertices)
                throw Error(ErrorKind::input, "faces: row " + std::to_string(i) + " names vertex " +
                                                  std::to_string(*number) + ", and there are " +
                                                  std::to_string(vertices) + ", counted from 0");
            corner = static_cast<std::uint32_t>(*number++);
        }
    return triangles;
}

/// Resets the coordinates of vertices without a face, so that their values are not checked. The vertices are
/// dropped later, so indices do not change here.
void forget_unused(IndexedMesh& mesh) {
    std::vector<bool> used(mesh.vertices.size());
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle)
            used[corner] = true;
    for (std::size_t i = 0; i < used.size(); ++i)
        if (!used[i])
            mesh.vertices[i] = {};
}

/// Makes a mesh of `vertices` (n, 3) and `faces` (m, 3).
MeshPointer mesh_of_arrays(const Doubles& vertices, const Numbers& faces) {
    if (vertices.ndim() != 2 || vertices.shape(1) != 3 || faces.ndim() != 2 || faces.shape(1) != 3)
        throw Error(ErrorKind::input, "vertices and faces must be arrays of the shapes (n, 3) and (m, 3)");
    if (static_cast<std::uint64_t>(vertices.shape(0)) > std::numeric_limits<std::uint32_t>::max())
        throw Error(ErrorKind::limit, "vertices: a mesh has 2^32 - 1 at most");
    const GilRelease released;
    IndexedMesh mesh;
    mesh.vertices = vertices_of(vertices);
    mesh.triangles = triangles_of(faces, mesh.vertices.size());
    forget_unused(mesh);
    check(mesh);
    if (mesh.triangles.empty())
        throw Error(ErrorKind::input, "faces: holds no triangle");
    drop_unused_vertices(mesh); // as for files, so that bounds are those of the faces
    MeshOrigin origin;
    origin.stored_triangles = mesh.triangles.size();
    MeshFile file;
    file.path = "the mesh";
    file.objects.push_back({{}, Mesh(std::move(mesh))});
    file.instances.emplace_back();
    MeshSource source{.file = std::make_shared<const MeshFile>(std::move(file))};
    Mesh placed = joined(source.plate({}));
    return std::make_shared<SourceMesh>(std::move(source), std::move(placed), std::move(origin), Execution{});
}

MeshPointer read_source_mesh(const Input& input, std::optional<double> unit_mm,
                             const MeshReadOptions& options, unsigned threads, const py::object& progress) {
    return result_of(threads, progress, [&](const Execution& execution) {
        MeshFile file =
            input.read_by([&](const auto&... from) { return read_mesh(from..., options, execution); });
        input.label(file);
        return source_mesh(std::move(file), unit_mm, execution);
    });
}

/// Returns whether no sum that the transform computes for a point of the box overflows.
bool stays_finite(const Transform& map, const Box3& box) {
    const std::array largest{std::max(std::abs(box.min.x), std::abs(box.max.x)),
                             std::max(std::abs(box.min.y), std::abs(box.max.y)),
                             std::max(std::abs(box.min.z), std::abs(box.max.z))};
    for (std::size_t r = 0; r < 3; ++r) {
        double sum = std::abs(map.offset[r]);
        for (std::size_t c = 0; c < 3; ++c)
            sum += std::abs(map.linear[r][c]) * largest[c];
        if (!std::isfinite(sum))
            return false;
    }
    return true;
}

/// Returns the transformed mesh. `argument` is the name of the argument with the transform.
MeshPointer transformed(const SourceMesh& source, const Transform& map, const char* argument,
                        unsigned threads) {
    MeshOrigin origin = source.origin();
    origin.matrix = compose(map, origin.matrix);
    MeshSource moved = source.source();
    moved.placement = compose(map, moved.placement);
    return result_of(threads, py::none(), [&](const Execution& execution) {
        if (finite(map) && finite(origin.matrix) && stays_finite(map, source.box())) {
            Mesh mesh = joined(moved.plate(execution), execution);
            return std::make_shared<SourceMesh>(std::move(moved), std::move(mesh), std::move(origin),
                                                execution);
        }
        throw Error(ErrorKind::usage,
                    std::string(argument) + ": puts the mesh where its coordinates are no finite numbers");
    });
}

MeshPointer mended_mesh(const SourceMesh& source, const Mending& mending, unsigned threads,
                        const py::object& progress) {
    return result_of(threads, progress, [&](const Execution& execution) {
        MeshOrigin origin = source.origin();
        RepairedFile whole = repaired(*source.source().file, source.source().unit_mm,
                                      source.source().placement, policies_of(mending), execution);
        for (const MeshRepairs& found : whole.repairs)
            add(origin.repairs, found);
        MeshSource made{.file = std::make_shared<const MeshFile>(std::move(whole.file))};
        const Plate plate = made.plate(execution);
        origin.stored_triangles = made.file->stored_triangles;
        return std::make_shared<SourceMesh>(std::move(made), joined(plate, execution), std::move(origin),
                                            execution);
    });
}

/// Adds the figures and counts of an inspection.
void add_counts(py::dict& fields, const Inspection& found) {
    fields["vertices"] = found.vertices;
    fields["volume"] = found.volume_mm3;
    fields["area"] = found.area_mm2;
    fields["closed"] = found.closed();
    fields["sound"] = found.sound();
    fields["shells"] = found.shells;
    fields["cavities"] = found.cavities;
    for (const DefectKind& kind : defect_kinds)
        fields[py::str(kind.words.key)] = found.*kind.count;
}

/// Returns the defects in words, such as "2 boundary edges, 1 inverted shell"; "" for a sound mesh.
std::string defects_of(const SourceMesh& source, unsigned threads, const py::object& progress) {
    const Inspection found = result_of(threads, progress, [&](const Execution& execution) {
        return inspect(source.welded(execution), execution);
    });
    return found.sound() ? std::string() : describe_defects(found);
}

/// Returns a copy of a list of points, or of tuples of points, as an array of this shape.
template <class Item>
py::array_t<double> points_array(const std::vector<Item>& items, std::vector<py::ssize_t> shape) {
    shape.insert(shape.begin(), static_cast<py::ssize_t>(items.size()));
    return py::array_t<double>(shape, reinterpret_cast<const double*>(items.data()));
}

py::dict diagnosed(const SourceMesh& source, bool self_intersections, std::size_t keep, unsigned threads,
                   const py::object& progress) {
    static_assert(sizeof(EdgeLocation) == 6 * sizeof(double) && sizeof(Box3) == sizeof(EdgeLocation));
    const Diagnosis found = result_of(threads, progress, [&](const Execution& execution) {
        return diagnose(source.welded(execution), {.keep = keep, .self_intersections = self_intersections},
                        execution);
    });
    py::dict fields;
    fields["triangles"] = source.origin().stored_triangles;
    add_counts(fields, found.counts);
    py::list loops;
    for (const BoundaryLoop& loop : found.loops)
        loops.append(points_array(loop.points, {3}));
    py::dict places;
    places["boundary_loops"] = loops;
    places["nonmanifold_edges"] = points_array(found.nonmanifold_edges, {2, 3});
    places["orientation_conflicts"] = points_array(found.conflicting_edges, {2, 3});
    places["nonmanifold_vertices"] = points_array(found.vertices, {3});
    std::vector<Box3> inverted;
    for (const Shell& shell : found.shells)
        if (shell.kind == ShellKind::inverted)
            inverted.push_back(shell.box);
    places["inverted_shells"] = points_array(inverted, {2, 3});
    places["duplicate_triangles"] = found.duplicate_triangles;
    places["degenerate_triangles"] = found.degenerate_triangles;
    fields["places"] = places;
    fields["self_intersections"] = py::none();
    if (const auto& met = found.self_intersections) {
        py::list first;
        for (const TriangleIntersection& one : met->first)
            first.append(py::make_tuple(words_of(one.kind).key, std::pair(one.triangle_a, one.triangle_b),
                                        std::tuple(one.at.x, one.at.y, one.at.z)));
        fields["self_intersections"] =
            py::make_tuple(met->crossing, met->overlapping, met->touching, met->flat_triangles, first);
    }
    return fields;
}

py::str mesh_text(const SourceMesh& source) {
    const Box3& box = source.box();
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(), "<lamella.Mesh of %zu triangles, %.6g x %.6g x %.6g mm",
                  source.mesh().size(), box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z);
    const std::string& path = source.origin().path;
    return py::str("{}{}{}>").format(text.data(), path.empty() ? "" : ", from ", path_text(path));
}

const IndexedMesh& welded_of(const SourceMesh& source) {
    const GilRelease released;
    return source.welded({});
}

py::tuple mesh_state(const py::object& self) {
    if (self.cast<const SourceMesh&>().source().has_negatives())
        throw Error(ErrorKind::usage, "a mesh with negative volumes cannot be pickled; read its file anew");
    const MeshOrigin& origin = self.cast<const SourceMesh&>().origin();
    return py::make_tuple(self.attr("vertices"), self.attr("faces"), py::bytes(origin.path), origin.format,
                          origin.name, origin.label, origin.unit_mm, origin.stored_triangles, origin.warnings,
                          origin.repairs, matrix_of(origin.matrix));
}

MeshPointer mesh_of_state(const py::tuple& state) {
    const MeshPointer mesh = mesh_of_arrays(state[0].cast<Doubles>(), state[1].cast<Numbers>());
    MeshOrigin origin{.path = state[2].cast<std::string>(),
                      .format = state[3].cast<std::string>(),
                      .name = state[4].cast<std::string>(),
                      .label = state[5].cast<std::string>(),
                      .unit_mm = state[6].cast<double>(),
                      .stored_triangles = state[7].cast<std::uint64_t>(),
                      .warnings = state[8].cast<std::vector<std::string>>(),
                      .repairs = state[9].cast<Repairs>(),
                      .matrix = transform_of(state[10].cast<Matrix>())};
    if (!finite(origin.matrix) || !std::isfinite(origin.unit_mm))
        throw Error(ErrorKind::input, "the matrix and the unit of a pickled mesh must be finite");
    return std::make_shared<SourceMesh>(mesh->source(), mesh->mesh(), std::move(origin), Execution{});
}

} // namespace

Plate MeshSource::plate(const Execution& execution) const {
    return load_plate({.path = file->path, .unit_mm = unit_mm, .placement = placement}, *file, execution);
}

bool MeshSource::has_negatives() const {
    return std::any_of(file->instances.begin(), file->instances.end(),
                       [](const MeshInstance& instance) { return instance.negative; });
}

SourceMesh::SourceMesh(MeshSource source, Mesh mesh, MeshOrigin origin, const Execution& execution)
    : source_(std::move(source)), mesh_(std::move(mesh)), origin_(std::move(origin)),
      box_(bounding_box(mesh_, execution)) {}

const IndexedMesh& SourceMesh::welded(const Execution& execution) const {
    std::call_once(welded_once_, [&] {
        welded_ = mesh_.indexed() != nullptr ? mesh_.with_joined_vertices(execution) : weld(mesh_, execution);
    });
    return *welded_.indexed();
}

Plate SourceMesh::plate() const {
    Plate plate;
    PlateFile& file = plate.files.emplace_back();
    file.path = origin_.path.empty() ? "the mesh" : origin_.path;
    file.warnings = origin_.warnings;
    plate.shapes.push_back({mesh_});
    plate.parts.push_back({.label = origin_.label, .box = box_});
    plate.box = box_;
    return plate;
}

MeshPointer source_mesh(MeshFile file, std::optional<double> unit_mm, const Execution& execution) {
    MeshOrigin origin;
    origin.path = file.path;
    origin.format = file.format;
    origin.name = file.name;
    origin.stored_triangles = file.stored_triangles;
    MeshSource source{.file = std::make_shared<const MeshFile>(std::move(file)), .unit_mm = unit_mm};
    const Plate plate = source.plate(execution);
    origin.warnings = plate.files.front().warnings;
    origin.unit_mm = plate.files.front().unit_mm;
    if (plate.parts.size() == 1)
        origin.label = plate.parts.front().label;
    return std::make_shared<SourceMesh>(std::move(source), joined(plate, execution), std::move(origin),
                                        execution);
}

void bind_meshes(py::module_& module) {
    py::class_<SourceMesh, MeshPointer> cls(
        module, "Mesh",
        "A triangle mesh in millimetres. It never changes.\n\n"
        "Made by lamella.read from a file, or from arrays: Mesh(vertices, faces) with vertices (n, 3), in\n"
        "millimetres, and faces (m, 3), three numbers of vertices each, counter-clockwise seen from "
        "outside.\n"
        "Vertices that no face has are left out. Wherever a function takes a mesh, arrays and paths will do, "
        "too.",
        own_new());
    cls.def(py::init(&mesh_of_arrays))
        .def_property_readonly(
            "vertices",
            [](const py::object& self) {
                const IndexedMesh& mesh = welded_of(self.cast<const SourceMesh&>());
                return view(&mesh.vertices.data()->x, {py::ssize_t(mesh.vertices.size()), 3}, self);
            },
            "The vertices in millimetres, equal ones joined: (n, 3) float64, read-only, without a copy.")
        .def_property_readonly(
            "faces",
            [](const py::object& self) {
                const IndexedMesh& mesh = welded_of(self.cast<const SourceMesh&>());
                return view(mesh.triangles.data()->data(), {py::ssize_t(mesh.triangles.size()), 3}, self);
            },
            "The triangles as rows of `vertices`, counter-clockwise seen from outside: (m, 3) uint32,\n"
            "read-only, without a copy.")
        .def_property_readonly(
            "bounds", [](const SourceMesh& self) { return bounds_of(self.box()); },
            "The smallest and the largest x, y and z in millimetres: (2, 3) float64.")
        .def_property_readonly(
            "volume",
            [](const SourceMesh& self) {
                const GilRelease released;
                return volume(self.mesh());
            },
            "The volume in cubic millimetres: meaningful for a closed mesh, negative if it is inside out.")
        .def_property_readonly(
            "matrix", [](const SourceMesh& self) { return matrix_of(self.origin().matrix); },
            "Its transform since it was read or made: a (4, 4) matrix.")
        .def_property_readonly(
            "path", [](const SourceMesh& self) { return path_text(self.origin().path); },
            "The file it was read from; empty for a mesh made of arrays.")
        .def_property_readonly(
            "format", [](const SourceMesh& self) { return self.origin().format; },
            "The format of that file, such as \"stl-binary\"; empty for a mesh made of arrays.")
        .def_property_readonly(
            "name", [](const SourceMesh& self) { return self.origin().name; },
            "What the file calls it; empty where it does not.")
        .def_property_readonly(
            "unit_mm", [](const SourceMesh& self) { return self.origin().unit_mm; },
            "How many millimetres a unit of the file was taken for.")
        .def_property_readonly(
            "warnings", [](const SourceMesh& self) { return message_texts(self.origin().warnings); },
            "What was odd about the file, and what was made of it: a line each.")
        .def_property_readonly(
            "repairs", [](const SourceMesh& self) { return self.origin().repairs; },
            "Counts of what `mend` changed, as Stack.repairs; empty for a mesh that was not mended.")
        .def("_defects", &defects_of)
        .def("_mended", &mended_mesh)
        .def("_diagnosed", &diagnosed)
        .def("_transformed",
             [](const SourceMesh& self, const Matrix& rows, unsigned threads) {
                 return transformed(self, transform_of(rows), "transform", threads);
             })
        .def("_rotated",
             [](const SourceMesh& self, const std::array<double, 3>& d, unsigned threads) {
                 return transformed(self, upright({d[0], d[1], d[2]}), "direction", threads);
             })
        .def("__len__", [](const SourceMesh& self) { return self.mesh().size(); })
        .def("__repr__", &mesh_text);
    bind_pickle(cls, "mesh", 11, &mesh_state, &mesh_of_state);
    complete(cls, "_methods");

    module.def("defect_kinds", [] {
        std::vector<std::array<std::string_view, 3>> kinds;
        for (const DefectKind& kind : defect_kinds)
            kinds.push_back({kind.words.key, kind.words.one, kind.words.many});
        return kinds;
    });
    module.def("read_mesh", [](const py::object& source, std::optional<double> unit_mm, bool strict,
                               const std::string& include, std::uint64_t max_triangles,
                               std::uint64_t max_memory, unsigned threads, const py::object& progress) {
        return read_source_mesh(Input(source), unit_mm,
                                {strict, roles_named(include), max_triangles, max_memory}, threads, progress);
    });
}

} // namespace lamella::python
