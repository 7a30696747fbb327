// The bits of the layers of every body, written down: those that each processor must give.

#include "lamella/contour/stack_hash.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/slicing/slice.hpp"

#include "fixtures/layer_checks.hpp"
#include "parts/shapes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace lamella::pinned_layers_cases {
namespace {

/// A row of the table tests/fixtures/layer_hashes.tsv, which the tests of the program, of the Python package
/// and of the npm package read, too.
struct Row {
    std::string mesh;
    std::string options;
    std::string rotated;
    double height_mm = 0;
    std::size_t layers = 0;
    std::string hash;
};

std::vector<Row> rows_of(const std::string& mesh) {
    std::ifstream table(LAMELLA_LAYER_HASHES);
    std::vector<Row> rows;
    for (std::string line; std::getline(table, line);) {
        std::istringstream fields(line);
        Row row;
        std::string height;
        std::string layers;
        for (std::string* field : {&row.mesh, &row.options, &row.rotated, &height, &layers, &row.hash})
            std::getline(fields, *field, '\t');
        if (row.mesh != mesh)
            continue;
        row.height_mm = std::stod(height);
        row.layers = std::stoul(layers);
        rows.push_back(row);
    }
    return rows;
}

using Body = std::pair<const std::string, std::function<TriangleSoup()>>;

/// The bodies of `lamella make`, with the options of the table.
const std::map<std::string, std::function<TriangleSoup()>> bodies{
    {"sheet",
     [] {
         return make_sheet({});
     }},
    {"rook", make_rook},
    {"dodecahedra", make_dodecahedra},
    {"calibration", make_calibration},
    {"head", make_head},
    {"sole", make_sole},
    {"lattice",
     [] {
         return make_lattice({.cells_x = 6, .cells_y = 6, .cells_z = 6});
     }},
    {"box",
     [] {
         return make_box(4, 3, 2);
     }},
    {"sphere",
     [] {
         return make_sphere(10, 5);
     }},
    {"torus",
     [] {
         return make_torus(15, 5, 128, 64);
     }},
    {"cylinder",
     [] {
         return make_cylinder(10, 20, 128);
     }},
};

class PinnedLayers : public testing::TestWithParam<Body> {};

TEST_P(PinnedLayers, HaveTheseBitsOnEveryProcessor) {
    const TriangleSoup made = GetParam().second();
    const std::vector<Row> rows = rows_of(GetParam().first);
    ASSERT_EQ(rows.size(), 2U);
    for (const Row& row : rows) {
        SCOPED_TRACE(row.rotated);
        const TriangleSoup mesh =
            row.rotated == "0,0,0" ? made : made.transformed(compose(rotation('y', 40), rotation('x', 25)));
        const Box3 box = bounding_box(mesh);
        const LayerStack stack =
            slice(mesh, plan_uniform(box.min.z, box.max.z, {.layer_height = row.height_mm}));
        EXPECT_EQ(stack.size(), row.layers);
        EXPECT_EQ(fmt::format("{:016x}", stack_hash(test::hashes(stack))), row.hash);
    }
}

INSTANTIATE_TEST_SUITE_P(Bodies, PinnedLayers, testing::ValuesIn(bodies.begin(), bodies.end()),
                         [](const auto& body) { return body.param.first; });

} // namespace
} // namespace lamella::pinned_layers_cases
