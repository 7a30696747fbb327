// A slicer puts the part anywhere on the display, so the place is taken from the centroids of the whole part.
// Areas and centroids of layers do not change when a symmetric layer is mirrored, so the extent of each layer
// around this place is compared as well.

#include "jobs/image_check.hpp"

#include "lamella/contour/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lamella {

namespace {

/// A way to mirror or rotate shapes: x and y are exchanged if `swap` is set, and then multiplied by these
/// signs.
struct Mirroring {
    bool swap;
    double x;
    double y;
    const char* name;
};

constexpr std::array mirrorings{Mirroring{false, 1, 1, ""},
                                Mirroring{false, -1, 1, "mirrored along x"},
                                Mirroring{false, 1, -1, "mirrored along y"},
                                Mirroring{false, -1, -1, "rotated by half a turn"},
                                Mirroring{true, -1, 1, "rotated by a quarter turn to the left"},
                                Mirroring{true, 1, -1, "rotated by a quarter turn to the right"},
                                Mirroring{true, 1, 1, "with x and y exchanged"},
                                Mirroring{true, -1, -1, "with x and y exchanged and both mirrored"}};

/// Returns the centroid of all layers together.
Point2 middle_of(std::span<const LayerShape> shapes) {
    AreaMoments all;
    for (const LayerShape& shape : shapes)
        all.add(shape.moments);
    return all.area_mm2 == 0 ? Point2{} : Point2{all.x_mm3 / all.area_mm2, all.y_mm3 / all.area_mm2};
}

LayerShape mirrored(const LayerShape& shape, const Mirroring& by) {
    LayerShape other = shape;
    const auto moved = [&](double x, double y) {
        return by.swap ? Point2{by.x * y, by.y * x} : Point2{by.x * x, by.y * y};
    };
    const Point2 moments = moved(shape.moments.x_mm3, shape.moments.y_mm3);
    other.moments.x_mm3 = moments.x;
    other.moments.y_mm3 = moments.y;
    if (shape.box)
        other.box = Box2::of(moved(shape.box->x0, shape.box->y0), moved(shape.box->x1, shape.box->y1));
    return other;
}

/// Compares the shapes of layers, of which the second ones are moved by a vector.
class ShapeComparison {
  public:
    ShapeComparison(double pixel_mm, Point2 moved) : pixel_mm_(pixel_mm), moved_(moved) {}

    [[nodiscard]] bool areas_agree(const LayerShape& image, const LayerShape& section) const {
        return std::abs(image.moments.area_mm2 - section.moments.area_mm2) <= area_tolerance(image, section);
    }
    /// Returns whether the shapes are at the same place.
    [[nodiscard]] bool places_agree(const LayerShape& image, const LayerShape& section) const {
        if (!image.box || !section.box)
            return image.box.has_value() == section.box.has_value() || is_thin(image) || is_thin(section);
        const double slack = 2 * pixel_mm_;
        const Box2& a = *image.box;
        const Box2& b = *section.box;
        if (std::abs(a.x0 - b.x0 - moved_.x) > slack || std::abs(a.x1 - b.x1 - moved_.x) > slack ||
            std::abs(a.y0 - b.y0 - moved_.y) > slack || std::abs(a.y1 - b.y1 - moved_.y) > slack)
            return false;
        const AreaMoments& one = image.moments;
        const AreaMoments& other = section.moments;
        const double reach = std::max(b.width(), b.height()) + pixel_mm_;
        const double tolerance = area_tolerance(image, section) * reach;
        const double x = one.x_mm3 - other.x_mm3 - moved_.x * other.area_mm2;
        const double y = one.y_mm3 - other.y_mm3 - moved_.y * other.area_mm2;
        // The moments are about the middle of the section, so that a difference of areas does not count.
        const Point2 centre{(b.x0 + b.x1) / 2 + moved_.x, (b.y0 + b.y1) / 2 + moved_.y};
        const double more = one.area_mm2 - other.area_mm2;
        return std::abs(x - centre.x * more) <= tolerance && std::abs(y - centre.y * more) <= tolerance;
    }

