#include "layers.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/compare.hpp"
#include "lamella/polygon/contour_defects.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/polygon/offset.hpp"
#include "lamella/raster/image.hpp"

#include "arrays.hpp"
#include "gil_release.hpp"
#include "pickled.hpp"
#include "placing.hpp"
#include "run.hpp"
#include "shared_layer.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace lamella::python {
namespace {

// Arguments of other types are rejected if their conversion would lose information.
using Doubles = py::array_t<double, py::array::c_style>;
using Numbers = py::array_t<std::int64_t, py::array::c_style>;

static_assert(sizeof(Point2) == 2 * sizeof(double));

const Layer& layer_of(const py::object& self) {
    return self.cast<const SharedLayer&>().get();
}

py::array_t<double> view_of(std::span<const Point2> points, const py::object& owner) {
    const auto* first = reinterpret_cast<const double*>(points.data());
    return view(first, {static_cast<py::ssize_t>(points.size()), 2}, owner);
}

py::array_t<std::int64_t> offsets_of(const py::object& self) {
    // Signed, because in NumPy the sum of signed and unsigned numbers is floating-point.
    const std::vector<std::uint64_t>& offsets = layer_of(self).offsets;
    const auto* first = reinterpret_cast<const std::int64_t*>(offsets.data());
    return view(first, {static_cast<py::ssize_t>(offsets.size())}, self);
}

const LayerMeasure& measure_of(const SharedLayer& layer) {
    const GilRelease released;
    return layer.measure();
}

std::string hash_text(const SharedLayer& layer) {
    std::uint64_t hash = 0;
    {
        const GilRelease released;
        hash = layer.hash();
    }
    std::array<char, 17> text{};
    std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash));
    return text.data();
}

/// Returns the position among `size` items that an index denotes; negative indices count from the end.
std::size_t place_in(const py::object& index, std::size_t size, const char* what) {
    if (PyIndex_Check(index.ptr()) == 0)
        throw py::type_error(std::string("the number of a ") + what + ": expected a whole number, found " +
                             Py_TYPE(index.ptr())->tp_name);
    const py::ssize_t number = PyNumber_AsSsize_t(index.ptr(), PyExc_IndexError);
    if (number == -1 && PyErr_Occurred() != nullptr)
        throw py::error_already_set();
    const auto count = static_cast<py::ssize_t>(size);
    if (number < -count || number >= count)
        throw py::index_error(what + std::string(" ") + std::to_string(number) + " of " +
                              std::to_string(size));
    return static_cast<std::size_t>(number < 0 ? number + count : number);
}

py::array_t<double> contour_of(const py::object& self, const py::object& index) {
    const Layer& layer = layer_of(self);
    return view_of(layer.contour(place_in(index, layer.contours(), "contour")), self);
}

/// Returns pairs of a ring and its holes, by index.
std::vector<std::pair<std::uint32_t, std::vector<std::uint32_t>>> polygons_of(const LayerPointer& layer) {
    return result_of_points(layer->get().points.size(), [layer](const Execution& /*execution*/) {
        std::vector<std::pair<std::uint32_t, std::vector<std::uint32_t>>> found;
        for (Polygon& polygon : polygons(layer->nesting()))
            found.emplace_back(polygon.outer, std::move(polygon.holes));
        return found;
    });
}

/// Kind, contour, the other contour and location of each defect; the number of crossings, and whether the
/// search ended there.
py::tuple diagnosed(const LayerPointer& layer, double resolution, std::size_t keep) {
    const ContourDefects defects =
        result_of_points(layer->get().points.size(), [=](const Execution& /*execution*/) {
            return contour_defects(layer->get(), {.step_mm = resolution}, keep);
        });
    py::list found;
    for (const ContourDefect& defect : defects.found)
        found.append(py::make_tuple(contour_defect_name(defect.kind), defect.contour, defect.other,
                                    std::pair(defect.at.x, defect.at.y)));
    return py::make_tuple(found, defects.crossings, defects.or_more);
}

