#include "layer_of_arrays.hpp"

#include "lamella/contour/normal_form.hpp"

#include "arrays.hpp"
#include "gil_release.hpp"

#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace py = pybind11;

namespace lamella::python {
namespace {

static_assert(sizeof(Point2) == 2 * sizeof(double));

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

} // namespace

LayerPointer layer_of_contours(const std::vector<Doubles>& rings, double z, double bottom, double top,
                               std::uint64_t index, const std::vector<Doubles>& chains) {
    const GilRelease released;
    LayerBuilder builder;
    for (const auto* contours : {&rings, &chains})
        for (const Doubles& contour : *contours)
            add_contour(points_of(contour), contours == &rings, builder);
    return std::make_shared<SharedLayer>(builder.finish(index, z, bottom, top));
}

py::array_t<double> view_of(std::span<const Point2> points, const py::object& owner) {
    const auto* first = reinterpret_cast<const double*>(points.data());
    return view(first, {static_cast<py::ssize_t>(points.size()), 2}, owner);
}

py::array_t<std::int64_t> offsets_of(const py::object& self) {
    // Signed, because in NumPy the sum of signed and unsigned numbers is floating-point.
    const std::vector<std::uint64_t>& offsets = self.cast<const SharedLayer&>().get().offsets;
    const auto* first = reinterpret_cast<const std::int64_t*>(offsets.data());
    return view(first, {static_cast<py::ssize_t>(offsets.size())}, self);
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

} // namespace lamella::python
