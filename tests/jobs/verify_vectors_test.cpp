#include "lamella/inputs/read_file.hpp"
#include "lamella/slices/layer_writer.hpp"

#include "verify_vectors_fixture.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lamella::verify_vectors_cases {
namespace {

TEST_F(VerifyVectors, FindsNothingInWhatScanMakes) {
    for (const HatchPattern pattern : {HatchPattern::lines, HatchPattern::meander, HatchPattern::stripes,
                                       HatchPattern::chessboard, HatchPattern::hexagons}) {
        for (HatchRule* const rule : {&strategy_.hatch, &strategy_.upskin.hatch, &strategy_.downskin.hatch})
            rule->pattern = pattern;
        parts_ = scanned(slice(mesh_, plan_), strategy_, "block");
        for (const VectorVerification& found : {with_all(), with_strategy(), with_mesh(), with_nothing()}) {
            EXPECT_TRUE(found.ok());
            EXPECT_EQ(found.findings.texts(), std::vector<std::string>());
            EXPECT_EQ(found.layers, 10U);
            EXPECT_EQ(found.contour_vectors, 80U) << "the beam need not stop at diagonals of sides";
            EXPECT_GT(found.hatch_vectors, 1000U);
            EXPECT_EQ(found.findings.count(FindingKind::unbounded_vectors), 0U);
        }
    }
}

TEST_F(VerifyVectors, IsTheSameForAnyNumberOfThreads) {
    change_hatches("core hatch", 5, [](std::vector<Point2>& points) { points[0].x += 100; });
    const VectorVerification one = verify_vectors(file_of(parts_), {.mesh = mesh_}, {.threads = 1});
    const VectorVerification four = verify_vectors(file_of(parts_), {.mesh = mesh_}, {.threads = 4});
    EXPECT_EQ(one.findings.texts(), four.findings.texts());
    EXPECT_EQ(number(one, "outside"), number(four, "outside"));
}

TEST_F(VerifyVectors, FindsTheSameIfLayersAreNotInMemory) {
    change_hatches("core hatch", 5, [](std::vector<Point2>& points) { points[0].x += 100; });
    for (const bool numbered : {true, false}) {
        LayerFileInfo info{.layers = plan_.layers.size(), .parts = {}};
        std::vector<Plane> planes(plan_.layers.size());
        for (LayerPart& part : parts_) {
            if (!numbered)
                part.exposure->contour = 0;
            info.parts.push_back(
                {.label = part.label, .box = part_box(part.layers, part.hatches), .exposure = part.exposure});
            info.box.add(info.parts.back().box);
            for (std::size_t i = 0; i < planes.size(); ++i)
                planes[i].add(part.layers[i], part.hatches[i]);
        }
        std::string text;
        info.memory = &text;
        static_cast<void>(write_layers("a.ovf", layer_format("ovf", {}), planes, info));
        const auto bytes = std::as_bytes(std::span(text));
        const LayerFile held = read_layers(bytes, "a.ovf");
        for (const bool by_strategy : {true, false}) {
            VerifyOptions options{.mesh = mesh_, .rounding = held.rounding};
            if (by_strategy)
                options.strategy = strategy_;
            const VectorVerification expected = verify_vectors(held, options, {.threads = 1});
            EXPECT_EQ(number(expected, "outside"), 1U);
            for (const unsigned threads : {1U, 2U, 7U}) {
                const LayerFile file = read_layers(bytes, "a.ovf", {.kept = KeptPlanes::none});
                ASSERT_GT(file.plane_bytes, 0U);
                const VectorVerification found = verify_vectors(file, options, {.threads = threads});
                EXPECT_EQ(found.findings.texts(), expected.findings.texts());
                EXPECT_EQ(found.hatch_vectors, expected.hatch_vectors);
                EXPECT_EQ(found.findings.of(FindingKind::unreached_layers).amount,
                          expected.findings.of(FindingKind::unreached_layers).amount);
            }
        }
    }
}

TEST_F(VerifyVectors, FindsVectorsThatLeaveTheMaterial) {
    change_hatches("core hatch", 5, [](std::vector<Point2>& points) { points[0].x = 21; });
    for (const VectorVerification& found : {with_all(), with_strategy(), with_mesh(), with_nothing()}) {
        EXPECT_FALSE(found.ok());
        EXPECT_EQ(number(found, "outside"), 1U);
        ASSERT_FALSE(found.findings.texts().empty());
        EXPECT_NE(found.findings.texts().front().find("layer 5 (z 0.55 mm)"), std::string::npos)
            << found.findings.texts().front();
    }
}

TEST_F(VerifyVectors, FindsVectorsThatLieOutsideAsAWhole) {
    change_hatches("core hatch", 5, [](std::vector<Point2>& points) {
        for (std::size_t i = 0; i < 6; ++i)
            points[i].x += 100;
    });
    for (const VectorVerification& found : {with_all(), with_strategy(), with_mesh(), with_nothing()})
        EXPECT_EQ(number(found, "outside"), 3U);
}

TEST_F(VerifyVectors, FindsVectorsWithinHoles) {
    const Mesh hollow =
        TriangleSoup(test::joined({test::box_triangles({0, 0, 0}, {20, 10, 1}),
                                   test::flipped(test::box_triangles({5, 3, 0}, {8, 6, 1}))}));
    EXPECT_GT(number(verify_vectors(file_of(parts_), {.mesh = hollow}), "outside"), 100U);
}

TEST_F(VerifyVectors, HoldsDistancesAgainstTheStrategy) {
    change_hatches("core hatch", 4, [&](std::vector<Point2>& points) {
        points.push_back({1, 0.16}); // the border is at 0.2
        points.push_back({3, 0.16});
    });
    EXPECT_EQ(number(with_all(), "outside"), 1U);
    EXPECT_EQ(number(with_strategy(), "outside"), 1U);
    EXPECT_TRUE(with_mesh().ok());
    EXPECT_EQ(number(with_nothing(), "outside"), 0U);
}

TEST_F(VerifyVectors, ContoursHaveTheirDistance) {
    std::swap(part("core contour 1").layers[3], part("core contour 2").layers[3]);
    EXPECT_EQ(number(with_all(), "outside"), 4U);
    EXPECT_TRUE(with_mesh().ok());
    EXPECT_FALSE(with_nothing().ok()) << "the second one lies around the first one";
}

TEST_F(VerifyVectors, FindsLinesThatAreTooShort) {
    change_hatches("core hatch", 4, [](std::vector<Point2>& points) {
        points.push_back({5, 5});
        points.push_back({5.09, 5});
    });
    EXPECT_EQ(with_all().findings.count(FindingKind::short_lines), 1U);
    EXPECT_EQ(with_strategy().findings.count(FindingKind::short_lines), 1U);
    EXPECT_TRUE(with_mesh().ok());
}

TEST_F(VerifyVectors, FindsWhatIsWrongWithContours) {
    Layer& vectors = part("core contour 1").layers[2];
    const Layer other = layer_of({rectangle(1, 1, 9, 9), rectangle(2, 2, 8, 8)}, {{{2, 3}, {4, 3}}});
    vectors.points = other.points;
    vectors.offsets = other.offsets;
    vectors.rings = other.rings;
    const VectorVerification found = with_mesh();
    EXPECT_EQ(found.findings.count(FindingKind::open_contours), 1U);
    EXPECT_EQ(found.findings.count(FindingKind::misoriented_rings), 1U);
    EXPECT_FALSE(found.ok());
}

TEST_F(VerifyVectors, OfNoVectorsFails) {
    const VectorVerification nothing = verify_vectors({}, {.strategy = strategy_});
    EXPECT_FALSE(nothing.ok());
    EXPECT_EQ(nothing.findings.texts().size(), 1U);
    EXPECT_TRUE(verify_vectors({}).ok());
    for (LayerPart& part : parts_) {
        for (Layer& layer : part.layers)
            layer = {.index = layer.index, .z = layer.z, .bottom = layer.bottom, .top = layer.top};
        part.hatches.clear();
    }
    EXPECT_FALSE(with_strategy().ok());
    EXPECT_TRUE(with_strategy().findings.count(FindingKind::no_vectors) == 1);
}

TEST_F(VerifyVectors, SaysWhereNothingReportsTheMaterial) {
    std::erase_if(parts_, [](const LayerPart& part) { return part.exposure->kind == VectorKind::contour; });
    const VectorVerification found = with_nothing();
    EXPECT_TRUE(found.ok());
    EXPECT_EQ(found.findings.count(FindingKind::unbounded_vectors), found.hatch_vectors);
    EXPECT_EQ(found.findings.texts().size(), 1U);
    EXPECT_EQ(with_all().findings.count(FindingKind::unbounded_vectors), 0U);
    EXPECT_EQ(number(with_all(), "outside"), 0U);
    EXPECT_EQ(with_all().findings.count(FindingKind::unreached_layers), 10U) << "the edges";
}

TEST_F(VerifyVectors, FindsMaterialThatAMissingContourLeaves) {
    std::erase_if(parts_, [](const LayerPart& part) { return part.exposure->name() == "core contour 1"; });
    EXPECT_EQ(with_all().findings.count(FindingKind::unreached_layers), 10U);
}

TEST_F(VerifyVectors, FindsLayersThatAreMissingInTheMiddle) {
    for (LayerPart& part : parts_) {
        part.layers.erase(part.layers.begin() + 4);
        part.hatches.erase(part.hatches.begin() + 4);
    }
    const VectorVerification found = with_mesh();
    EXPECT_FALSE(found.ok());
    ASSERT_TRUE(found.heights);
    EXPECT_EQ(found.findings.count(FindingKind::layer_gaps), 1U);
    EXPECT_TRUE(with_nothing().ok());
}

TEST_F(VerifyVectors, GrantsTheRoundingOfTheFormat) {
    const auto rounded = [](const Point2& p) {
        return Point2{std::round(p.x * 100) / 100, std::round(p.y * 100) / 100};
    };
    for (LayerPart& part : parts_)
        for (PointArray& hatches : part.hatches) {
            std::vector<Point2> ends;
            for (const Point2& p : hatches)
                ends.push_back(rounded(p));
            hatches = PointArray(std::move(ends));
        }
    EXPECT_FALSE(with_all().ok());
    EXPECT_TRUE(
        verify_vectors(file_of(parts_), {.mesh = mesh_, .rounding = {.step_mm = 0.01}, .strategy = strategy_})
            .ok());
}

} // namespace
} // namespace lamella::verify_vectors_cases
