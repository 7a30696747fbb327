// The sheet with holes. Hole outlines are exact copies of one polygon on an integer grid that single
// precision represents exactly. So caps are triangulated with exact arithmetic, once per kind of region:
//
//     a left, a right, a bottom and a top strip, each between an edge of the sheet and the outermost
//     holes; and a cell between each four neighbouring holes, all cells equal.
//
// Their boundaries are the arcs of the holes and straight bridges between extreme points of neighbouring
// holes. All of them are monotone polygons.

#include "lamella/core/error.hpp"
#include "lamella/core/unit_circle.hpp"

#include "parts/monotone_polygon.hpp"
#include "parts/shapes.hpp"
#include "parts/shuffle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace lamella {

namespace {

/// Diameter of a hole relative to its grid cell.
constexpr double hole_width = 0.7;

/// A hole about its centre: counter-clockwise, strictly convex, no two corners with the same x or y.
struct Hole {
    std::vector<NamedPoint> corners; ///< id is the index of the corner
    std::uint32_t right = 0;         ///< index of the corner with the largest x, and so on
    std::uint32_t top = 0;
    std::uint32_t left = 0;
    std::uint32_t bottom = 0;
};

Hole make_hole(double radius_in_units, unsigned segments) {
    Hole hole;
    hole.corners.resize(segments);
    for (unsigned i = 0; i < segments; ++i) {
        // Corners are an eighth of a segment off the axes, so no two corners share an x or a y for any number
        // of segments, and each side has exactly one extreme corner.
        const CosSin at = cos_sin_turn(8 * std::uint64_t{i} + 1, 8 * std::uint64_t{segments});
        hole.corners[i] = {std::llround(radius_in_units * at.cos), std::llround(radius_in_units * at.sin), i};
    }
    const auto& c = hole.corners;
    const auto x_order = [](const NamedPoint& a, const NamedPoint& b) {
        return a.x < b.x;
    };
    const auto y_order = [](const NamedPoint& a, const NamedPoint& b) {
        return a.y < b.y;
    };
    hole.left = std::min_element(c.begin(), c.end(), x_order)->id;
    hole.right = std::max_element(c.begin(), c.end(), x_order)->id;
    hole.bottom = std::min_element(c.begin(), c.end(), y_order)->id;
    hole.top = std::max_element(c.begin(), c.end(), y_order)->id;

    const auto distinct = [](std::vector<NamedPoint> points, auto order) {
        std::sort(points.begin(), points.end(), order);
        return std::adjacent_find(points.begin(), points.end(),
                                  [&](const auto& a, const auto& b) { return !order(a, b); }) == points.end();
    };
    bool good = distinct(c, x_order) && distinct(c, y_order);
    for (unsigned i = 0; i < segments && good; ++i) {
        const NamedPoint& p = c[i];
        const NamedPoint& q = c[(i + 1) % segments];
        const NamedPoint& r = c[(i + 2) % segments];
        good = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x) > 0;
    }
    if (!good)
        throw Error(
            ErrorKind::usage,
            fmt::format("cannot make holes of {} segments: their corners are too close together for the "
                        "single precision of STL; use fewer segments or fewer holes",
                        segments));
    return hole;
}

class SheetMaker {
  public:
    SheetMaker(unsigned side, unsigned segments, double size_mm, double thickness_mm)
        : side_(side), segments_(segments), thickness_(static_cast<float>(thickness_mm)) {
        int exponent = 0;
        std::frexp(size_mm, &exponent);
        // Coordinates are integers below 2^24: exact in single precision.
        unit_exponent_ = exponent - 24;
        edge_ = std::llround(std::ldexp(size_mm, -unit_exponent_));
        const std::int64_t pitch = edge_ / side; // an integer, so that all cells are exact copies
        const std::int64_t margin = (edge_ - pitch * (side - 1)) / 2;
        hole_ = make_hole(static_cast<double>(pitch) * (hole_width / 2), segments);
        corners_.reserve(holes() * segments + 4);
        const auto add = [&](std::int64_t x, std::int64_t y) {
            corners_.push_back({x, y, static_cast<std::uint32_t>(corners_.size())});
        };
        for (unsigned row = 0; row < side; ++row)
            for (unsigned column = 0; column < side; ++column)
                for (const NamedPoint& p : hole_.corners)
                    add(margin + pitch * column + p.x, margin + pitch * row + p.y);
        add(0, 0);
        add(edge_, 0);
        add(edge_, edge_);
        add(0, edge_);
    }

