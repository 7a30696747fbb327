#include "lamella/contour/measure.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/nesting.hpp"

#include "container/json_text.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"
#include "fixtures/sample_layers.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace lamella::geojson_cases {
namespace {

using Line = std::vector<Point2>;

struct Feature {
    std::string type;
    std::string label;
    double layer = -1;
    double z = -1;
    double part = -1;
    std::vector<std::vector<Line>> polygons;
    std::vector<Line> lines;
};

Line read_line(JsonText& text) {
    Line line;
    text.array([&] {
        Point2 p;
        int axis = 0;
        text.array([&] { (axis++ == 0 ? p.x : p.y) = text.number(); });
        EXPECT_EQ(axis, 2);
        line.push_back(p);
    });
    return line;
}

std::vector<Feature> read_features(const std::string& bytes) {
    std::vector<Feature> features;
    JsonText text(bytes, "x");
    const auto read_geometry = [&](Feature& feature) {
        text.object([&](const std::string& key) {
            if (key == "type") {
                feature.type = text.string();
            } else if (feature.type == "MultiPolygon") {
                text.array([&] {
                    std::vector<Line>& polygon = feature.polygons.emplace_back();
                    text.array([&] { polygon.push_back(read_line(text)); });
                });
            } else {
                text.array([&] { feature.lines.push_back(read_line(text)); });
            }
        });
    };
    text.object([&](const std::string& key) {
        if (key != "features") {
            text.skip();
            return;
        }
        text.array([&] {
            Feature& feature = features.emplace_back();
            text.object([&](const std::string& member) {
                if (member == "properties")
                    text.object([&](const std::string& name) {
                        if (name == "label")
                            feature.label = text.string();
                        else if (name == "layer")
                            feature.layer = text.number();
                        else if (name == "z")
                            feature.z = text.number();
                        else if (name == "part")
                            feature.part = text.number();
                        else
                            text.skip();
                    });
                else if (member == "geometry")
                    read_geometry(feature);
                else
                    text.skip();
            });
        });
    });
    text.end();
    return features;
}

std::string written(const LayerStack& layers) {
    const TemporaryFolder folder;
    write_layers(folder.file("x.geojson"), layer_format("geojson", ""), test::planes_of(layers),
                 info_of(layers));
    return file_bytes(folder.file("x.geojson"));
}

double area_of(Line ring) {
    ring.pop_back(); // the first point once more
    return ring_area(ring);
}

double area_of(const std::vector<std::vector<Line>>& polygons) {
    double area = 0;
    for (const std::vector<Line>& polygon : polygons)
        for (const Line& ring : polygon)
            area += area_of(ring);
    return area;
}

TEST(GeoJson, UnitesBodiesThatShareAnEdge) {
    const Layer layer = test::normal_layer({test::rectangle(0, 0, 5, 9), test::rectangle(5, 2, 9, 7)});
    const std::vector<Feature> features = read_features(written({layer}));
    ASSERT_EQ(features.size(), 1U);
    ASSERT_EQ(features.front().polygons.size(), 1U);
    EXPECT_EQ(features.front().polygons.front().size(), 1U);
    EXPECT_NEAR(area_of(features.front().polygons), 65, 1e-9);
}

TEST(GeoJson, HasAPolygonForEachBodyAndALineForWhatBoundsNone) {
    std::size_t apart = 0;
    for (std::uint64_t seed = 1; seed < 20; ++seed) {
        const LayerStack layers = random_layers(seed, 10, 40, {5, 5}, true);
        const std::vector<Feature> features = read_features(written(layers));
        std::size_t next = 0;
        for (const Layer& layer : layers) {
            const Nesting nested = nesting(layer);
            ASSERT_LT(next, features.size());
            const Feature& bodies = features[next++];
            EXPECT_EQ(bodies.type, "MultiPolygon");
            EXPECT_EQ(bodies.layer, static_cast<double>(layer.index));
            EXPECT_NEAR(bodies.z, layer.z, 1e-6);
            EXPECT_EQ(bodies.part, 1);
            for (const std::vector<Line>& polygon : bodies.polygons)
                for (std::size_t k = 0; k < polygon.size(); ++k) {
                    ASSERT_GE(polygon[k].size(), 4U);
                    EXPECT_EQ(polygon[k].front(), polygon[k].back())
                        << "the standard wants the first point at the end";
                    EXPECT_EQ(area_of(polygon[k]) > 0, k == 0) << "bodies counter-clockwise, holes clockwise";
                }
            // Bodies that overlap are united.
            const Filled material = fill(layer, FillRule::positive);
            const LayerMeasure all = measure(material.layer);
            EXPECT_NEAR(area_of(bodies.polygons), all.area_mm2, 0.001 * measure(layer).perimeter_mm) << seed;
            const std::vector<Polygon> expected = polygons(nested);
            if (!material.changed()) {
                ++apart;
                ASSERT_EQ(bodies.polygons.size(), expected.size()) << seed;
                for (std::size_t i = 0; i < expected.size(); ++i) {
                    ASSERT_EQ(bodies.polygons[i].size(), 1 + expected[i].holes.size());
                    for (std::size_t k = 0; k < bodies.polygons[i].size(); ++k) {
                        const std::uint32_t of = k == 0 ? expected[i].outer : expected[i].holes[k - 1];
                        EXPECT_NEAR(area_of(bodies.polygons[i][k]), ring_area(layer.contour(of)), 0.2)
                            << seed;
                    }
                }
            }
            std::size_t others = 0;
            for (std::size_t i = 0; i < layer.contours(); ++i)
                others += !layer.closed(i) || nested.kind[i] == RingKind::misoriented ||
                                  nested.kind[i] == RingKind::flat
                              ? 1
                              : 0;
            if (others == 0)
                continue;
            ASSERT_LT(next, features.size());
            EXPECT_EQ(features[next].type, "MultiLineString");
            EXPECT_EQ(features[next++].lines.size(), others) << seed;
        }
        EXPECT_EQ(next, features.size());
    }
    EXPECT_GT(apart, 10U);
}

TEST(GeoJson, HasLabelsAndIsValidWithoutLayers) {
    EXPECT_TRUE(read_features(written({})).empty());
    LayerStack layers = square_with_hole();
    LayerFileInfo info = info_of(layers);
    info.parts = {{.label = "a \"b\""}, {.label = "c"}};
    const TemporaryFolder folder;
    const auto writer = layer_format("geojson", "").open(folder.file("x"), info, options_for_any());
    for (const Layer& layer : layers)
        writer->prepare(Plane(std::vector<Layer>{layer, layer}))();
    writer->finish();
    const std::vector<Feature> features = read_features(file_bytes(folder.file("x")));
    ASSERT_EQ(features.size(), 4U);
    EXPECT_EQ(features[0].label, "a \"b\"");
    EXPECT_EQ(features[3].label, "c");
    EXPECT_EQ(features[3].part, 2);
}

} // namespace
} // namespace lamella::geojson_cases
