#include "lamella/contour/open_gaps.hpp"
#include "lamella/core/error.hpp"
#include "lamella/jobs/layer_findings.hpp"
#include "lamella/jobs/slice_file.hpp"
#include "lamella/slicing/layering.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "classes.hpp"
#include "gil_release.hpp"
#include "layer_stream.hpp"
#include "placing.hpp"
#include "run.hpp"
#include "shared_layer.hpp"
#include "source_plate.hpp"
#include "texts.hpp"

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
CutPlan plan_for(const PlatePointer& plate, const Cut& cut, const std::string& at, const ZRange& z_range,
                 const IndexRange& layers, double snap_mm, std::optional<double> close_gaps_mm,
                 const std::string& fill, const InsetAndHeight& bottom_offset, std::uint64_t max_memory,
                 unsigned threads, const py::object& progress) {
    FileJob job;
    job.max_memory = max_memory;
    job.layering = {.cut = cut,
                    .at = slice_at_named(at),
                    .only = {.z_range = z_range, .index_range = layers},
                    .snap_mm = snap_mm};
    Plan plan = result_of(threads, progress,
                          [&](const Execution& execution) { return plan_of(job, plate->placed, execution); });
    return {std::move(plan), std::move(job.layering), close_gaps_mm, fill_rule(fill),
            bottom_inset(bottom_offset, plate->placed.box.min.z)};
}

/// Returns the number of layers of the whole plan, but at most one more than the index after the last of
/// these layers, which shows whether there are layers above them.
std::uint64_t planned(const CutPlan& cuts, const SourcePlate& plate, const Execution& execution) {
    const std::uint64_t end = cuts.plan.layers.back().index + 1;
    const PlaneSelection& only = cuts.layering.only;
    return only.z_range || only.index_range
               ? cuts.only(cuts.plan.layers.front().index, end + 1, plate, execution).layers.back().index + 1
               : end;
}

/// Returns the layers of each part, if there are several.
std::vector<std::shared_ptr<Stack>> parts_of(const Stack& stack, const SourcePlate& plate) {
    std::vector<std::shared_ptr<Stack>> parts;
    for (std::size_t i = 0; plate.several() && i < plate.placed.parts.size(); ++i) {
        const PlatePart& placed = plate.placed.parts[i];
        Stack& part = *parts.emplace_back(std::make_shared<Stack>());
        for (const LayerPointer& layer : stack.layers)
            part.layers.push_back(layer->parts()[i]);
        part.label = placed.label;
        part.box = placed.box;
        part.of_mesh = true;
        part.planned = stack.planned;
        part.matrix = plate.matrices[i];
        part.rule = stack.rule;
        part.support = placed.support;
    }
    return parts;
}

std::shared_ptr<Stack> slice_stack(const PlatePointer& plate, const CutPlan& cuts, const std::string& with,
                                   unsigned threads, const py::object& progress) {
    const Engine& chosen = engine(with);
    auto stack = std::make_shared<Stack>();
    stack->repairs = plate->repairs;
    cuts.add(stack->repairs, {});
    run(threads, progress, [&](const Execution& execution) {
        stack->layers = sliced(*plate, cuts, cuts.plan, execution, chosen, &stack->repairs);
        stack->planned = planned(cuts, *plate, execution);
    });
    stack->rule = cuts.plan.rule;
    stack->label = plate->label;
    stack->box = plate->placed.box;
    stack->of_mesh = true;
    stack->matrix = plate->matrix;
    stack->support = plate->apart && !plate->several() && plate->placed.parts.front().support;
    stack->parts = parts_of(*stack, *plate);
    return stack;
}

/// Index of a file of a plate, and a text about it.
using FileTexts = std::vector<std::pair<std::size_t, std::string>>;