    /// Returns the lower (or upper) triangle of each wall quad, hole by hole; the outer walls last.
    [[nodiscard]] std::vector<Triangle3f> walls(bool upper) const {
        std::vector<Triangle3f> out;
        out.reserve(holes() * segments_ + 4);
        for (std::size_t hole = 0; hole < holes(); ++hole)
            for (unsigned s = 0; s < segments_; ++s) {
                const std::uint32_t a = corner(hole, s);
                const std::uint32_t b = corner(hole, s + 1 == segments_ ? 0 : s + 1);
                out.push_back(wall(a, b, upper));
            }
        for (unsigned i = 0; i < 4; ++i)
            out.push_back(wall(outer((i + 1) % 4), outer(i), upper));
        return out;
    }

    /// Returns the triangles of the top, as ids of corners.
    [[nodiscard]] std::vector<std::array<std::uint32_t, 3>> cap() const;

    [[nodiscard]] Triangle3f triangle(const std::array<std::uint32_t, 3>& ids, bool top) const {
        const float z = top ? thickness_ : 0.0F;
        const Point3f a = point(ids[0], z);
        const Point3f b = point(ids[1], z);
        const Point3f c = point(ids[2], z);
        return top ? Triangle3f{a, b, c} : Triangle3f{a, c, b};
    }

  private:
    [[nodiscard]] std::size_t holes() const { return std::size_t{side_} * side_; }
    [[nodiscard]] std::uint32_t corner(std::size_t hole, unsigned s) const {
        return static_cast<std::uint32_t>(hole * segments_ + s);
    }
    [[nodiscard]] std::uint32_t outer(unsigned i) const {
        return static_cast<std::uint32_t>(holes() * segments_ + i);
    }

    [[nodiscard]] const NamedPoint& at(std::uint32_t id) const { return corners_[id]; }
    [[nodiscard]] Point3f point(std::uint32_t id, float z) const {
        const NamedPoint& p = at(id);
        return {std::ldexp(static_cast<float>(p.x), unit_exponent_),
                std::ldexp(static_cast<float>(p.y), unit_exponent_), z};
    }

    /// Makes a triangle of a wall; material lies to the right of a -> b, seen from above.
    [[nodiscard]] Triangle3f wall(std::uint32_t a, std::uint32_t b, bool upper) const {
        if (upper)
            return {point(a, thickness_), point(b, thickness_), point(b, 0)};
        return {point(a, thickness_), point(b, 0), point(a, 0)};
    }

    /// Appends the corners of a hole from one to another, in counter-clockwise (step 1) or clockwise (step
    /// -1) order.
    void arc(std::vector<NamedPoint>& chain, std::size_t hole, std::uint32_t from, std::uint32_t to,
             int step) const {
        for (std::uint32_t s = from;; s = static_cast<std::uint32_t>((s + segments_ + step) % segments_)) {
            chain.push_back(at(corner(hole, s)));
            if (s == to)
                return;
        }
    }

    unsigned side_;
    unsigned segments_;
    float thickness_;
    int unit_exponent_ = 0;
    std::int64_t edge_ = 0;
    Hole hole_;
    std::vector<NamedPoint>
        corners_; ///< of hole 0, of hole 1, ..., then the four of the sheet, counter-clockwise
};

using Ids = std::vector<std::array<std::uint32_t, 3>>;

/// Rotates by 90 degrees clockwise: a chain that was monotone upwards becomes monotone to the right.
std::vector<NamedPoint> lying(std::vector<NamedPoint> chain) {
    for (NamedPoint& p : chain)
        p = {p.y, -p.x, p.id};
    return chain;
}

