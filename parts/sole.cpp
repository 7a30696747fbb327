// A shoe sole of two plates with slanted struts between them.
//
// A square grid is bent into the outline of a foot, the same for both plates. Each of its cells contains the
// end of at most one strut, a circle that fits into the cell. The rest of the cell around it is triangulated,
// so plates and struts form one surface. A strut starts in a cell of the lower plate and ends in another cell
// of the same row of the upper one. Struts of a row are parallel, those of the next row lean in the opposite
// direction: they cross when seen from the side, but each stays within its row.
//
// A strut has no corners between its ends: its triangles run from bottom to top, which makes such parts hard
// to slice.

#include "lamella/core/unit_circle.hpp"

#include "parts/ring.hpp"
#include "parts/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace lamella {

namespace {

constexpr Point3 size{324, 125, 54};
constexpr double plate_thickness = 2;  ///< thickness
constexpr unsigned columns = 133;      ///< heel to toe
constexpr unsigned rows = 50;          ///< side to side
constexpr unsigned lean = 5;           ///< columns from the lower end of a strut to its upper end
constexpr unsigned strut_corners = 32; ///< number of corners of a strut's section
/// Radius of a strut relative to the distance from its axis to the borders of its cells.
constexpr double strut_share = 0.62;
constexpr double thinnest = 0.25; ///< radius below which a strut is omitted

/// Evaluates a Bernstein polynomial for t from 0 to 1.
double curve(std::array<double, 5> control, double t) {
    for (std::size_t n = control.size() - 1; n > 0; --n)
        for (std::size_t i = 0; i < n; ++i)
            control[i] += t * (control[i + 1] - control[i]);
    return control[0];
}

/// The outline from heel (0) to toe (1): y of its middle, and its half width.
double middle(double t) {
    return curve({0, -0.10, -0.06, 0.32, 0.12}, t);
}
double reach(double t) {
    return curve({0.74, 0.80, 0.24, 1.26, 0.80}, t);
}

/// Maps a point of the square from (-1, -1) to (1, 1) into the outline.
Point2 bent(double u, double v) {
    // With 0.5 the square would become a disc and its corners flat; with less, they remain corners.
    constexpr double roundness = 0.48;
    const double t = (1 + u * std::sqrt(1 - roundness * v * v)) / 2;
    return {t, middle(t) + reach(t) * v * std::sqrt(1 - roundness * u * u)};
}

/// Height of the underside: flat, but rising slightly at the heel and more at the toe.
double underside(const Point2& p) {
    const double heel = std::max(0.15 - p.x, 0.0) / 0.15;
    const double toe = std::max(p.x - 0.65, 0.0) / 0.35;
    return 3 * heel * heel + 9 * toe * toe;
}

/// Height of the footbed: high at the heel, with a rim all around and a support for the arch.
double footbed(const Point2& p) {
    const double side = (p.y - middle(p.x)) / reach(p.x);
    const double along = 2 * p.x - 1;
    const double edge = side * side + along * along * along * along; // about 1 at the outline
    const double arch = side > 0 ? side * side * curve({0, 2, 14, 0, 0}, p.x) : 0;
    return curve({38, 37, 29, 22, 24}, p.x) + edge * edge * curve({14, 12, 6, 2, 3}, p.x) + arch;
}

/// Returns the distance of p from the border of the convex quad, positive inside.
double inset(const std::array<Point2, 4>& quad, const Point2& p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 4; ++k) {
        const Point2& a = quad[k];
        const Point2& b = quad[(k + 1) % 4];
        const Point2 edge{b.x - a.x, b.y - a.y};
        least = std::min(least, (edge.x * (p.y - a.y) - edge.y * (p.x - a.x)) /
                                    std::sqrt(edge.x * edge.x + edge.y * edge.y));
    }
    return least;
}

class SoleMaker {
  public:
    SoleMaker() {
        std::vector<Point2> outline;
        outline.reserve(std::size_t{columns + 1} * (rows + 1));
        Box3 box;
        for (unsigned j = 0; j <= rows; ++j)
            for (unsigned i = 0; i <= columns; ++i) {
                const Point2 p = bent(2.0 * i / columns - 1, 2.0 * j / rows - 1);
                outline.push_back(p);
                box.add(Point3{p.x, p.y, underside(p)});
                box.add(Point3{p.x, p.y, footbed(p)});
            }
        low_ = box.min;
        stretch_ = {size.x / (box.max.x - box.min.x), size.y / (box.max.y - box.min.y),
                    size.z / (box.max.z - box.min.z)};
        for (const Point2& p : outline)
            grid_.push_back({(p.x - low_.x) * stretch_.x, (p.y - low_.y) * stretch_.y});
    }

    std::vector<Triangle3f> make() {
        std::vector<bool> lower_used(std::size_t{columns} * rows);
        std::vector<bool> upper_used(lower_used.size());
        for (unsigned j = 0; j < rows; ++j)
            for (unsigned i = 0; i + lean < columns; ++i) {
                const unsigned lower = j % 2 == 0 ? i : i + lean;
                const unsigned upper = j % 2 == 0 ? i + lean : i;
                if (strut(lower, upper, j)) {
                    lower_used[j * columns + lower] = true;
                    upper_used[j * columns + upper] = true;
                }
            }
        for (unsigned j = 0; j < rows; ++j)
            for (unsigned i = 0; i < columns; ++i) {
                plain_cell(i, j, Face::underside);
                plain_cell(i, j, Face::footbed);
                if (!lower_used[j * columns + i])
                    plain_cell(i, j, Face::lower_inside);
                if (!upper_used[j * columns + i])
                    plain_cell(i, j, Face::upper_inside);
            }
        rims();
        return std::move(out_);
    }