/// The fields of a layer except the arrays, for construction and pickling.
struct LayerHeader {
    std::uint64_t index = 0;
    double z = 0;
    double bottom = 0;
    double top = 0;
};

PointArray points_of(const Doubles& rows) {
    if (rows.ndim() != 2 || rows.shape(1) != 2)
        throw Error(ErrorKind::input, "points of a layer must be an array of the shape (n, 2)");
    std::vector<Point2> points(static_cast<std::size_t>(rows.size()) / 2);
    const double* x = rows.data();
    for (Point2& p : points) {
        if (!(std::isfinite(x[0]) && std::isfinite(x[1])))
            throw Error(ErrorKind::input, "a point of a layer is not finite");
        p = {x[0] + 0.0, x[1] + 0.0}; // -0 would compare equal and hash differently
        x += 2;
    }
    return PointArray(std::move(points));
}

std::vector<std::uint64_t> offsets_of(const Numbers& numbers, std::size_t points) {
    std::vector<std::uint64_t> offsets(numbers.data(), numbers.data() + numbers.size());
    if (numbers.ndim() != 1 || offsets.empty() || offsets.front() != 0 || offsets.back() != points ||
        std::adjacent_find(offsets.begin(), offsets.end(), std::greater_equal<>()) != offsets.end())
        throw Error(ErrorKind::input,
                    "offsets must begin with 0, ascend, and end with the number of points, " +
                        std::to_string(points));
    return offsets;
}

LayerPointer layer_of_arrays(const LayerHeader& header, const Doubles& points, const Numbers& offsets,
                             std::size_t rings, const Doubles& hatches, std::optional<PlaneRule> rule,
                             std::vector<LayerPointer> parts) {
    if (!(std::isfinite(header.bottom) && std::isfinite(header.top) && header.bottom <= header.z &&
          header.z <= header.top))
        throw Error(ErrorKind::input, "a layer is cut between its bottom and its top, which are finite");
    Layer layer{.index = header.index, .z = header.z, .bottom = header.bottom, .top = header.top};
    layer.points = points_of(points);
    layer.offsets = offsets_of(offsets, layer.points.size());
    PointArray lines = points_of(hatches);
    if (lines.size() % 2 != 0)
        throw Error(ErrorKind::input, "hatch lines of a layer must have two points each");
    layer.rings = rings;
    if (rings > layer.contours())
        throw Error(ErrorKind::input, "there are more closed contours than contours");
    // Not converted to normal form, because the order of scan vectors is significant.
    return std::make_shared<SharedLayer>(std::move(layer), rule, std::move(lines), std::move(parts));
}

/// Adds a contour by the rules of docs/conventions.md: drops points equal to the one before them, and the
/// contour if too few points remain.
void add_contour(const PointArray& points, bool closed, LayerBuilder& builder) {
    std::vector<Point2> kept;
    std::unique_copy(points.begin(), points.end(), std::back_inserter(kept));
    while (closed && kept.size() > 1 && kept.back() == kept.front())
        kept.pop_back();
    if (kept.size() >= (closed ? 3U : 2U))
        builder.add_contour(kept, closed);
}

/// Makes a layer of contours in any order.
LayerPointer layer_of_contours(const std::vector<Doubles>& rings, double z, double bottom, double top,
                               std::uint64_t index, const std::vector<Doubles>& chains) {
    const GilRelease released;
    LayerBuilder builder;
    for (const auto* contours : {&rings, &chains})
        for (const Doubles& contour : *contours)
            add_contour(points_of(contour), contours == &rings, builder);
    return std::make_shared<SharedLayer>(builder.finish(index, z, bottom, top));
}

/// Returns the corner of this name, which is one of the three.
OffsetCorner offset_corner(const std::string& name) {
    for (const OffsetCorner corner : {OffsetCorner::bevel, OffsetCorner::round})
        if (offset_corner_name(corner) == name)
            return corner;
    return OffsetCorner::mitre;
}

