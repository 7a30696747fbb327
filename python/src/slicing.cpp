#include "slicing.hpp"

#include "lamella/contour/open_gaps.hpp"
#include "lamella/pipeline/layer_warnings.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/slicing/layering.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include "arrays.hpp"
#include "gil_release.hpp"
#include "layer_stream.hpp"
#include "layers.hpp"
#include "pickled.hpp"
#include "placing.hpp"
#include "run.hpp"
#include "shared_layer.hpp"
#include "source_mesh.hpp"

#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace lamella::python {
namespace {

using ZRange = std::optional<std::pair<double, double>>;
using IndexRange = std::optional<std::pair<std::uint64_t, std::uint64_t>>;

/// Returns the plan that slice_file would use for the layering of a job.
CutPlan plan_for(const MeshPointer& mesh, const Cut& cut, const std::string& at, const ZRange& z_range,
                 const IndexRange& layers, double snap_mm, std::uint64_t max_memory, unsigned threads,
                 const py::object& progress) {
    FileJob job;
    job.max_memory = max_memory;
    job.layering = {.cut = cut,
                    .at = slice_at_named(at),
                    .only = {.z_range = z_range, .index_range = layers},
                    .snap_mm = snap_mm};
    Plan plan = result_of(threads, progress,
                          [&](const Execution& execution) { return plan_of(job, mesh->plate(), execution); });
    return {std::move(plan), std::move(job.layering)};
}

/// Returns the number of layers of the whole plan, but at most one more than the index after the last of
/// these layers, which shows whether there are layers above them.
std::uint64_t planned(const CutPlan& cuts, const SourceMesh& mesh, const Execution& execution) {
    const std::uint64_t end = cuts.plan.layers.back().index + 1;
    const PlaneSelection& only = cuts.layering.only;
    return only.z_range || only.index_range
               ? cuts.only(cuts.plan.layers.front().index, end + 1, mesh, execution).layers.back().index + 1
               : end;
}

std::shared_ptr<Stack> slice_stack(const MeshPointer& mesh, const CutPlan& cuts, const std::string& with,
                                   unsigned threads, const py::object& progress) {
    const Engine& chosen = engine(with);
    auto stack = std::make_shared<Stack>();
    run(threads, progress, [&](const Execution& execution) {
        stack->layers = mesh->source().has_negatives()
                            ? shared(slice(mesh->source().plate(execution), cuts.plan,
                                           {.execution = execution, .engine = chosen}),
                                     cuts.plan.rule)
                            : sliced(mesh->mesh(), cuts.plan, execution, chosen);
        stack->planned = planned(cuts, *mesh, execution);
    });
    stack->rule = cuts.plan.rule;
    stack->label = mesh->origin().label;
    stack->box = mesh->box();
    stack->of_mesh = true;
    stack->matrix = mesh->origin().matrix;
    return stack;
}

/// Returns the defects of the mesh that show in its layers.
std::vector<std::string> doubts_of(const Stack& stack) {
    return result_of(0, py::none(), [&](const Execution& execution) {
        const LayerStack layers = plain(stack.layers);
        return layer_doubts({&layers, 1}, {}, InversionSearch::quick, execution).texts();
    });
}

/// Returns a warning if rounding decides the content of layers; else "".
std::string near_faces_of(const MeshPointer& mesh, const CutPlan& cuts, unsigned threads,
                          const py::object& progress) {
    const NearFaceLayers found = result_of(threads, progress, [&](const Execution& execution) {
        return near_faces(mesh->mesh(), cuts.plan, execution);
    });
    return found.text(cuts.plan.layers.size());
}

void bind_cuts(py::module_& module) {
    py::class_<UniformLayers>(module, "UniformLayers")
        .def(py::init([](double layer_height, std::optional<double> first_layer_height) {
            return UniformLayers{layer_height, first_layer_height};
        }));
    py::class_<ListedPlanes>(module, "ListedPlanes").def(py::init([](std::vector<double> z) {
        return ListedPlanes{.z = std::move(z)};
    }));
    using Ranges = std::vector<std::tuple<double, double, double>>;
    py::class_<HeightRanges>(module, "HeightRanges").def(py::init([](const Ranges& ranges, double elsewhere) {
        HeightRanges heights{.ranges = {}, .layer_height = elsewhere};
        for (const auto& [from, to, height] : ranges)
            heights.ranges.push_back({from, to, height});
        return heights;
    }));
    py::class_<AdaptiveLayers>(module, "AdaptiveLayers")
        .def(py::init([](double min_height, double max_height, double cusp_mm) {
            return AdaptiveLayers{min_height, max_height, cusp_mm};
        }));
}

/// Returns the stream of an object; null if the object is not constructed, as objects of Python classes with
/// several bases never are.
LayerStream* stream_of(PyObject* self) {
    auto* const instance = reinterpret_cast<py::detail::instance*>(self);
    if (!instance->simple_layout || !instance->simple_holder_constructed)
        return nullptr;
    return instance->get_value_and_holder().value_ptr<LayerStream>();
}

/// Lets the garbage collector traverse streams. A listener and its stream may refer to each other, and only
/// the garbage collector can find that such a cycle is unreachable.
void collect_streams(PyHeapTypeObject* heap_type) {
    PyTypeObject& type = heap_type->ht_type;
    type.tp_flags |= Py_TPFLAGS_HAVE_GC;
    type.tp_traverse = [](PyObject* self, visitproc visit, void* arg) {
        Py_VISIT(Py_TYPE(self));
        if (const LayerStream* const stream = stream_of(self))
            Py_VISIT(stream->listener().ptr());
        return 0;
    };
    type.tp_clear = [](PyObject* self) {
        if (LayerStream* const stream = stream_of(self))
            stream->forget_listener();
        return 0;
    };
    // Other threads run while the stream stops. A garbage collection in one of them must not find the partly
    // destroyed object, which pybind11 2.10 does not untrack.
    type.tp_dealloc = [](PyObject* self) {
        PyObject_GC_UnTrack(self);
        py::detail::pybind11_object_dealloc(self);
    };
}

void bind_stream(py::module_& module) {
    py::class_<LayerStream>(
        module, "LayerStream",
        "Layers while they are being made, in ascending z: an iterator. Few of them are in memory at\n"
        "a time. It may be closed before its end, and closes itself when nobody holds it any more.",
        py::custom_type_setup([](PyHeapTypeObject* heap_type) {
            own_new().value(heap_type);
            collect_streams(heap_type);
        }))
        .def_property_readonly(
            "z",
            [](const LayerStream& self) {
                return array_of<double>(self.plan().layers,
                                        [](const PlannedLayer& layer) { return layer.z; });
            },
            "Where layers are cut, those already taken included, in millimetres: (layers,) float64.")
        .def_property_readonly(
            "bounds", [](const LayerStream& self) { return bounds_of(self.mesh().box()); },
            "The smallest and the largest x, y and z of the mesh in millimetres: (2, 3) float64.")
        .def_property_readonly(
            "label", [](const LayerStream& self) { return path_text(self.mesh().origin().label); },
            "What the part is called in slice files.")
        .def_property_readonly(
            "rule", [](const LayerStream& self) { return plane_rule_name(self.plan().rule); },
            "The rule of the plane, as Stack.rule.")
        .def_property_readonly("_bottom", &LayerStream::bottom)
        .def("_beside", &LayerStream::beside)
        .def("_close", &LayerStream::close)
        .def("__length_hint__", &LayerStream::left)
        .def("__iter__", [](const py::object& self) { return self; })
        .def("__next__", &LayerStream::next)
        .def("__enter__", [](const py::object& self) { return self; })
        .def("__exit__", [](LayerStream& self, const py::args&) { self.close(); })
        .def("__repr__", [](const LayerStream& self) {
            return "<lamella.LayerStream: " + std::to_string(self.left()) + " of " +
                   std::to_string(self.plan().layers.size()) + " layers left>";
        });
    module.def("stream", [](const MeshPointer& mesh, const CutPlan& cuts, const std::string& with,
                            unsigned threads, const py::object& progress) {
        return std::make_unique<LayerStream>(mesh, cuts, engine(with), threads, progress);
    });
}

} // namespace

void bind_slicing(py::module_& module) {
    py::class_<CutPlan>(module, "Plan").def("__len__", [](const CutPlan& self) {
        return self.plan.layers.size();
    });
    bind_cuts(module);
    module.def("plan", &plan_for);
    module.def("slice_stack", &slice_stack);
    module.def("mesh_doubts", &doubts_of);
    module.def("near_faces", &near_faces_of);
    bind_stream(module);
    module.def("engines", [] {
        std::vector<std::tuple<std::string, std::string, std::string>> found;
        for (const Engine& engine : engines())
            found.emplace_back(engine.name, engine.summary, engine.source);
        return found;
    });
}

} // namespace lamella::python
