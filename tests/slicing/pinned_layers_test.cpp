// The bits of the layers of every body, written down: those that each processor must give.

#include "lamella/contour/measure.hpp"
#include "lamella/contour/stack_hash.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/slicing/slice.hpp"

#include "fixtures/layer_checks.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <ios>
#include <ostream>
#include <string>

namespace lamella::pinned_layers_cases {
namespace {

/// Of a stack: the hash and the area.
struct Bits {
    std::uint64_t hash;
    double area_mm2;

    friend bool operator==(const Bits&, const Bits&) = default;
    friend std::ostream& operator<<(std::ostream& out, const Bits& bits) {
        return out << "{0x" << std::hex << bits.hash << ", " << std::hexfloat << bits.area_mm2 << "}";
    }
};

struct Body {
    const char* name;
    TriangleSoup (*make)();
    Bits as_made;
    Bits tilted; ///< nothing is level or upright, so the bits of a cut point depend on every step of its
                 ///< formula

    friend std::ostream& operator<<(std::ostream& out, const Body& body) { return out << body.name; }
};

TriangleSoup sheet() {
    return make_sheet({});
}

TriangleSoup lattice() {
    return make_lattice({.cells_x = 6, .cells_y = 6, .cells_z = 6});
}

TriangleSoup box() {
    return make_box(4, 3, 2);
}

TriangleSoup sphere() {
    return make_sphere(10, 5);
}

TriangleSoup torus() {
    return make_torus(10, 3, 240, 80);
}

TriangleSoup cylinder() {
    return make_cylinder(10, 20, 128);
}

const Body bodies[]{
    {"sheet", sheet, {0xa8ad03b2ba61362b, 0x1.89b969d2877p+19}, {0xd6743fcc4899702f, 0x1.3396917db0dbfp+13}},
    {"rook",
     make_rook,
     {0xe5e6d544948b4643, 0x1.bc5fe8512759ap+12},
     {0x764f7e8b810add68, 0x1.a17e04f523639p+12}},
    {"dodecahedra",
     make_dodecahedra,
     {0x1240ea1a19c19e68, 0x1.4f9774a1977b1p+15},
     {0x2820337700a39bfc, 0x1.0e01124f3c9ccp+15}},
    {"calibration",
     make_calibration,
     {0xc650debdd94f2418, 0x1.33e47c1cc10bbp+17},
     {0x54d8c204906825db, 0x1.7d6f3d47316fdp+14}},
    {"head",
     make_head,
     {0x7e2a14baf4d848b5, 0x1.e580c04b8b20ep+16},
     {0x7f6a1b7fd876fcdd, 0x1.47db2473d1f1dp+16}},
    {"sole",
     make_sole,
     {0xfe0cff53f105c98a, 0x1.cf5d2babb873bp+16},
     {0x32b67330496166ac, 0x1.95187b6fdef15p+14}},
    {"lattice",
     lattice,
     {0x9d2d24c3f2160bca, 0x1.a0fc1ab8fa51dp+11},
     {0xe58f1af52d672cff, 0x1.ffe88234da9c7p+10}},
    {"box", box, {0x2fa1449ad4856c12, 0x1.ep+7}, {0x70497d8ea5b2421b, 0x1.855ceb42f82d4p+6}},
    {"sphere",
     sphere,
     {0x1f806d47a169dbd1, 0x1.05fb80b8bb0d7p+12},
     {0xe508a243a5d9461d, 0x1.0607cc675a3ebp+12}},
    {"torus", torus, {0xec7b52e78c684716, 0x1.731cf7ad625bp+12}, {0x9bdff56c19c75817, 0x1.b479260f3cca3p+10}},
    {"cylinder",
     cylinder,
     {0xbd9e97e1eedfd295, 0x1.888a986d431d8p+12},
     {0x49d908f4255586d4, 0x1.15a2595094f51p+12}},
};

Bits bits_of(const TriangleSoup& mesh) {
    constexpr double layers = 20;
    const Box3 box = bounding_box(mesh);
    const LayerStack stack =
        slice(mesh, plan_uniform(box.min.z, box.max.z, {.layer_height = (box.max.z - box.min.z) / layers}));
    double area_mm2 = 0;
    for (const Layer& layer : stack)
        area_mm2 += measure(layer).area_mm2;
    return {stack_hash(test::hashes(stack)), area_mm2};
}

class PinnedLayers : public testing::TestWithParam<Body> {};

TEST_P(PinnedLayers, HaveTheseBitsOnEveryProcessor) {
    const TriangleSoup mesh = GetParam().make();
    EXPECT_EQ(bits_of(mesh), GetParam().as_made);
    EXPECT_EQ(bits_of(mesh.transformed(compose(rotation('y', 40), rotation('x', 25)))), GetParam().tilted);
}

INSTANTIATE_TEST_SUITE_P(Bodies, PinnedLayers, testing::ValuesIn(bodies),
                         [](const auto& body) { return std::string(body.param.name); });

} // namespace
} // namespace lamella::pinned_layers_cases
