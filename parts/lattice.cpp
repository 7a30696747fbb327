// A lattice of struts along the three axes. Six tubes of equal radius meet at each node. Two of them
// intersect in the plane between their axes (|x| = |y|, and so on), so each tube starts at a curve that it
// shares with four neighbours:
//
//     distance along the axis = radius * max(|cos|, |sin|) at each angle.
//
// If the number of angles is divisible by 8, the corners of that curve are among them, and corners of
// neighbouring tubes coincide bit for bit. So the surface is closed without computing any intersection.

#include "lamella/core/error.hpp"
#include "lamella/core/unit_circle.hpp"

#include "parts/shapes.hpp"
#include "parts/single_precision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// Struts become thicker at the nodes by up to this factor: a fillet.
constexpr double fillet = 1.3;
/// Height of the bulge that closes a node without a strut, in radii.
constexpr double bulge = 1.1;

class LatticeMaker {
  public:
    explicit LatticeMaker(const LatticeShape& shape)
        : cell_(shape.cell_mm), strut_(shape.strut_mm / 2),
          node_(std::min(fillet * strut_, (strut_ + shape.cell_mm / 2) / 2)), rings_(shape.detail) {
        const unsigned n = 8 * shape.detail;
        angles_.resize(n + 1);
        for (unsigned j = 0; j <= n; ++j)
            angles_[j] = cos_sin_turn(j, n);
    }

    [[nodiscard]] double node_radius() const { return node_; }

    void strut(const std::array<unsigned, 3>& from, int axis) {
        for (unsigned k = 0; k < rings_; ++k)
            for (std::size_t j = 0; j + 1 < angles_.size(); ++j) {
                const Point3f a = on_strut(from, axis, k, j);
                const Point3f b = on_strut(from, axis, k, j + 1);
                const Point3f c = on_strut(from, axis, k + 1, j + 1);
                const Point3f d = on_strut(from, axis, k + 1, j);
                out.push_back({a, b, c});
                out.push_back({a, c, d});
            }
    }

    /// Closes a node on a side without a strut; side is 1 or -1.
    void end(const std::array<unsigned, 3>& node, int axis, int side) {
        std::array<double, 3> tip = centre(node);
        tip[axis] += side * node_ * bulge;
        for (std::size_t j = 0; j + 1 < angles_.size(); ++j) {
            const Point3f a = on_node(node, axis, side, j);
            const Point3f b = on_node(node, axis, side, j + 1);
            out.push_back(side > 0 ? Triangle3f{a, b, single(tip)} : Triangle3f{b, a, single(tip)});
        }
    }

    std::vector<Triangle3f> out;

  private:
    static Point3f single(const std::array<double, 3>& p) {
        return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
    }

    /// The lowest corner of the body's box is the origin.
    [[nodiscard]] std::array<double, 3> centre(const std::array<unsigned, 3>& node) const {
        const double margin = node_ * bulge;
        return {node[0] * cell_ + margin, node[1] * cell_ + margin, node[2] * cell_ + margin};
    }

    [[nodiscard]] double reach(std::size_t j) const {
        return node_ * std::max(std::fabs(angles_[j].cos), std::fabs(angles_[j].sin));
    }

    [[nodiscard]] Point3f around(std::array<double, 3> p, int axis, double radius, std::size_t j) const {
        p[(axis + 1) % 3] += radius * angles_[j].cos;
        p[(axis + 2) % 3] += radius * angles_[j].sin;
        return single(p);
    }

    [[nodiscard]] Point3f on_node(const std::array<unsigned, 3>& node, int axis, int side,
                                  std::size_t j) const {
        std::array<double, 3> p = centre(node);
        p[axis] += side * reach(j);
        return around(p, axis, node_, j);
    }

    [[nodiscard]] Point3f on_strut(std::array<unsigned, 3> node, int axis, unsigned ring,
                                   std::size_t j) const {
        if (ring == 0)
            return on_node(node, axis, 1, j);
        if (ring == rings_) {
            ++node[axis];
            return on_node(node, axis, -1, j);
        }
        const double t = static_cast<double>(ring) / rings_;
        const double outwards = std::fabs(2 * t - 1); // 0 at the middle, 1 at the nodes
        std::array<double, 3> p = centre(node);
        p[axis] += reach(j) + (cell_ - 2 * reach(j)) * t;
        return around(p, axis, strut_ + (node_ - strut_) * outwards * outwards, j);
    }

