#include "lamella/pipeline/verify.hpp"
#include "lamella/scan/scan.hpp"
#include "lamella/slicing/slice.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lamella {
namespace {

using test::box_mesh;
using test::layer_of;
using test::rectangle;

/// The vectors of layers, as a file has them.
std::vector<LayerPart> scanned(const LayerStack& layers, const ScanStrategy& strategy,
                               const std::string& part) {
    std::vector<LayerPart> parts;
    for (const Exposure& exposure : exposures(strategy, part))
        parts.push_back({exposure.label(), {}, exposure});
    for (std::size_t i = 0; i < layers.size(); ++i) {
        std::vector<ScanLayer> below(layers.begin(), layers.begin() + static_cast<std::ptrdiff_t>(i));
        std::reverse(below.begin(), below.end());
        const std::vector<ScanLayer> above(layers.begin() + static_cast<std::ptrdiff_t>(i) + 1, layers.end());
        ScanVectors vectors = scan(layers[i], below, above, strategy).vectors;
        for (std::size_t k = 0; k < parts.size(); ++k) {
            parts[k].layers.push_back(std::move(vectors.polylines[k]));
            parts[k].hatches.push_back(std::move(vectors.hatches[k]));
        }
    }
    return parts;
}

/// A block of 20 x 10 x 1 mm in ten layers.
class VerifyVectors : public testing::Test {
  protected:
    VerifyVectors() {
        strategy_.contours.count = 2;
        strategy_.upskin.layers = 2;
        strategy_.downskin.layers = 2;
        plan_ = plan_uniform(0, 1, {.layer_height = 0.1});
        parts_ = scanned(slice(mesh_, plan_), strategy_, "block");
    }

    /// With the mesh and the strategy, with one of them, with none.
    VectorVerification with_all() const {
        return verify_vectors(parts_, {.mesh = mesh_, .strategy = strategy_});
    }
    VectorVerification with_strategy() const { return verify_vectors(parts_, {.strategy = strategy_}); }
    VectorVerification with_mesh() const { return verify_vectors(parts_, {.mesh = mesh_}); }
    VectorVerification with_nothing() const { return verify_vectors(parts_); }

    LayerPart& part(const std::string& name) {
        for (LayerPart& part : parts_)
            if (part.exposure->name() == name)
                return part;
        throw std::out_of_range(name);
    }
    /// Changes the hatches of a layer.
    template <class Change>
    void change_hatches(const std::string& name, std::size_t layer, const Change& change) {
        PointArray& hatches = part(name).hatches[layer];
        std::vector<Point2> points(hatches.begin(), hatches.end());
        change(points);
        hatches = PointArray(std::move(points));
    }

