#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/compare.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "classes.hpp"
#include "gil_release.hpp"
#include "layer_of_arrays.hpp"
#include "run.hpp"
#include "sequences.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace py = pybind11;

namespace lamella::python {
namespace {

const LayerMeasure& measure_of(const SharedLayer& layer) {
    const GilRelease released;
    return layer.measure();
}

py::array_t<double> contour_of(const py::object& self, const py::object& index) {
    const Layer& layer = self.cast<const SharedLayer&>().get();
    return view_of(layer.contour(place_in(index, layer.contours(), "contour")), self);
}

std::string layer_text(const SharedLayer& layer) {
    const Layer& it = layer.get();
    std::array<char, 200> text{};
    std::snprintf(text.data(), text.size(), "<lamella.Layer %llu at z = %.6g mm: %zu contours, %zu points%s>",
                  static_cast<unsigned long long>(it.index), it.z, it.contours(), it.points.size(),
                  it.open_chains() > 0 ? ", not all closed" : "");
    return text.data();
}

/// Returns the smallest and the largest x and y; nan without points.
py::array_t<double> layer_bounds(const SharedLayer& layer) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    std::array bounds{none, none, none, none};
    for (const Point2& p : layer.get().points)
        bounds = {std::fmin(bounds[0], p.x), std::fmin(bounds[1], p.y), std::fmax(bounds[2], p.x),
                  std::fmax(bounds[3], p.y)};
    return py::array_t<double>({2, 2}, bounds.data());
}

/// Returns the area of each contour; 0 for open chains.
py::array_t<double> contour_areas(const SharedLayer& layer) {
    const Layer& it = layer.get();
    py::array_t<double> areas(static_cast<py::ssize_t>(it.contours()));
    for (std::size_t i = 0; i < it.contours(); ++i)
        areas.mutable_at(static_cast<py::ssize_t>(i)) = it.closed(i) ? ring_area(it.contour(i)) : 0;
    return areas;
}

} // namespace

void bind_layers(py::module_& module) {
    py::class_<SharedLayer, LayerPointer> cls(
        module, "Layer",
        "What one plane yields: closed rings, and open chains where the mesh has defects. It never "
        "changes.\n\n"
        "Contours lie one after the other in `points`; contour i is points[offsets[i]:offsets[i + 1]], which "
        "is\n"
        "what layer[i] gives. Rings come first. Material lies to the left of a contour: outer rings run\n"
        "counter-clockwise, holes clockwise. A ring does not repeat its first point at its end.\n\n"
        "Slicing and reading make layers. Layer(rings, z, bottom=z, top=z, index=0, chains=()) makes one of "
        "arrays\n"
        "(n, 2) in millimetres, in any order. Points equal to the one before them are left out, and so are "
        "rings "
        "of\n"
        "less than three points and chains of less than two.",
        own_new());
    cls.def(py::init(&layer_of_contours))
        .def_property_readonly(
            "index", [](const SharedLayer& self) { return self.get().index; },
            "Its number in the whole plan, also when only a part of that was sliced.")
        .def_property_readonly(
            "z", [](const SharedLayer& self) { return self.get().z; }, "Where it was cut, in millimetres.")
        .def_property_readonly(
            "bottom", [](const SharedLayer& self) { return self.get().bottom; },
            "Where the material begins that the layer stands for, in millimetres.")
        .def_property_readonly(
            "top", [](const SharedLayer& self) { return self.get().top; },
            "Where that material ends, in millimetres.")
        .def_property_readonly(
            "thickness", [](const SharedLayer& self) { return self.get().thickness(); },
            "top - bottom, in millimetres.")
        .def_property_readonly(
            "points",
            [](const py::object& self) {
                return view_of(self.cast<const SharedLayer&>().get().points.span(), self);
            },
            "The points of all contours in millimetres: (n, 2) float64, read-only, without a copy.")
        .def_property_readonly(
            "offsets", [](const py::object& self) { return offsets_of(self); },
            "Where contours begin, and where the last one ends: (contours + 1,) int64, read-only, without a\n"
            "copy.")
        .def_property_readonly(
            "closed",
            [](const SharedLayer& self) {
                const Layer& layer = self.get();
                py::array_t<bool> closed(static_cast<py::ssize_t>(layer.contours()));
                for (std::size_t i = 0; i < layer.contours(); ++i)
                    closed.mutable_at(i) = layer.closed(i);
                return closed;
            },
            "Whether contour i is a ring: (contours,) bool. An open chain is the trace of a defect.")
        .def_property_readonly(
            "parent",
            [](const py::object& self) {
                const auto layer = self.cast<LayerPointer>();
                const std::vector<std::int64_t>* const parents =
                    result_of_points(layer->get().points.size(),
                                     [layer](const Execution& /*execution*/) { return &layer->parents(); });
                return view(parents->data(), {static_cast<py::ssize_t>(parents->size())}, self);
            },
            "The number of the innermost ring around contour i, -1 for an outermost one and for an open "
            "chain:\n"
            "(contours,) int64, read-only.")
        .def_property_readonly(
            "rings", [](const SharedLayer& self) { return self.get().rings; },
            "How many contours are closed.")
        .def_property_readonly(
            "open_chains", [](const SharedLayer& self) { return self.get().open_chains(); },
            "How many contours are not.")
        .def_property_readonly(
            "area", [](const SharedLayer& self) { return measure_of(self).area_mm2; },
            "The area of the rings in square millimetres, holes taken off.")
        .def_property_readonly(
            "perimeter", [](const SharedLayer& self) { return measure_of(self).perimeter_mm; },
            "The length of all contours in millimetres.")
        .def_property_readonly("bounds", &layer_bounds,
                               "The smallest and the largest x and y of the contours in millimetres: (2, 2) "
                               "float64;\nnan without contours.")
        .def_property_readonly("areas", &contour_areas,
                               "The area of each contour in square millimetres, negative for holes and 0 for "
                               "open chains:\n(contours,) float64.")
        .def_property_readonly("hash", &hash_text,
                               "A hash of the contours, 16 hexadecimal digits: the same for the same "
                               "contours on every machine.\n"
                               "The program's statistics have the same.")
        .def_property_readonly(
            "hatches",
            [](const py::object& self) {
                const std::span<const Point2> points = self.cast<const SharedLayer&>().hatches().span();
                const auto* first = reinterpret_cast<const double*>(points.data());
                return view(first, {static_cast<py::ssize_t>(points.size() / 2), 2, 2}, self);
            },
            "Fill lines that a slice file held beside the contours, from point to point: (n, 2, 2) float64,\n"
            "millimetres, read-only. Slicing makes none.")
        .def_property_readonly(
            "parts",
            [](const LayerPointer& self) {
                return self->parts().empty() ? std::vector<LayerPointer>{self} : self->parts();
            },
            "The layers of the parts of a plate, or of a slice file that holds several, in the order of "
            "Stack.parts;\nelse the layer itself.")
        .def("__len__", [](const SharedLayer& self) { return self.get().contours(); })
        .def("__getitem__", &contour_of)
        .def("__iter__", &each_of)
        .def(
            "__eq__", [](const SharedLayer& self, const SharedLayer& other) { return same(self, other); },
            py::is_operator())
        .def("__hash__", [](const SharedLayer& self) { return self.hash() >> 1; })
        .def("__repr__", &layer_text);
    bind_pickle(cls, "layer", 10, &layer_state, &layer_of_state);
    bind_operations(cls);
    complete(cls, "_methods");
}

} // namespace lamella::python
