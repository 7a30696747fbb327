#include "verify_vectors_fixture.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella::verify_vectors_cases {
namespace {

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

} // namespace
} // namespace lamella::verify_vectors_cases
