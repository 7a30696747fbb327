// A calibration plate: a square plate of nine cells with one feature each. A feature is a convex outline that
// follows a profile of levels from the top of the plate, up or down, wider or narrower. It ends with its own
// floor or lid, or passes through the plate.

#include "lamella/core/unit_circle.hpp"

#include "parts/ring.hpp"
#include "parts/shapes.hpp"

#include <array>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace lamella {

namespace {

constexpr double width = 165.1;
constexpr double plate = 6.35;
constexpr double height = 25.4;
constexpr unsigned cells = 3; ///< along each edge

using Outline = std::vector<Point2>; ///< convex, counter-clockwise

/// The outline scaled in x and y, at a height.
struct Level {
    double x;
    double y;
    double z;
};

struct Feature {
    unsigned corners; ///< corners of a regular polygon, whose circumscribed circle is scaled by the levels
    /// The first level lies on the plate; a last level on the ground makes a through hole.
    std::vector<Level> profile;
};

/// Returns the radius of the circumscribed circle of a square with this half edge.
constexpr double square(double half_edge) {
    return half_edge * std::numbers::sqrt2;
}

std::array<Feature, cells * cells> features() {
    return {{
        {12, {{18, 18, plate}, {18, 18, 0}}},                                      // round hole
        {12, {{10, 10, plate}, {10, 10, height}}},                                 // round post
        {4, {{square(12), square(12), plate}, {square(12), square(12), 0}}},       // square hole
        {4, {{square(2), square(18), plate}, {square(2), square(18), height}}},    // thick fin
        {4,                                                                        // steps
         {{square(20), square(20), plate},                                         //
          {square(20), square(20), 12.7},                                          //
          {square(14), square(14), 12.7},                                          //
          {square(14), square(14), 19.05},                                         //
          {square(8), square(8), 19.05},                                           //
          {square(8), square(8), height}}},                                        //
        {4, {{square(0.5), square(18), plate}, {square(0.5), square(18), 19.05}}}, // thin fin
        {6, {{14, 14, plate}, {14, 14, 2.54}}},                                    // blind hole
        {4, {{square(6), square(6), plate}, {square(6), square(6), 19.05}}},       // square post
        {4, {{square(16), square(16), plate}, {square(8), square(8), height}}},    // drafted post
    }};
}

class PlateMaker {
  public:
    std::vector<Triangle3f> out;

    void cell(unsigned column, unsigned row, const Feature& feature) {
        const Outline border{at(column, row), at(column + 1, row), at(column + 1, row + 1),
                             at(column, row + 1)};
        const Point2 middle{(border[0].x + border[2].x) / 2, (border[0].y + border[2].y) / 2};
        const auto outline = [&](const Level& level) {
            Outline points(feature.corners);
            for (unsigned i = 0; i < feature.corners; ++i) {
                const CosSin turn = cos_sin_turn(2 * i + 1, 2 * feature.corners);
                points[i] = {middle.x + level.x * turn.cos, middle.y + level.y * turn.sin};
            }
            return points;
        };
        const Level& first = feature.profile.front();
        const Level& last = feature.profile.back();
        around(border, outline(first), plate, true);
        for (std::size_t i = 0; i + 1 < feature.profile.size(); ++i) {
            const Level& from = feature.profile[i];
            const Level& to = feature.profile[i + 1];
            band(outline(from), from.z, outline(to), to.z);
        }
        if (last.z == 0) {
            around(border, outline(last), 0, false);
        } else {
            fan(outline(last), last.z, true);
            fan(border, 0, false);
        }
    }

    void sides() {
        for (unsigned i = 0; i < cells; ++i) {
            wall(at(i, 0), at(i + 1, 0));
            wall(at(cells, i), at(cells, i + 1));
            wall(at(i + 1, cells), at(i, cells));
            wall(at(0, i + 1), at(0, i));
        }
    }

  private:
    static Point2 at(unsigned column, unsigned row) { return {width * column / cells, width * row / cells}; }

    static Point3f single(const Point2& p, double z) {
        return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(z)};
    }

    void add(const Point2& a, const Point2& b, const Point2& c, double z, bool up) {
        out.push_back({single(a, z), single(up ? b : c, z), single(up ? c : b, z)});
    }

    void quad(const Point3f& a, const Point3f& b, const Point3f& c, const Point3f& d) {
        out.push_back({a, b, c});
        out.push_back({a, c, d});
    }

    void wall(const Point2& a, const Point2& b) {
        quad(single(a, 0), single(b, 0), single(b, plate), single(a, plate));
    }

    void around(const Outline& border, const Outline& hole, double z, bool up) {
        Outline points = border;
        points.insert(points.end(), hole.begin(), hole.end());
        for (const auto& t : triangulate_ring(border, hole))
            add(points[t[0]], points[t[1]], points[t[2]], z, up);
    }

    /// Joins two levels. The wall of a post goes up and faces outwards, that of a hole goes down and inwards.
    void band(const Outline& from, double from_z, const Outline& to, double to_z) {
        for (std::size_t i = 0; i < from.size(); ++i) {
            const std::size_t next = (i + 1) % from.size();
            quad(single(from[i], from_z), single(from[next], from_z), single(to[next], to_z),
                 single(to[i], to_z));
        }
    }

    void fan(const Outline& outline, double z, bool up) {
        for (std::size_t i = 1; i + 1 < outline.size(); ++i)
            add(outline[0], outline[i], outline[i + 1], z, up);
    }
};

} // namespace

TriangleSoup make_calibration() {
    const std::array<Feature, cells* cells> all = features();
    PlateMaker maker;
    for (unsigned i = 0; i < cells * cells; ++i)
        maker.cell(i % cells, i / cells, all[i]);
    maker.sides();
    return TriangleSoup(std::move(maker.out));
}

} // namespace lamella