bool same(const SharedLayer& first, const SharedLayer& second) {
    const Layer& a = first.get();
    const Layer& b = second.get();
    return a.index == b.index && a.z == b.z && a.bottom == b.bottom && a.top == b.top &&
           same_contours(a, b) && std::ranges::equal(first.hatches(), second.hatches());
}

std::string layer_text(const SharedLayer& layer) {
    const Layer& it = layer.get();
    std::array<char, 200> text{};
    std::snprintf(text.data(), text.size(), "<lamella.Layer %llu at z = %.6g mm: %zu contours, %zu points%s>",
                  static_cast<unsigned long long>(it.index), it.z, it.contours(), it.points.size(),
                  it.open_chains() > 0 ? ", not all closed" : "");
    return text.data();
}

/// Returns what was made of a layer. Its hatch lines remain only if the contours that they fill do.
LayerPointer made_of(const SharedLayer& layer, Layer made) {
    PointArray hatches = same_contours(layer.get(), made) ? layer.hatches() : PointArray();
    return std::make_shared<SharedLayer>(std::move(made), layer.rule(), std::move(hatches));
}

LayerPointer after(const LayerPointer& layer, const LayerSteps& steps) {
    return result_of_points(layer->get().points.size(), [layer, steps](const Execution& execution) {
        return made_of(*layer, take_steps(steps, layer->get(), layer_limits(execution)).layer);
    });
}

std::vector<LayerPointer> offsets_by(const LayerPointer& layer, const std::vector<double>& distances,
                                     const std::string& corners, double mitre_limit,
                                     double arc_tolerance_mm) {
    const OffsetCorners joins{offset_corner(corners), mitre_limit, arc_tolerance_mm};
    return result_of_points(layer->get().points.size(), [=](const Execution& execution) {
        std::vector<LayerPointer> made;
        for (Layer& one :
             offsets(layer->get(), distances, {.corners = joins, .limits = layer_limits(execution)}))
            made.push_back(made_of(*layer, std::move(one)));
        return made;
    });
}

