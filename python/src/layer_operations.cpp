#include "lamella/contour/normal_form.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/compare.hpp"
#include "lamella/polygon/contour_defects.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/polygon/offset.hpp"
#include "lamella/raster/image.hpp"

#include "bindings.hpp"
#include "checks.hpp"
#include "run.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace lamella::python {
namespace {

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
py::tuple defects_of_contours(const LayerPointer& layer, double resolution, std::size_t keep) {
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

/// Returns the corner of this name, which is one of the three.
OffsetCorner offset_corner(const std::string& name) {
    for (const OffsetCorner corner : {OffsetCorner::bevel, OffsetCorner::round})
        if (offset_corner_name(corner) == name)
            return corner;
    return OffsetCorner::mitre;
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

/// Binds an operation of a layer and another one: a method that is checked by Python, and an operator.
void bind_operation(py::class_<SharedLayer, LayerPointer>& cls, BooleanOperation operation,
                    const std::string& method, const char* name) {
    cls.def(("_" + method).c_str(), [operation](const LayerPointer& layer, const py::object& with) {
        const LayerPointer other = checked_layer("other", with, "a layer");
        const std::size_t points = layer->get().points.size() + other->get().points.size();
        return result_of_points(points, [=](const Execution& execution) {
            return std::make_shared<SharedLayer>(
                combine(layer->get(), other->get(), operation, layer_limits(execution)), layer->rule());
        });
    });
    cls.def(
        name,
        [method](const LayerPointer& layer, const LayerPointer& other) {
            return py::cast(layer).attr(method.c_str())(other).cast<LayerPointer>();
        },
        py::is_operator());
}

} // namespace

void bind_operations(py::class_<SharedLayer, LayerPointer>& cls) {
    cls.def("_polygons", &polygons_of)
        .def("_diagnosed", &defects_of_contours)
        .def("_filled", [](const LayerPointer& self,
                           const std::string& rule) { return after(self, {.fill = fill_rule(rule)}); })
        .def("_simplified", [](const LayerPointer& self,
                               double tolerance) { return after(self, {.simplify_mm = tolerance}); })
        .def("_offsets", &offsets_by)
        .def("_image", &image_of);
    bind_operation(cls, BooleanOperation::unite, "union", "__or__");
    bind_operation(cls, BooleanOperation::intersect, "intersection", "__and__");
    bind_operation(cls, BooleanOperation::subtract, "difference", "__sub__");
    bind_operation(cls, BooleanOperation::exclude, "symmetric_difference", "__xor__");
}

} // namespace lamella::python
