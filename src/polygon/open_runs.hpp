#pragma once

// Tests whether a subset of the sides of rings has crossings.

#include "lamella/contour/layer.hpp"
#include "lamella/polygon/crossings.hpp"

#include <utility>
#include <vector>

namespace lamella {

/// Chains of consecutive sides; only crossings between sides of these chains are found.
class OpenRuns {
  public:
    void begin(const Point2& p) {
        end();
        points_.push_back(p);
    }
    void go_on_to(const Point2& p) { points_.push_back(p); }
    [[nodiscard]] bool crossed() && {
        end();
        layer_.points = PointArray(std::move(points_));
        return has_crossings(layer_);
    }

  private:
    void end() {
        if (points_.size() > layer_.offsets.back())
            layer_.offsets.push_back(points_.size());
    }

    Layer layer_;
    std::vector<Point2> points_;
};

} // namespace lamella