    double cell_;
    double strut_;
    double node_; ///< radius at the nodes
    unsigned rings_;
    std::vector<CosSin> angles_;
};

std::array<unsigned, 3> cells_of(const LatticeShape& shape) {
    return {shape.cells_x, shape.cells_y, shape.cells_z};
}

void check(const LatticeShape& shape) {
    const std::array<unsigned, 3> cells = cells_of(shape);
    if (*std::min_element(cells.begin(), cells.end()) == 0)
        throw Error(ErrorKind::usage,
                    fmt::format("cannot make a lattice of {} x {} x {} cells: expected at least one each way",
                                cells[0], cells[1], cells[2]));
    if (!(shape.strut_mm > 0 && shape.strut_mm < shape.cell_mm && shape.cell_mm < 1e9))
        throw Error(
            ErrorKind::usage,
            fmt::format("cannot make a lattice of {} mm struts in {} mm cells: expected struts thicker "
                        "than 0 and thinner than the cell",
                        shape.strut_mm, shape.cell_mm));
    if (shape.detail == 0 || shape.detail > 256)
        throw Error(ErrorKind::usage,
                    fmt::format("cannot make a lattice of detail {}: expected 1 to 256", shape.detail));
    const double per_strut = 16.0 * shape.detail * shape.detail;
    const double struts = 3.0 * (cells[0] + 1.0) * (cells[1] + 1.0) * (cells[2] + 1.0);
    if (per_strut * struts > 4e9)
        throw Error(ErrorKind::limit, "cannot make a lattice of more than 4e9 triangles: use fewer cells or "
                                      "less detail");
    const double extent = shape.cell_mm * (*std::max_element(cells.begin(), cells.end()) + 1.0);
    if (!resolvable(shape.strut_mm / 2 * 2 * std::numbers::pi / (8 * shape.detail), extent))
        throw Error(
            ErrorKind::usage,
            fmt::format("cannot make a lattice of {} mm struts on {} mm: single precision cannot tell "
                        "their corners apart",
                        shape.strut_mm, extent));
}

/// Makes the nodes in one plane perpendicular to the z axis, and the struts that begin there.
void make_level(LatticeMaker& maker, const std::array<unsigned, 3>& cells, unsigned level) {
    std::array<unsigned, 3> node{0, 0, level};
    for (node[1] = 0; node[1] <= cells[1]; ++node[1])
        for (node[0] = 0; node[0] <= cells[0]; ++node[0])
            for (int axis = 0; axis < 3; ++axis) {
                if (node[axis] == 0)
                    maker.end(node, axis, -1);
                if (node[axis] == cells[axis])
                    maker.end(node, axis, 1);
                else
                    maker.strut(node, axis);
            }
}

} // namespace

std::uint64_t lattice_triangles(const LatticeShape& shape) {
    check(shape);
    const std::array<unsigned, 3> cells = cells_of(shape);
    const std::uint64_t per_end = 8 * std::uint64_t{shape.detail};
    const std::uint64_t per_strut = 2 * per_end * shape.detail;
    std::uint64_t triangles = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::uint64_t lines =
            (cells[(axis + 1) % 3] + std::uint64_t{1}) * (cells[(axis + 2) % 3] + std::uint64_t{1});
        triangles += lines * (cells[axis] * per_strut + 2 * per_end);
    }
    return triangles;
}

TriangleSoup make_lattice(const LatticeShape& shape) {
    const std::uint64_t triangles = lattice_triangles(shape); // checks the shape
    LatticeMaker maker(shape);
    maker.out.reserve(triangles);
    for (unsigned level = 0; level <= shape.cells_z; ++level)
        make_level(maker, cells_of(shape), level);
    return TriangleSoup(std::move(maker.out));
}

void make_lattice(const LatticeShape& shape, const std::function<void(const TriangleSoup&)>& sink) {
    check(shape);
    LatticeMaker maker(shape);
    for (unsigned level = 0; level <= shape.cells_z; ++level) {
        make_level(maker, cells_of(shape), level);
        sink(TriangleSoup(std::exchange(maker.out, {})));
    }
}

} // namespace lamella
