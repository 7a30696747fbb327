#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "checks.hpp"
#include "classes.hpp"
#include "gil_release.hpp"
#include "layer_of_arrays.hpp"
#include "placing.hpp"
#include "sequences.hpp"
#include "shared_layer.hpp"
#include "texts.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace lamella::python {
namespace {

/// Returns the positions of the layers of a slice.
std::vector<std::size_t> positions_of(const Stack& stack, const py::slice& range) {
    py::ssize_t start = 0;
    py::ssize_t stop = 0;
    py::ssize_t step = 0;
    py::ssize_t count = 0;
    if (!range.compute(static_cast<py::ssize_t>(stack.layers.size()), &start, &stop, &step, &count))
        throw py::error_already_set();
    if (step < 0)
        throw py::value_error("layers of a stack ascend: its slices cannot run backwards");
    std::vector<std::size_t> positions;
    for (py::ssize_t i = 0; i < count; ++i)
        positions.push_back(static_cast<std::size_t>(start + i * step));
    return positions;
}

/// Returns a stack of the layers at these positions, which ascend.
StackPointer part_of(const Stack& stack, const std::vector<std::size_t>& positions) {
    auto part = std::make_shared<Stack>(stack);
    for (StackPointer& each : part->parts)
        each = part_of(*each, positions);
    part->layers.clear();
    for (const std::size_t position : positions)
        part->layers.push_back(stack.layers.at(position));
    if (!part->of_mesh)
        part->box = box_of(part->layers);
    return part;
}

/// Returns a function that computes one number for each layer.
template <class T, class Value>
auto numbers_of(const Value& value) {
    return [value](const Stack& stack) {
        return array_of<T>(stack.layers, [&](const LayerPointer& layer) { return value(*layer); });
    };
}

/// Returns a function that measures all layers without the interpreter lock, and then returns one number
/// each.
template <class T, class Value>
auto measures_of(const Value& value) {
    return [value](const Stack& stack) {
        {
            const GilRelease released;
            for (const LayerPointer& layer : stack.layers)
                static_cast<void>(layer->measure());
        }
        return array_of<T>(stack.layers, [&](const LayerPointer& layer) { return value(layer->measure()); });
    };
}

double volume_of(const Stack& stack) {
    const GilRelease released;
    double volume = 0;
    for (const LayerPointer& layer : stack.layers)
        volume += layer->measure().area_mm2 * layer->get().thickness();
    return volume;
}

template <class Count>
std::uint64_t sum_of(const Stack& stack, const Count& count) {
    std::uint64_t sum = 0;
    for (const LayerPointer& layer : stack.layers)
        sum += count(layer->get());
    return sum;
}

double resolution_of(const Stack& stack) {
    double largest = 0;
    const Box3 box = shown_box(stack);
    for (const Point3& corner : {box.min, box.max})
        largest = std::max({largest, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
    return stack.rounding.step_at(largest);
}

std::string stack_text(const Stack& stack) {
    std::string text = "<lamella.Stack of " + std::to_string(stack.layers.size()) + " layers";
    if (!stack.layers.empty()) {
        std::array<char, 80> range{};
        std::snprintf(range.data(), range.size(), " from z = %.6g to %.6g mm",
                      stack.layers.front()->get().bottom, stack.layers.back()->get().top);
        text += range.data();
    }
    return text + ": " + std::to_string(sum_of(stack, [](const Layer& l) { return l.contours(); })) +
           " contours, " + std::to_string(sum_of(stack, [](const Layer& l) { return l.points.size(); })) +
           " points>";
}

bool same_stacks(const Stack& a, const Stack& b) {
    return std::ranges::equal(a.layers, b.layers, [](const LayerPointer& first, const LayerPointer& second) {
        return same(*first, *second);
    });
}

void require_ascending(const std::vector<LayerPointer>& layers) {
    for (std::size_t i = 0; i + 1 < layers.size(); ++i)
        if (!(layers[i]->get().z < layers[i + 1]->get().z))
            throw Error(ErrorKind::usage, "layers: those of a stack must ascend in z: number " +
                                              std::to_string(i + 1) + " is not above the one before it");
}

PlaneRule rule_of(const std::vector<LayerPointer>& layers) {
    std::optional<PlaneRule> found;
    for (const LayerPointer& layer : layers) {
        const std::optional<PlaneRule> rule = layer->rule();
        if (found && rule && *rule != *found)
            throw Error(ErrorKind::usage, "layers: those of a stack must be cut by the same rule: slice them "
                                          "with the same `at`");
        found = rule ? rule : found;
    }
    return found.value_or(PlaneRule::section_above);
}

StackPointer stack_of_layers(std::vector<LayerPointer> layers, const std::string& label) {
    require_ascending(layers);
    auto stack = std::make_shared<Stack>();
    stack->rule = rule_of(layers);
    stack->box = box_of(layers);
    stack->layers = std::move(layers);
    stack->label = label;
    return stack;
}

py::tuple pickled(const Stack& stack) {
    return py::make_tuple(stack.layers, py::bytes(stack.label), bounds_of(stack.box), matrix_of(stack.matrix),
                          py::bytes(stack.path), stack.format, stack.rounding.step_mm,
                          stack.rounding.single_precision, plane_rule_name(stack.rule), stack.parts,
                          stack.exposure, stack.support, stack.of_mesh, stack.planned, stack.repairs);
}

StackPointer unpickled(const py::tuple& state) {
    const StackPointer stack =
        stack_of_layers(pointers_of<LayerPointer>(state[0]), state[1].cast<std::string>());
    stack->box = box_of(state[2].cast<Bounds>());
    stack->matrix = transform_of(state[3].cast<Matrix>());
    stack->path = state[4].cast<std::string>();
    stack->format = state[5].cast<std::string>();
    stack->rounding = {state[6].cast<double>(), state[7].cast<bool>()};
    stack->rule = rule_named(state[8].cast<std::string>());
    stack->parts = pointers_of<StackPointer>(state[9]);
    for (const StackPointer& part : stack->parts)
        if (part->layers.size() != stack->layers.size())
            throw Error(ErrorKind::input, "the parts of a pickled stack must have as many layers as it has");
    stack->exposure = state[10].cast<std::optional<Exposure>>();
    stack->support = state[11].cast<bool>();
    stack->of_mesh = state[12].cast<bool>();
    stack->planned = state[13].cast<std::uint64_t>();
    stack->repairs = state[14].cast<Repairs>();
    if (!finite(stack->matrix) || !(stack->box.empty() || finite(stack->box)))
        throw Error(ErrorKind::input, "the bounds and the matrix of a pickled stack must be finite");
    return stack;
}

} // namespace

void bind_stacks(py::module_& module) {
    py::class_<Stack, StackPointer> cls(
        module, "Stack",
        "Layers in ascending z, as lamella.slice and lamella.read give them. A sequence of Layer: stack[i],\n"
        "stack[a:b], len(stack), and for layer in stack. It never changes.",
        own_new());
    cls.def(py::init([](const py::iterable& layers, const std::string& label) {
           std::vector<LayerPointer> pointers;
           for (const py::handle layer : layers)
               pointers.push_back(checked_layer("layers", layer, "layers"));
           return stack_of_layers(std::move(pointers), label);
       }))
        .def_property_readonly("z", numbers_of<double>([](const SharedLayer& l) { return l.get().z; }),
                               "Where the layers were cut, in millimetres: (layers,) float64.")
        .def_property_readonly("bottom",
                               numbers_of<double>([](const SharedLayer& l) { return l.get().bottom; }),
                               "Where the material of the layers begins, in millimetres: (layers,) float64.")
        .def_property_readonly("top", numbers_of<double>([](const SharedLayer& l) { return l.get().top; }),
                               "Where the material of the layers ends, in millimetres: (layers,) float64.")
        .def_property_readonly("area", measures_of<double>([](const LayerMeasure& m) { return m.area_mm2; }),
                               "The areas of the layers in square millimetres: (layers,) float64.")
        .def_property_readonly("perimeter",
                               measures_of<double>([](const LayerMeasure& m) { return m.perimeter_mm; }),
                               "The lengths of their contours in millimetres: (layers,) float64.")
        .def_property_readonly(
            "contours", numbers_of<std::int64_t>([](const SharedLayer& l) { return l.get().contours(); }),
            "How many contours each layer has: (layers,) int64.")
        .def_property_readonly("open_chains", numbers_of<std::int64_t>([](const SharedLayer& l) {
                                   return l.get().open_chains();
                               }),
                               "How many contours of each layer are not closed: (layers,) int64.")
        .def_property_readonly(
            "hashes",
            [](const Stack& self) {
                std::vector<std::string> hashes;
                for (const LayerPointer& layer : self.layers)
                    hashes.push_back(hash_text(*layer));
                return hashes;
            },
            "The hash of each layer, see Layer.hash.")
        .def_property_readonly("volume", &volume_of, "The sum of area times thickness, in cubic millimetres.")
        .def_property_readonly("point_counts", numbers_of<std::int64_t>([](const SharedLayer& l) {
                                   return l.get().points.size();
                               }),
                               "How many points the contours of each layer have: (layers,) int64.")
        .def_property_readonly(
            "label", [](const Stack& self) { return path_text(self.label); },
            "What the part is called in slice files.")
        .def_property_readonly(
            "bounds", [](const Stack& self) { return bounds_of(shown_box(self)); },
            "The smallest and the largest x, y and z in millimetres: (2, 3) float64. Of the mesh that was\n"
            "sliced; of the layers where they come from a slice file.")
        .def_property_readonly(
            "matrix", [](const Stack& self) { return matrix_of(self.matrix); },
            "From the coordinates of the mesh to those of the layers, as `direction` and `transform` asked "
            "for it:\n"
            "a (4, 4) matrix.")
        .def_property_readonly(
            "parts",
            [](const StackPointer& self) {
                return self->parts.empty() ? std::vector<StackPointer>{self} : self->parts;
            },
            "The parts of a plate, or of a slice file that holds several, each a stack with a label; else "
            "the "
            "stack\nitself.")
        .def_property_readonly(
            "exposure", [](const Stack& self) { return self.exposure; },
            "What is exposed, and how, where the layers are scan vectors from a file: an Exposure; None for "
            "contours.\n"
            "What the file does not say of parameters is 0.")
        .def_property_readonly(
            "support", [](const Stack& self) { return self.support; }, "Whether the part is a support.")
        // If there are no layers, it is the empty box, from inf to -inf, while `bounds` is the origin.
        .def_property_readonly("_box", [](const Stack& self) { return bounds_of(self.box); })
        .def_property_readonly("_planned", [](const Stack& self) { return self.planned; })
        .def_property_readonly(
            "path", [](const Stack& self) { return path_text(self.path); },
            "The slice file it was read from; empty where it was sliced.")
        .def_property_readonly(
            "format", [](const Stack& self) { return self.format; },
            "The format of that file, such as \"cli\".")
        .def_property_readonly(
            "resolution", [](const Stack& self) { return resolution_of(self); },
            "The largest step to which that file rounds one of these numbers, in millimetres; 0 where it "
            "rounds\n"
            "none.")
        .def_property_readonly(
            "rule", [](const Stack& self) { return plane_rule_name(self.rule); },
            "Whether layers are sections of what is just above their plane (\"section_above\"), or, cut at "
            "the\n"
            "top, of what is just below it (\"section_below\").")
        .def_property_readonly(
            "repairs", [](const Stack& self) { return self.repairs; },
            "What was mended before and while it was sliced: a dict of counts for each repair that was asked "
            "for.")
        .def("__len__", [](const Stack& self) { return self.layers.size(); })
        .def("_item",
             [](const Stack& self, const py::object& index) -> py::object {
                 if (py::isinstance<py::slice>(index))
                     return py::cast(part_of(self, positions_of(self, index)));
                 return py::cast(self.layers[place_in(index, self.layers.size(), "layer")]);
             })
        .def("_chosen", &part_of)
        .def("__iter__", &each_of)
        .def(
            "__eq__", [](const Stack& self, const Stack& other) { return same_stacks(self, other); },
            py::is_operator())
        .def("__repr__", &stack_text);
    bind_pickle(cls, "stack of layers", 15, &pickled, &unpickled);
    bind_pixels(cls);
    complete(cls, "_methods");
}

} // namespace lamella::python