  private:
    [[nodiscard]] double area_tolerance(const LayerShape& image, const LayerShape& section) const {
        return (std::min(image.perimeter_mm, section.perimeter_mm) / 2 + 8 * pixel_mm_) * pixel_mm_;
    }
    [[nodiscard]] bool is_thin(const LayerShape& shape) const {
        return std::abs(shape.moments.area_mm2) <= shape.perimeter_mm * pixel_mm_;
    }

    double pixel_mm_;
    Point2 moved_;
};

std::string place_of(const Layer& plane) {
    return fmt::format("layer {} at z = {:.6g} mm", plane.index, plane.z);
}

void add_findings(std::span<const LayerShape> images, std::span<const LayerShape> sections,
                  std::span<const Layer> planes, const ShapeComparison& comparison, ImageAgreement& result) {
    for (std::size_t i = 0; i < images.size(); ++i) {
        const double area = images[i].moments.area_mm2;
        const double of_mesh = sections[i].moments.area_mm2;
        if (!comparison.areas_agree(images[i], sections[i]))
            result.findings.note(FindingKind::other_areas, [&] {
                return fmt::format("{}: {:.7g} mm2 instead of {:.7g} mm2, {:.6g} mm2 off",
                                   place_of(planes[i]), area, of_mesh, std::abs(area - of_mesh));
            });
        else if (!comparison.places_agree(images[i], sections[i]))
            result.findings.note(FindingKind::displaced_layers, [&] {
                return fmt::format("{}: it is off by more than pixels explain", place_of(planes[i]));
            });
    }
}

} // namespace

LayerShape shape_of(const Layer& layer) {
    LayerShape shape{.moments = area_moments(layer, {}), .perimeter_mm = measure(layer).perimeter_mm};
    if (!layer.points.empty())
        shape.box = box_of(layer.points.span());
    return shape;
}

ImageAgreement compare_images(std::span<const LayerShape> images, std::span<const LayerShape> sections,
                              std::span<const Layer> planes, const PixelGrid& grid) {
    const double pixel_mm = std::max(1 / std::hypot(grid.ux, grid.uy), 1 / std::hypot(grid.vx, grid.vy));
    const Point2 middle = middle_of(images);
    ImageAgreement result;
    for (std::size_t i = 0; i < images.size(); ++i)
        result.max_area_error_mm2 = std::max(
            result.max_area_error_mm2, std::abs(images[i].moments.area_mm2 - sections[i].moments.area_mm2));
    for (const Mirroring& by : mirrorings) {
        std::vector<LayerShape> shapes(sections.size());
        std::transform(sections.begin(), sections.end(), shapes.begin(),
                       [&](const LayerShape& shape) { return mirrored(shape, by); });
        const Point2 other = middle_of(shapes);
        const Point2 moved{middle.x - other.x, middle.y - other.y};
        const ShapeComparison comparison(pixel_mm, moved);
        std::size_t displaced = 0;
        for (std::size_t i = 0; i < images.size(); ++i)
            displaced += comparison.places_agree(images[i], shapes[i]) ? 0 : 1;
        if (displaced > 0)
            continue;
        if (by.name[0] != '\0')
            result.findings.note(FindingKind::mirrored_images, [&] { return std::string(by.name); });
        add_findings(images, shapes, planes, comparison, result);
        if (std::abs(moved.x) > pixel_mm || std::abs(moved.y) > pixel_mm)
            result.findings.note(FindingKind::moved_images,
                                 [&] { return fmt::format("({:.4g}, {:.4g})", moved.x, moved.y); });
        return result;
    }
    const Point2 other = middle_of(sections);
    add_findings(images, sections, planes,
                 ShapeComparison(pixel_mm, {middle.x - other.x, middle.y - other.y}), result);
    return result;
}

} // namespace lamella