Ids SheetMaker::cap() const {
    Ids out;
    out.reserve(holes() * (segments_ + 2) + 2);
    const auto add = [&](const Ids& ids) {
        out.insert(out.end(), ids.begin(), ids.end());
    };
    const auto hole_at = [&](unsigned column, unsigned row) {
        return std::size_t{row} * side_ + column;
    };
    const unsigned last = side_ - 1;
    const std::array corners{at(outer(0)), at(outer(1)), at(outer(2)), at(outer(3))};

    std::vector<NamedPoint> bottom{corners[0]};
    std::vector<NamedPoint> top{corners[3]};
    std::vector<NamedPoint> left{corners[0]};
    std::vector<NamedPoint> right{corners[1]};
    for (unsigned i = 0; i < side_; ++i) {
        arc(bottom, hole_at(i, 0), i == 0 ? hole_.bottom : hole_.left, i == last ? hole_.bottom : hole_.right,
            1);
        arc(top, hole_at(i, last), i == 0 ? hole_.top : hole_.left, i == last ? hole_.top : hole_.right, -1);
        arc(left, hole_at(0, i), hole_.bottom, hole_.top, -1);
        arc(right, hole_at(last, i), hole_.bottom, hole_.top, 1);
    }
    bottom.push_back(corners[1]);
    top.push_back(corners[2]);
    left.push_back(corners[3]);
    right.push_back(corners[2]);
    add(triangulate_monotone(std::array{corners[0], corners[1]}, bottom));

    if (side_ > 1) {
        std::vector<NamedPoint> lower;
        std::vector<NamedPoint> upper;
        arc(lower, hole_at(0, 0), hole_.top, hole_.right, -1);
        arc(lower, hole_at(1, 0), hole_.left, hole_.top, -1);
        arc(upper, hole_at(0, 1), hole_.bottom, hole_.right, 1);
        arc(upper, hole_at(1, 1), hole_.left, hole_.bottom, 1);
        const Ids cell = triangulate_monotone(lower, upper);
        for (unsigned row = 0; row < last; ++row)
            for (unsigned column = 0; column < last; ++column) {
                const auto shift = static_cast<std::uint32_t>(hole_at(column, row) * segments_);
                for (const auto& t : cell)
                    out.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
            }
    }

    add(triangulate_monotone(lying(left), lying({corners[0], corners[3]})));
    add(triangulate_monotone(lying({corners[1], corners[2]}), lying(right)));
    add(triangulate_monotone(top, std::array{corners[3], corners[2]}));
    return out;
}

} // namespace

TriangleSoup make_sheet(const SheetShape& shape) {
    const auto side = static_cast<unsigned>(std::lround(std::sqrt(shape.holes)));
    if (shape.holes == 0 || std::uint64_t{side} * side != shape.holes)
        throw Error(ErrorKind::usage,
                    fmt::format("cannot make a sheet with {} holes: expected a square number, "
                                "such as 100 or 1225",
                                shape.holes));
    const bool hundred = shape.holes == 100;
    const unsigned segments = shape.segments != 0 ? shape.segments : (hundred ? 256 : 512);
    const double size = shape.size_mm != 0 ? shape.size_mm : (hundred ? 256 : 250);
    if (segments < 3)
        throw Error(ErrorKind::usage,
                    fmt::format("cannot make holes of {} segments: expected at least 3", segments));
    const auto length = [](const char* what, double mm) {
        if (!(mm >= 1e-6 && mm <= 1e9))
            throw Error(ErrorKind::usage,
                        fmt::format("cannot make a sheet with {} {} mm: expected 1e-6 to 1e9", what, mm));
    };
    length("edges of", size);
    length("a thickness of", shape.thickness_mm);
    if (std::uint64_t{shape.holes} * segments > 0x3fffffff)
        throw Error(ErrorKind::limit,
                    fmt::format("a sheet with {} holes of {} segments is too large: at most 2^30 wall quads",
                                shape.holes, segments));

    const SheetMaker maker(side, segments, size, shape.thickness_mm);
    const std::vector<Triangle3f> lower = maker.walls(false);
    const std::vector<Triangle3f> upper = maker.walls(true);
    const Ids cap = maker.cap();
    std::vector<Triangle3f> out;
    out.reserve(2 * (lower.size() + cap.size()));
    if (shape.order == TriangleOrder::split) {
        out.insert(out.end(), lower.begin(), lower.end());
        out.insert(out.end(), upper.begin(), upper.end());
    } else {
        // Alternates this many lower triangles with the upper ones of the same quads; the outer walls are
        // last.
        const std::size_t stretch = shape.order == TriangleOrder::hole ? segments : 1;
        for (std::size_t i = 0; i < lower.size(); i += stretch) {
            const auto begin = static_cast<std::ptrdiff_t>(i);
            const auto end = static_cast<std::ptrdiff_t>(std::min(i + stretch, lower.size()));
            out.insert(out.end(), lower.begin() + begin, lower.begin() + end);
            out.insert(out.end(), upper.begin() + begin, upper.begin() + end);
        }
    }
    for (const bool top : {false, true})
        for (const auto& ids : cap)
            out.push_back(maker.triangle(ids, top));
    if (shape.order == TriangleOrder::shuffle)
        shuffle(std::span(out), shape.seed);
    return TriangleSoup(std::move(out));
}

} // namespace lamella