/// Returns the image whose first pixel is at the left and the top.
py::array_t<std::uint8_t> image_of(const LayerPointer& layer, double pixel_x, double pixel_y, double left,
                                   double top, std::uint32_t columns, std::uint32_t rows,
                                   unsigned antialias) {
    const PixelGrid grid{.width = columns,
                         .height = rows,
                         .ux = 1 / pixel_x,
                         .u0 = -left / pixel_x,
                         .vy = -1 / pixel_y,
                         .v0 = top / pixel_y};
    const GreyImage image = result_of_points(
        layer->get().points.size() + std::size_t{rows} * columns, [=](const Execution& /*execution*/) {
            return paint(std::span(&layer->get(), 1), grid, {.antialias = antialias});
        });
    return py::array_t<std::uint8_t>({image.height, image.width}, image.values.data());
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

/// Returns the result of the operation for a layer and another one.
template <BooleanOperation operation>
LayerPointer combined(const LayerPointer& layer, const LayerPointer& other) {
    const std::size_t points = layer->get().points.size() + other->get().points.size();
    return result_of_points(points, [layer, other](const Execution& execution) {
        return std::make_shared<SharedLayer>(
            combine(layer->get(), other->get(), operation, layer_limits(execution)), layer->rule());
    });
}

py::tuple layer_state(const py::object& self) {
    const auto& shared = self.cast<const SharedLayer&>();
    const Layer& layer = shared.get();
    std::optional<std::string_view> rule;
    if (const auto known = shared.rule())
        rule = plane_rule_name(*known);
    return py::make_tuple(layer.index, layer.z, layer.bottom, layer.top, view_of(layer.points.span(), self),
                          offsets_of(self), layer.rings, view_of(shared.hatches().span(), self), rule,
                          shared.parts());
}

/// Converts a list. Throws for None, which pybind11 would convert to a null pointer.
template <class Pointer>
std::vector<Pointer> pointers_of(const py::object& list) {
    auto pointers = list.cast<std::vector<Pointer>>();
    if (std::find(pointers.begin(), pointers.end(), nullptr) != pointers.end())
        throw Error(ErrorKind::input, "None is in the place of a layer or a part of what was pickled");
    return pointers;
}

LayerPointer layer_of_state(const py::tuple& state) {
    const LayerHeader header{state[0].cast<std::uint64_t>(), state[1].cast<double>(), state[2].cast<double>(),
                             state[3].cast<double>()};
    std::optional<PlaneRule> rule;
    if (!state[8].is_none())
        rule = rule_named(state[8].cast<std::string>());
    return layer_of_arrays(header, state[4].cast<Doubles>(), state[5].cast<Numbers>(),
                           state[6].cast<std::size_t>(), state[7].cast<Doubles>(), rule,
                           pointers_of<LayerPointer>(state[9]));
}

using StackPointer = std::shared_ptr<Stack>;

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

/// Returns an iterator that calls __getitem__ until it raises IndexError.
py::object each_of(const py::object& sequence) {
    return py::reinterpret_steal<py::object>(PySeqIter_New(sequence.ptr()));
}

void bind_layer(py::module_& module) {
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
            "points", [](const py::object& self) { return view_of(layer_of(self).points.span(), self); },
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
        .def("_polygons", &polygons_of)
        .def("_diagnosed", &diagnosed)
        .def("_filled", [](const LayerPointer& self,
                           const std::string& rule) { return after(self, {.fill = fill_rule(rule)}); })
        .def("_offsets", &offsets_by)
        .def("_image", &image_of)
        .def("_union", &combined<BooleanOperation::unite>)
        .def("_intersection", &combined<BooleanOperation::intersect>)
        .def("_difference", &combined<BooleanOperation::subtract>)
        .def("_symmetric_difference", &combined<BooleanOperation::exclude>)
        .def("_simplified", [](const LayerPointer& self,
                               double tolerance) { return after(self, {.simplify_mm = tolerance}); })
        .def("__len__", [](const SharedLayer& self) { return self.get().contours(); })
        .def("__getitem__", &contour_of)
        .def("__iter__", &each_of)
        .def(
            "__eq__", [](const SharedLayer& self, const SharedLayer& other) { return same(self, other); },
            py::is_operator())
        .def("__hash__", [](const SharedLayer& self) { return self.hash() >> 1; })
        .def("__repr__", &layer_text);
    bind_pickle(cls, "layer", 10, &layer_state, &layer_of_state);
}

void bind_stack(py::module_& module) {
    py::class_<Stack, StackPointer> cls(
        module, "Stack",
        "Layers in ascending z, as lamella.slice and lamella.read give them. A sequence of Layer: stack[i],\n"
        "stack[a:b], len(stack), and for layer in stack. It never changes.",
        own_new());
    cls.def(py::init(&stack_of_layers))
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
        .def("__getitem__",
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
}

} // namespace

FillRule fill_rule(const std::string& name) {
    for (const FillRule rule : {FillRule::nonzero, FillRule::evenodd, FillRule::positive})
        if (fill_rule_name(rule) == name)
            return rule;
    return FillRule::none;
}

py::str path_text(const std::string& path) {
    return py::reinterpret_steal<py::str>(
        PyUnicode_DecodeFSDefaultAndSize(path.data(), static_cast<py::ssize_t>(path.size())));
}

py::list message_texts(const std::vector<std::string>& texts) {
    py::list list;
    for (const std::string& text : texts)
        list.append(printable(text)); // as in the program
    return list;
}

void bind_layers(py::module_& module) {
    bind_layer(module);
    bind_stack(module);
}

} // namespace lamella::python
