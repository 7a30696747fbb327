#pragma once

// Parametric test bodies: closed, oriented, with the same bytes on every machine.

#include "lamella/mesh/triangle_soup.hpp"

#include <cstdint>
#include <functional>

namespace lamella {

/// The order of a sheet's triangles, which determines the length of the lists in the paper's algorithms.
enum class TriangleOrder {
    wall,  ///< around each hole, the two triangles of each wall quad together
    hole,  ///< the lower triangles of a hole's wall, then its upper ones, hole after hole: the paper's sheets
    split, ///< all lower triangles of all walls, then all upper ones: even harder
    shuffle, ///< random, from a seed
};

/// The paper's worst case: a flat sheet with a square grid of round holes (King, Rennie, Bennett 2021, Figs.
/// 5, 12 to 15). h holes of k segments have exactly 4 h (k + 1) + 12 triangles: a constrained triangulation
/// of top and bottom without added vertices, and two triangles per wall quad.
struct SheetShape {
    unsigned holes = 100;  ///< must be a square number
    unsigned segments = 0; ///< per hole; 0 selects the paper's number: 256 for 100 holes, otherwise 512
    double size_mm = 0;    ///< edge length; 0 selects the paper's length: 256 for 100 holes, otherwise 250
    double thickness_mm = 3;
    TriangleOrder order = TriangleOrder::wall;
    std::uint64_t seed = 1; ///< for TriangleOrder::shuffle
};

/// Throws Error{usage} if the shape is impossible (holes not square, fewer than 3 segments, sizes not above
/// 0).
[[nodiscard]] TriangleSoup make_sheet(const SheetShape& shape);

/// Makes a chess rook as in the paper's Fig. 6: 31.75 x 31.75 x 53.15 mm, hollow crown with battlements,
/// 94,080 triangles (the paper's has 93,930). It stands on z = 0 around the z axis.
[[nodiscard]] TriangleSoup make_rook();

/// Makes an assembly of dodecahedra as in the paper's Fig. 10: 157.81 x 133.62 x 165.15 mm in the corner of
/// the positive octant, 2,088 triangles (the paper's has 2,074). Its 13 bodies do not touch: two nests of
/// frames within frames around a solid core, and six solid ones.
[[nodiscard]] TriangleSoup make_dodecahedra();

/// Makes a calibration plate as in the paper's Fig. 11: 165.1 x 165.1 x 25.4 mm in the corner of the positive
/// octant, 316 triangles as in the paper: round, square and blind holes, posts, fins and steps.
[[nodiscard]] TriangleSoup make_calibration();

/// Makes a head like the scan of the paper's Fig. 16: 141.61 (neck to crown) x 111.27 (front to back) x 81.29
/// mm (side to side) in the corner of the positive octant, 468,180 triangles of uneven size (the paper's has
/// 467,882). No two of them cross: every ray from inside leaves the head once.
[[nodiscard]] TriangleSoup make_head();

/// Makes a shoe sole as in the paper's Figs. 17 and 18: 324 (heel to toe) x 125 x 54 mm in the corner of the
/// positive octant, 859,996 triangles (the paper's has 862,014), one closed surface. Slanted struts that run
/// from bottom to top join two plates, the upper one shaped like a footbed. A plane crosses 24% of all
/// triangles on average, as in the paper.
[[nodiscard]] TriangleSoup make_sole();

/// A lattice of struts: a cubic grid of cells, each corner joined to its neighbours by struts of round
/// section that become thicker towards the nodes. It is one closed surface without inner walls, in the corner
/// of the positive octant. The default has 900,432 triangles. Impossible sizes throw Error{usage}.
struct LatticeShape {
    unsigned cells_x = 12;
    unsigned cells_y = 12;
    unsigned cells_z = 12;
    double cell_mm = 4.5;
    double strut_mm = 1.2; ///< diameter of a strut, smaller than the cell
    unsigned detail = 3;   ///< 16 * detail^2 triangles per strut
};
[[nodiscard]] TriangleSoup make_lattice(const LatticeShape& shape);

/// Returns the number of triangles of the lattice. Throws as make_lattice does.
[[nodiscard]] std::uint64_t lattice_triangles(const LatticeShape& shape);

/// Passes the same triangles to the sink in the same order, one layer of nodes at a time, in the memory of
/// one layer: for lattices larger than memory.
void make_lattice(const LatticeShape& shape, const std::function<void(const TriangleSoup&)>& sink);

// Small solids. They throw Error{usage} for sizes that are not positive and for segments too small for single
// precision.

/// Makes a box from the origin to (x, y, z). 12 triangles.
[[nodiscard]] TriangleSoup make_box(double x_mm, double y_mm, double z_mm);
/// Makes a sphere about the origin, a subdivided icosahedron: 20 * 4^level triangles, level 0 to 11.
[[nodiscard]] TriangleSoup make_sphere(double radius_mm, unsigned level);
/// Makes a torus about the origin with a vertical axis. 2 * ring_segments * tube_segments triangles.
[[nodiscard]] TriangleSoup make_torus(double ring_radius_mm, double tube_radius_mm, unsigned ring_segments,
                                      unsigned tube_segments);
/// Makes a vertical cylinder on z = 0 around the z axis. 4 * segments triangles.
[[nodiscard]] TriangleSoup make_cylinder(double radius_mm, double height_mm, unsigned segments);

/// Returns the same triangles in random order (the corners of each keep their order). The same seed gives the
/// same order on every machine.
[[nodiscard]] TriangleSoup shuffled(const TriangleSoup& soup, std::uint64_t seed);

} // namespace lamella
