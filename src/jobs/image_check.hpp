#pragma once

// Comparison of images of layers with the sections of a mesh.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/run_image.hpp"
#include "lamella/findings/findings.hpp"

#include "contour/area_moments.hpp"
#include "contour/box2.hpp"

#include <optional>
#include <span>
#include <string>

namespace lamella {

/// The numbers of a layer that are compared.
struct LayerShape {
    AreaMoments moments = {}; ///< about (0, 0)
    double perimeter_mm = 0;
    std::optional<Box2> box = {};
};

/// Returns the shape of a layer. O(points).
[[nodiscard]] LayerShape shape_of(const Layer& layer);

/// The result of the comparison.
struct ImageAgreement {
    double max_area_error_mm2 = 0;
    Findings findings = {};
};

/// Compares the shapes of images with those of the sections of a mesh at the same heights. The part may be
/// elsewhere on the display than in the mesh, which `moved_images` reports, but at the same place in all
/// layers; and a boundary may be off by a pixel. If the shapes agree only after mirroring or rotation
/// by quarter turns, `mirrored_images` says so.
[[nodiscard]] ImageAgreement compare_images(std::span<const LayerShape> images,
                                            std::span<const LayerShape> sections,
                                            std::span<const Layer> planes, const PixelGrid& grid);

} // namespace lamella