/// Returns the defects of the meshes that show in their layers.
FileTexts doubts_of(const Stack& stack, const PlatePointer& plate) {
    std::vector<std::vector<LayerStack>> files(plate->placed.files.size());
    std::vector<LayerStack> parts = plain_parts(stack);
    for (std::size_t i = 0; i < parts.size(); ++i)
        files[plate->placed.shapes[plate->placed.parts[i].shape].input].push_back(std::move(parts[i]));
    return result_of(0, py::none(), [&](const Execution& execution) {
        FileTexts texts;
        for (std::size_t file = 0; file < files.size(); ++file)
            for (std::string& text : layer_findings(source_of(std::move(files[file]), {}, execution),
                                                    LayerUse::cut, InversionSearch::quick, execution)
                                         .texts())
                texts.emplace_back(file, std::move(text));
        return texts;
    });
}

/// Returns a warning for each file with layers whose content rounding decides.
FileTexts near_faces_of(const PlatePointer& plate, const CutPlan& cuts, unsigned threads,
                        const py::object& progress) {
    return result_of(threads, progress, [&](const Execution& execution) {
        FileTexts texts;
        for (std::size_t file = 0; file < plate->mended.files.size(); ++file) {
            std::vector<Mesh> meshes;
            for (const PlateShape& shape : plate->mended.shapes)
                if (shape.input == file)
                    meshes.push_back(shape.mesh);
            for (std::string& text : near_faces(joined(meshes, execution), cuts.plan, execution).texts())
                texts.emplace_back(file, std::move(text));
        }
        return texts;
    });
}

/// Label and bounds of a part, and whether it is a support.
using PartHeader = std::tuple<std::string, py::array_t<double>, bool>;

/// Returns what a slice file says of each part of the plate.
std::vector<PartHeader> headers_of(const SourcePlate& plate) {
    if (!plate.apart)
        return {{plate.label, bounds_of(plate.placed.box), false}};
    std::vector<PartHeader> parts;
    for (const PlatePart& part : plate.placed.parts)
        parts.emplace_back(part.label, bounds_of(part.box), part.support);
    return parts;
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
            "bounds", [](const LayerStream& self) { return bounds_of(self.plate().placed.box); },
            "The smallest and the largest x, y and z of the mesh in millimetres: (2, 3) float64.")
        .def_property_readonly(
            "label", [](const LayerStream& self) { return path_text(self.plate().label); },
            "What the part is called in slice files; empty for several parts.")
        .def_property_readonly(
            "labels",
            [](const LayerStream& self) {
                std::vector<py::str> labels;
                for (const PartHeader& part : headers_of(self.plate()))
                    labels.push_back(path_text(std::get<std::string>(part)));
                return labels;
            },
            "What the parts are called in slice files, in the order of Layer.parts.")
        .def_property_readonly(
            "rule", [](const LayerStream& self) { return plane_rule_name(self.plan().rule); },
            "The rule of the plane, as Stack.rule.")
        .def_property_readonly(
            "repairs", [](const LayerStream& self) { return self.repairs(); },
            "What was mended in the mesh and in the layers taken so far, as Stack.repairs.")
        .def_property_readonly("_parts",
                               [](const LayerStream& self) {
                                   py::list parts;
                                   for (const auto& [label, bounds, support] : headers_of(self.plate()))
                                       parts.append(py::make_tuple(py::bytes(label), bounds, support));
                                   return parts;
                               })
        .def_property_readonly("_bottom", &LayerStream::bottom)
        .def("_beside", &LayerStream::beside)
        .def("_close", &LayerStream::close)
        .def("__len__", &LayerStream::left)
        .def("__iter__", [](const py::object& self) { return self; })
        .def("__next__", &LayerStream::next)
        .def("__enter__", [](const py::object& self) { return self; })
        .def("__exit__", [](LayerStream& self, const py::args&) { self.close(); })
        .def("__repr__", [](const LayerStream& self) {
            return "<lamella.LayerStream: " + std::to_string(self.left()) + " of " +
                   std::to_string(self.plan().layers.size()) + " layers left>";
        });
    complete(module.attr("LayerStream"), "_methods");
    module.def("stream", [](const PlatePointer& plate, const CutPlan& cuts, const std::string& with,
                            unsigned threads, const py::object& progress) {
        return std::make_unique<LayerStream>(plate, cuts, engine(with), threads, progress);
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