    Mesh mesh_ = box_mesh({0, 0, 0}, {20, 10, 1});
    Plan plan_;
    ScanStrategy strategy_;
    std::vector<LayerPart> parts_;
};

TEST_F(VerifyVectors, FindsNothingInWhatScanMakes) {
    for (const HatchPattern pattern : {HatchPattern::lines, HatchPattern::meander, HatchPattern::stripes,
                                       HatchPattern::chessboard, HatchPattern::hexagons}) {
        for (HatchRule* const rule : {&strategy_.hatch, &strategy_.upskin.hatch, &strategy_.downskin.hatch})
            rule->pattern = pattern;
        parts_ = scanned(slice(mesh_, plan_), strategy_, "block");
        for (const VectorVerification& found : {with_all(), with_strategy(), with_mesh(), with_nothing()}) {
            EXPECT_TRUE(found.ok());
            EXPECT_EQ(found.findings, std::vector<std::string>());
            EXPECT_EQ(found.layers, 10U);
            EXPECT_EQ(found.contour_vectors, 80U) << "the beam need not stop at diagonals of sides";
            EXPECT_GT(found.hatch_vectors, 1000U);
            EXPECT_EQ(found.unbounded, 0U);
        }
        EXPECT_NEAR(*with_all().cover, 1, 0.15);
        EXPECT_NEAR(*with_all().cover, *with_strategy().cover, 1e-9);
        EXPECT_FALSE(with_mesh().cover);
    }
}

TEST_F(VerifyVectors, IsTheSameForAnyNumberOfThreads) {
    change_hatches("core hatch", 5, [](std::vector<Point2>& points) { points[0].x += 100; });
    const VectorVerification one = verify_vectors(parts_, {.mesh = mesh_}, {.threads = 1});
    const VectorVerification four = verify_vectors(parts_, {.mesh = mesh_}, {.threads = 4});
    EXPECT_EQ(one.findings, four.findings);
    EXPECT_EQ(one.outside, four.outside);
}

TEST_F(VerifyVectors, FindsVectorsThatLeaveTheMaterial) {
    change_hatches("core hatch", 5, [](std::vector<Point2>& points) { points[0].x = 21; });
    for (const VectorVerification& found : {with_all(), with_strategy(), with_mesh(), with_nothing()}) {
        EXPECT_FALSE(found.ok());
        EXPECT_EQ(found.outside, 1U);
        ASSERT_FALSE(found.findings.empty());
        EXPECT_NE(found.findings.front().find("layer 5 (z 0.55 mm)"), std::string::npos)
            << found.findings.front();
    }
}

TEST_F(VerifyVectors, FindsVectorsThatLieOutsideAsAWhole) {
    change_hatches("core hatch", 5, [](std::vector<Point2>& points) {
        for (std::size_t i = 0; i < 6; ++i)
            points[i].x += 100;
    });
    for (const VectorVerification& found : {with_all(), with_strategy(), with_mesh(), with_nothing()})
        EXPECT_EQ(found.outside, 3U);
}

TEST_F(VerifyVectors, FindsVectorsWithinHoles) {
    const Mesh hollow =
        TriangleSoup(test::joined({test::box_triangles({0, 0, 0}, {20, 10, 1}),
                                   test::flipped(test::box_triangles({5, 3, 0}, {8, 6, 1}))}));
    EXPECT_GT(verify_vectors(parts_, {.mesh = hollow}).outside, 100U);
}

TEST_F(VerifyVectors, HoldsDistancesAgainstTheStrategy) {
    change_hatches("core hatch", 4, [&](std::vector<Point2>& points) {
        points.push_back({1, 0.16}); // the border is at 0.2
        points.push_back({3, 0.16});
    });
    EXPECT_EQ(with_all().outside, 1U);
    EXPECT_EQ(with_strategy().outside, 1U);
    EXPECT_TRUE(with_mesh().ok());
    EXPECT_EQ(with_nothing().outside, 0U);
}

TEST_F(VerifyVectors, ContoursHaveTheirDistance) {
    std::swap(part("core contour 1").layers[3], part("core contour 2").layers[3]);
    EXPECT_EQ(with_all().outside, 4U);
    EXPECT_TRUE(with_mesh().ok());
    EXPECT_FALSE(with_nothing().ok()) << "the second one lies around the first one";
}

TEST_F(VerifyVectors, FindsLinesThatAreTooShort) {
    change_hatches("core hatch", 4, [](std::vector<Point2>& points) {
        points.push_back({5, 5});
        points.push_back({5.09, 5});
    });
    EXPECT_EQ(with_all().too_short, 1U);
    EXPECT_EQ(with_strategy().too_short, 1U);
    EXPECT_TRUE(with_mesh().ok());
}

TEST_F(VerifyVectors, FindsLinesThatAreTurnedOrLieBesideWhatTheStrategySays) {
    for (const HatchPattern pattern :
         {HatchPattern::stripes, HatchPattern::chessboard, HatchPattern::hexagons}) {
        for (HatchRule* const rule : {&strategy_.hatch, &strategy_.upskin.hatch, &strategy_.downskin.hatch})
            rule->pattern = pattern;
        const auto scanned_by = [&](double angle, double turn, double distance) {
            ScanStrategy other = strategy_;
            for (HatchRule* const rule : {&other.hatch, &other.upskin.hatch, &other.downskin.hatch}) {
                rule->angle_degrees = angle;
                rule->turn_degrees = turn;
                rule->distance = distance;
            }
            parts_ = scanned(slice(mesh_, plan_), other, "block");
            const VectorVerification found = with_all();
            EXPECT_EQ(with_strategy().misplaced, found.misplaced);
            EXPECT_EQ(found.misplaced == 0, found.ok());
            EXPECT_EQ(with_mesh().misplaced + with_nothing().misplaced, 0U);
            return found.misplaced;
        };
        EXPECT_EQ(scanned_by(0, 67, 0.1), 0U);
        EXPECT_GT(scanned_by(0.5, 67, 0.1), 1000U);
        EXPECT_GT(scanned_by(0, 66, 0.1), 1000U);
        EXPECT_GT(scanned_by(0, 67, 0.101), 1000U);
    }
}

TEST_F(VerifyVectors, FindsThatAllHatchesAreMissing) {
    std::erase_if(parts_, [](const LayerPart& part) { return part.exposure->kind == VectorKind::hatch; });
    for (const VectorVerification& found : {with_all(), with_strategy()}) {
        EXPECT_EQ(found.miscovered, 10U);
        EXPECT_EQ(found.cover, 0);
    }
    EXPECT_TRUE(with_mesh().ok());
}

TEST_F(VerifyVectors, AFileMayBeginWithAnyLayerOfItsPlan) {
    // Regions turn by themselves.
    strategy_.hatch.turn_degrees = 90;
    strategy_.upskin.hatch.turn_degrees = 33.3;
    for (const std::uint64_t first : {1U, 103U, 5000U}) {
        Plan later = plan_;
        for (PlannedLayer& layer : later.layers)
            layer.index += first;
        parts_ = scanned(slice(mesh_, later), strategy_, "block");
        for (LayerPart& part : parts_)
            for (std::size_t i = 0; i < part.layers.size(); ++i)
                part.layers[i].index = i; // as files number them
        EXPECT_TRUE(with_all().ok()) << first;
        // A layer that is not at its place is one, all others are right.
        std::swap(part("core hatch").hatches[5], part("core hatch").hatches[6]);
        EXPECT_GT(with_all().misplaced, 100U) << first;
        EXPECT_LE(with_all().misplaced,
                  (part("core hatch").hatches[5].size() + part("core hatch").hatches[6].size()) / 2)
            << first;
    }
}

TEST_F(VerifyVectors, FindsWhatIsNotFilledAndWhatIsFilledTwice) {
    const std::vector<LayerPart> sound = parts_;
    change_hatches("core hatch", 4,
                   [](std::vector<Point2>& points) { points.resize(points.size() / 2 & ~1U); });
    EXPECT_EQ(with_all().miscovered, 1U);
    EXPECT_EQ(with_strategy().miscovered, 1U);
    EXPECT_LT(*with_all().cover, 1.0);
    EXPECT_TRUE(with_mesh().ok());

    parts_ = sound;
    change_hatches("core hatch", 4, [](std::vector<Point2>& points) {
        const std::vector<Point2> again = points;
        points.insert(points.end(), again.begin(), again.end());
    });
    EXPECT_EQ(with_all().miscovered, 1U);

    parts_ = sound;
    change_hatches("upskin hatch", 9, [](std::vector<Point2>& points) { points.clear(); });
    EXPECT_EQ(with_all().miscovered, 1U) << "a skin is missing";
}

TEST_F(VerifyVectors, FindsWhatIsWrongWithContours) {
    Layer& vectors = part("core contour 1").layers[2];
    vectors = layer_of({rectangle(1, 1, 9, 9), rectangle(2, 2, 8, 8)}, {{{2, 3}, {4, 3}}});
    const VectorVerification found = with_mesh();
    EXPECT_EQ(found.open_chains, 1U);
    EXPECT_EQ(found.misoriented, 1U);
    EXPECT_FALSE(found.ok());
}

TEST_F(VerifyVectors, FindsLinesOfExposuresThatHaveNone) {
    const auto line_at = [&](std::size_t i) {
        const PointArray& lines = part("core hatch").hatches[4];
        return std::vector<Point2>{lines[2 * i], lines[2 * i + 1]};
    };
    const std::vector<Point2> line = line_at(0);
    const std::vector<Point2> amid = line_at(part("core hatch").hatches[4].size() / 4);
    const std::vector<LayerPart> sound = parts_;
    // The innermost contour has lines of what is too narrow for a hatch.
    for (const auto& [contour, points] : {std::pair{"core contour 1", line}, {"core contour 2", amid}}) {
        part(contour).hatches[4] = PointArray(points);
        EXPECT_EQ(with_all().misplaced, 1U) << contour;
        EXPECT_EQ(with_strategy().misplaced, 1U) << contour;
        parts_ = sound;
    }
    part("upskin hatch").hatches[4] = PointArray(line);
    EXPECT_EQ(with_all().misplaced, 0U);
    strategy_.upskin.layers = 0;
    EXPECT_GE(with_all().misplaced, 1U) << "no skin is asked for";
}

TEST_F(VerifyVectors, TakesContoursThatFilesDoNotNumber) {
    LayerPart both = part("core contour 1");
    for (LayerPart& part : parts_)
        part.exposure->contour = 0;
    std::swap(parts_[0], parts_[1]); // the inner one comes first
    EXPECT_TRUE(with_nothing().ok());
    EXPECT_TRUE(with_mesh().ok());
    both.layers[3] = layer_of({rectangle(1, 1, 9, 9), rectangle(2, 2, 8, 8)});
    EXPECT_EQ(verify_vectors(std::vector{both}).misoriented, 1U);
    both.exposure->contour = 0;
    EXPECT_EQ(verify_vectors(std::vector{both}).misoriented, 0U);
}

TEST_F(VerifyVectors, FindsMaterialThatNoVectorReaches) {
    mesh_ = test::box_mesh({0, 0, 0}, {20, 0.08F, 1});
    strategy_ = {};
    parts_ = scanned(slice(mesh_, plan_), strategy_, "fin");
    EXPECT_TRUE(with_all().ok());
    EXPECT_LT(with_all().unreached_mm2, 0.01);
    EXPECT_TRUE(with_strategy().ok());
    change_hatches("core contour 1", 3, [](std::vector<Point2>& points) { points.clear(); });
    const VectorVerification found = with_all();
    EXPECT_FALSE(found.ok());
    EXPECT_EQ(found.unreached_layers, 1U);
    EXPECT_NEAR(found.unreached_mm2, 1.6, 0.01);
    ASSERT_EQ(found.findings.size(), 1U);
    EXPECT_TRUE(found.findings.front().starts_with(
        "1 layer has more material that no vector reaches than the strategy accepts; "))
        << found.findings.front();
    strategy_.accepted_mm2 = 2;
    EXPECT_TRUE(with_all().ok());
    strategy_.contours.thin_walls = ThinWalls::leave_out; // then lines are none of a contour
    EXPECT_GT(with_all().misplaced, 0U);
    // Lines of thin walls may be near to the edge of the material, and not beyond.
    strategy_ = {};
    change_hatches("core contour 1", 4, [](std::vector<Point2>& points) { points[0].x -= 1; });
    EXPECT_EQ(with_all().outside, 1U);
}

TEST_F(VerifyVectors, FindsThatTheMiddleOfAWallIsNotFilled) {
    mesh_ = test::box_mesh({0, 0, 0}, {20, 0.25F, 1});
    strategy_ = {};
    parts_ = scanned(slice(mesh_, plan_), strategy_, "wall");
    EXPECT_TRUE(with_all().ok()) << "where the hatch has no lines there is one along the middle";
    EXPECT_LT(with_all().unreached_mm2, 0.01);
    strategy_.contours.thin_walls = ThinWalls::leave_out;
    parts_ = scanned(slice(mesh_, plan_), strategy_, "wall");
    const VectorVerification found = with_all();
    EXPECT_GT(found.unreached_layers, 3U);
    EXPECT_GT(found.unreached_mm2, 0.05 * 19.8 * 3);
    EXPECT_NEAR(with_strategy().unreached_mm2, found.unreached_mm2, 0.01)
        << "within its contours it is known";
    EXPECT_EQ(with_mesh().unreached_layers, 0U) << "nobody asks for any";
}

TEST_F(VerifyVectors, OfNoVectorsFails) {
    const VectorVerification nothing = verify_vectors({}, {.strategy = strategy_});
    EXPECT_FALSE(nothing.ok());
    EXPECT_EQ(nothing.findings.size(), 1U);
    EXPECT_TRUE(verify_vectors({}).ok());
    for (LayerPart& part : parts_) {
        for (Layer& layer : part.layers)
            layer = {.index = layer.index, .z = layer.z, .bottom = layer.bottom, .top = layer.top};
        part.hatches.clear();
    }
    EXPECT_FALSE(with_strategy().ok());
    EXPECT_TRUE(with_strategy().none);
}

TEST_F(VerifyVectors, SaysWhereNothingReportsTheMaterial) {
    std::erase_if(parts_, [](const LayerPart& part) { return part.exposure->kind == VectorKind::contour; });
    const VectorVerification found = with_nothing();
    EXPECT_TRUE(found.ok());
    EXPECT_EQ(found.unbounded, found.hatch_vectors);
    EXPECT_EQ(found.findings.size(), 1U);
    EXPECT_EQ(with_all().unbounded, 0U);
    EXPECT_EQ(with_all().outside, 0U);
    EXPECT_EQ(with_all().wrong_contours, 20U) << "each of both is missing";
}

TEST_F(VerifyVectors, FindsContoursThatAreMissing) {
    const std::vector<LayerPart> sound = parts_;
    for (const char* const name : {"core contour 1", "core contour 2"}) {
        parts_ = sound;
        std::erase_if(parts_, [&](const LayerPart& part) { return part.exposure->name() == name; });
        for (const VectorVerification& found : {with_all(), with_strategy()}) {
            EXPECT_EQ(found.wrong_contours, 10U) << name;
            EXPECT_FALSE(found.ok());
        }
        const std::string text = with_all().findings.front();
        EXPECT_NE(text.find("contour " + std::string(1, name[13]) + " is missing on 10 layers"),
                  std::string::npos)
            << text;
        parts_ = sound;
        Layer& layer = part(name).layers[6];
        layer = {.index = layer.index, .z = layer.z, .bottom = layer.bottom, .top = layer.top};
        EXPECT_EQ(with_all().wrong_contours, 1U) << name;
    }
}

TEST_F(VerifyVectors, FindsContoursAtAnotherDepth) {
    const auto replaced = [&](const char* name, const std::vector<test::Contour>& rings) {
        Layer& layer = part(name).layers[6];
        const Layer header = layer;
        layer = layer_of(rings);
        layer.index = header.index;
        layer.z = header.z;
        layer.bottom = header.bottom;
        layer.top = header.top;
    };
    replaced("core contour 1", {rectangle(8, 3, 12, 7)}); // deeper inside than it should be
    EXPECT_EQ(with_all().wrong_contours, 1U);
    replaced("core contour 1", {rectangle(0.35, 0.35, 19.65, 9.65)});
    EXPECT_EQ(with_all().wrong_contours, 1U);
    replaced("core contour 1", {rectangle(0.05, 0.05, 19.95, 9.95)});
    EXPECT_EQ(with_all().wrong_contours, 0U);
    replaced("core contour 2", {rectangle(1, 1, 19, 9)});
    EXPECT_EQ(with_strategy().wrong_contours, 1U) << "the outermost one tells";
}

TEST_F(VerifyVectors, SkinsExcuseNoMoreThanTheirOverlap) {
    const std::vector<LayerPart> sound = parts_;
    for (const std::size_t layer : {0U, 9U}) { // all of these is skin
        const char* const name = layer == 0 ? "downskin hatch" : "upskin hatch";
        parts_ = sound;
        change_hatches(name, layer,
                       [](std::vector<Point2>& points) { points.resize(points.size() / 2 & ~1U); });
        EXPECT_EQ(with_all().miscovered, 1U) << name;
        parts_ = sound;
        change_hatches(name, layer, [](std::vector<Point2>& points) {
            const std::vector<Point2> again = points;
            points.insert(points.end(), again.begin(), again.end());
        });
        EXPECT_EQ(with_all().miscovered, 1U) << name;
    }
}

TEST_F(VerifyVectors, FindsLayersThatAreMissingInTheMiddle) {
    for (LayerPart& part : parts_) {
        part.layers.erase(part.layers.begin() + 4);
        part.hatches.erase(part.hatches.begin() + 4);
    }
    const VectorVerification found = with_mesh();
    EXPECT_FALSE(found.ok());
    ASSERT_TRUE(found.heights);
    EXPECT_EQ(found.heights->gaps, 1U);
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
        verify_vectors(parts_, {.mesh = mesh_, .rounding = {.step_mm = 0.01}, .strategy = strategy_}).ok());
}

TEST_F(VerifyVectors, DistinguishesParts) {
    const LayerStack other = slice(box_mesh({30, 0, 0}, {50, 10, 1}), plan_);
    for (LayerPart& part : scanned(other, strategy_, "other"))
        parts_.push_back(std::move(part));
    EXPECT_TRUE(with_strategy().ok());
    change_hatches("core hatch", 5, [](std::vector<Point2>& points) { // into the other part
        points[0].x += 30;
        points[1].x += 30;
    });
    EXPECT_EQ(with_strategy().outside, 1U);
}

} // namespace
} // namespace lamella
