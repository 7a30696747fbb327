#include "lamella/contour/measure.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/sample_layers.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace lamella::dxf_cases {
namespace {

struct Polyline {
    std::string layer;
    bool closed = false;
    std::vector<Point3> points;
};

/// Reads pairs of a group code and a value, as all programs read DXF.
std::vector<Polyline> polylines_of(const std::string& bytes) {
    std::istringstream lines(bytes);
    std::vector<std::pair<int, std::string>> groups;
    for (std::string code, value; std::getline(lines, code) && std::getline(lines, value);)
        groups.emplace_back(std::stoi(code), value);
    EXPECT_EQ(groups.back(), (std::pair<int, std::string>{0, "EOF"}));
    std::vector<Polyline> all;
    std::string entity;
    int open = 0;
    for (const auto& [code, value] : groups) {
        if (code == 0) {
            entity = value;
            if (entity == "POLYLINE") {
                all.emplace_back();
                ++open;
            }
            if (entity == "VERTEX") {
                EXPECT_EQ(open, 1);
                all.back().points.emplace_back();
            }
            if (entity == "SEQEND")
                --open;
        } else if (entity == "POLYLINE" && code == 8) {
            all.back().layer = value;
        } else if (entity == "POLYLINE" && code == 70) {
            all.back().closed = value == "1";
        } else if (entity == "VERTEX" && code == 8) {
            EXPECT_EQ(value, all.back().layer);
        } else if (entity == "VERTEX") {
            Point3& p = all.back().points.back();
            (code == 10 ? p.x : code == 20 ? p.y : p.z) = std::stod(value);
        }
    }
    EXPECT_EQ(open, 0);
    return all;
}

TEST(Dxf, HasAPolylineForEachContourAtItsHeight) {
    for (std::uint64_t seed = 1; seed < 20; ++seed) {
        const LayerStack layers = random_layers(seed, 10, 40, {5, -5}, true);
        const TemporaryFolder folder;
        write_layers(folder.file("x.dxf"), layer_format("dxf", ""), test::planes_of(layers), info_of(layers));
        const std::vector<Polyline> found = polylines_of(file_bytes(folder.file("x.dxf")));
        std::size_t next = 0;
        for (const Layer& layer : layers)
            for (std::size_t i = 0; i < layer.contours(); ++i, ++next) {
                ASSERT_LT(next, found.size());
                const Polyline& line = found[next];
                EXPECT_EQ(line.closed, layer.closed(i));
                ASSERT_EQ(line.points.size(), layer.contour(i).size()) << seed;
                std::vector<Point2> points;
                for (const Point3& p : line.points) {
                    EXPECT_NEAR(p.z, layer.z, 1e-8);
                    points.push_back({p.x, p.y});
                }
                if (line.closed) {
                    EXPECT_NEAR(ring_area(points), ring_area(layer.contour(i)), 0.2);
                }
                for (std::size_t k = 0; k < points.size() && !line.closed; ++k) {
                    EXPECT_NEAR(points[k].x, layer.contour(i)[k].x, 0.000501);
                    EXPECT_NEAR(points[k].y, layer.contour(i)[k].y, 0.000501);
                }
                EXPECT_EQ(line.layer, "LAYER_0000" + std::to_string(layer.index));
            }
        EXPECT_EQ(next, found.size());
    }
}

TEST(Dxf, NamesThePartIfThereAreSeveral) {
    const LayerStack layers = square_with_hole();
    LayerFileInfo info = info_of(layers);
    info.parts.resize(2);
    const TemporaryFolder folder;
    const auto writer = layer_format("dxf", "").open(folder.file("x"), info, options_for_any());
    for (const Layer& layer : layers)
        writer->prepare(Plane(std::vector<Layer>{layer, layer}))();
    writer->finish();
    const std::vector<Polyline> found = polylines_of(file_bytes(folder.file("x")));
    ASSERT_EQ(found.size(), 8U);
    EXPECT_EQ(found.front().layer, "PART_1_LAYER_00000");
    EXPECT_EQ(found.back().layer, "PART_2_LAYER_00001");
}

} // namespace
} // namespace lamella::dxf_cases