  private:
    enum class Face { underside, lower_inside, upper_inside, footbed };

    static bool looks_up(Face face) { return face == Face::lower_inside || face == Face::footbed; }

    [[nodiscard]] const Point2& at(unsigned i, unsigned j) const { return grid_[j * (columns + 1) + i]; }

    [[nodiscard]] std::array<Point2, 4> cell(unsigned i, unsigned j) const {
        return {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
    }

    [[nodiscard]] Point3f on(Face face, const Point2& p) const {
        const Point2 q{p.x / stretch_.x + low_.x, p.y / stretch_.y + low_.y};
        const bool low = face == Face::underside || face == Face::lower_inside;
        double z = ((low ? underside(q) : footbed(q)) - low_.z) * stretch_.z;
        if (face == Face::lower_inside)
            z += plate_thickness;
        if (face == Face::upper_inside)
            z -= plate_thickness;
        return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(z)};
    }

    /// Adds three points of a face, counter-clockwise seen from above.
    void add(Face face, const Point2& a, const Point2& b, const Point2& c) {
        out_.push_back({on(face, a), on(face, looks_up(face) ? b : c), on(face, looks_up(face) ? c : b)});
    }

    void quad(const Point3f& a, const Point3f& b, const Point3f& c, const Point3f& d) {
        out_.push_back({a, b, c});
        out_.push_back({a, c, d});
    }

    void plain_cell(unsigned i, unsigned j, Face face) {
        const auto [a, b, c, d] = cell(i, j);
        // No triangle may have two edges on the outline: where it bends least, it would be a needle.
        if ((2 * i < columns) == (2 * j < rows)) {
            add(face, a, b, c);
            add(face, a, c, d);
        } else {
            add(face, a, b, d);
            add(face, b, c, d);
        }
    }

    /// Returns the radius of a strut that stays within its cells from one end to the other.
    [[nodiscard]] double radius(unsigned lower, unsigned upper, unsigned row) const {
        const Point2 from = centre(lower, row);
        const Point2 to = centre(upper, row);
        double room = std::numeric_limits<double>::infinity();
        for (unsigned k = 0; k <= lean; ++k) {
            const double t = static_cast<double>(k) / lean;
            const unsigned column = lower < upper ? lower + k : lower - k;
            room = std::min(
                room, inset(cell(column, row), {from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)}));
        }
        return strut_share * room;
    }

    [[nodiscard]] Point2 centre(unsigned i, unsigned j) const {
        Point2 sum;
        for (const Point2& p : cell(i, j))
            sum = {sum.x + p.x / 4, sum.y + p.y / 4};
        return sum;
    }

    /// Adds a strut; returns false if its cells are too narrow.
    bool strut(unsigned lower, unsigned upper, unsigned row) {
        const double r = radius(lower, upper, row);
        if (r < thinnest)
            return false;
        const std::vector<Point2> foot = end(Face::lower_inside, lower, row, r);
        const std::vector<Point2> header = end(Face::upper_inside, upper, row, r);
        for (unsigned k = 0; k < strut_corners; ++k) {
            const unsigned next = (k + 1) % strut_corners;
            quad(on(Face::lower_inside, foot[k]), on(Face::lower_inside, foot[next]),
                 on(Face::upper_inside, header[next]), on(Face::upper_inside, header[k]));
        }
        return true;
    }

    /// Returns the circle in which a strut meets a face, and adds the face around it.
    std::vector<Point2> end(Face face, unsigned column, unsigned row, double r) {
        const std::array<Point2, 4> border = cell(column, row);
        const Point2 middle = centre(column, row);
        std::vector<Point2> circle(strut_corners);
        for (unsigned k = 0; k < strut_corners; ++k) {
            const CosSin turn = cos_sin_turn(2 * k + 1, 2 * strut_corners);
            circle[k] = {middle.x + r * turn.cos, middle.y + r * turn.sin};
        }
        const auto corner = [&](std::uint32_t i) {
            return i < border.size() ? border[i] : circle[i - border.size()];
        };
        for (const auto& t : triangulate_ring(border, circle))
            add(face, corner(t[0]), corner(t[1]), corner(t[2]));
        return circle;
    }

    void rims() {
        for (unsigned i = 0; i < columns; ++i) {
            rim(at(i, 0), at(i + 1, 0));
            rim(at(i + 1, rows), at(i, rows));
        }
        for (unsigned j = 0; j < rows; ++j) {
            rim(at(columns, j), at(columns, j + 1));
            rim(at(0, j + 1), at(0, j));
        }
    }

    void rim(const Point2& a, const Point2& b) {
        quad(on(Face::underside, a), on(Face::underside, b), on(Face::lower_inside, b),
             on(Face::lower_inside, a));
        quad(on(Face::upper_inside, a), on(Face::upper_inside, b), on(Face::footbed, b),
             on(Face::footbed, a));
    }

    Point3 low_;     ///< lowest corner of the bent grid's box
    Point3 stretch_; ///< factors to millimetres
    std::vector<Point2> grid_;
    std::vector<Triangle3f> out_;
};

} // namespace

TriangleSoup make_sole() {
    return TriangleSoup(SoleMaker().make());
}

} // namespace lamella
