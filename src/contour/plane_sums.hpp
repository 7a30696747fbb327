#pragma once

// Boxes, hatch lines and largest coordinates of all planes together.

#include "lamella/contour/plane_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Adds up boxes, hatch lines and largest coordinates of parts, plane by plane.
class PlaneSums {
  public:
    explicit PlaneSums(std::size_t parts) : boxes_(parts), hatch_lines_(parts) {}

    /// Adds contours of a part within this box, whose heights do not matter.
    void add_contours(std::size_t part, const Box3& box) {
        boxes_[part].add(box);
        grow(largest_, box);
    }
    /// Adds hatch lines of a part.
    void add_hatches(std::size_t part, const Box3& box, std::uint64_t lines) {
        boxes_[part].add(box);
        grow(largest_of_hatches_, box);
        hatch_lines_[part] += lines;
    }
    /// Adds a plane, and returns its content. O(points).
    PlaneContent add(const Plane& plane) {
        PlaneContent content;
        for (std::size_t part = 0; part < boxes_.size(); ++part) {
            const Layer& layer = plane.polylines[part];
            const PointArray& hatches = plane.hatches[part];
            add_contours(part, flat_box(layer.points.span()));
            add_hatches(part, flat_box(hatches.span()), hatches.size() / 2);
            content.points += layer.points.size();
            content.hatch_lines += hatches.size() / 2;
        }
        return content;
    }
    void add(const PlaneSums& other) {
        for (std::size_t part = 0; part < boxes_.size(); ++part) {
            boxes_[part].add(other.boxes_[part]);
            hatch_lines_[part] += other.hatch_lines_[part];
        }
        largest_ = std::max(largest_, other.largest_);
        largest_of_hatches_ = std::max(largest_of_hatches_, other.largest_of_hatches_);
    }
    /// Puts the sums into a source that has its planes and as many parts.
    void put(PlaneSource& source) const {
        for (std::size_t part = 0; part < boxes_.size(); ++part) {
            Box3 box = boxes_[part];
            if (!box.empty()) {
                box.min.z = source.planes.front().bottom;
                box.max.z = source.planes.back().top;
            }
            source.parts[part].box = box;
            source.parts[part].hatch_lines = hatch_lines_[part];
        }
        source.largest_coordinate = largest_;
        source.largest_hatch_coordinate = largest_of_hatches_;
    }

    /// Returns the box of points at a height of 0.
    [[nodiscard]] static Box3 flat_box(std::span<const Point2> points) noexcept {
        Box3 box;
        for (const Point2& p : points)
            box.add(Point3{p.x + 0.0, p.y + 0.0, 0});
        return box;
    }

  private:
    static void grow(double& largest, const Box3& box) noexcept {
        if (!box.empty())
            largest = std::max({largest, std::abs(box.min.x), std::abs(box.min.y), std::abs(box.max.x),
                                std::abs(box.max.y)});
    }

    std::vector<Box3> boxes_; ///< at a height of 0
    std::vector<std::uint64_t> hatch_lines_;
    double largest_ = 0;
    double largest_of_hatches_ = 0;
};

/// Gives the source these planes, which stay in memory. The other members of the source are those of the
/// planes.
void keep_planes(PlaneSource& source, std::vector<Plane> planes);

} // namespace lamella
