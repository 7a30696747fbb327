#pragma once

// A view of the content of a plane, for writers.

#include "lamella/contour/layer.hpp"
#include "lamella/core/point.hpp"

#include <cstddef>
#include <span>

namespace lamella {

/// Layers of parts, or scan vectors of exposures, on one plane; does not own them.
struct PlaneView {
    std::span<const Layer> layers;            ///< of each part of the file
    std::span<const PointArray> hatches = {}; ///< of each part, or of none

    [[nodiscard]] std::span<const Point2> hatches_of(std::size_t part) const {
        return hatches.empty() ? std::span<const Point2>() : hatches[part].span();
    }
};

} // namespace lamella
