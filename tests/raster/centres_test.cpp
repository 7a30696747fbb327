#include "core/orientation.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "raster/centres.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella::centres_cases {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;

int winding(const std::vector<Layer>& parts, const Point2& p) {
    int winding = 0;
    for (const Layer& layer : parts)
        for (std::size_t r = 0; r < layer.rings; ++r)
            for (std::size_t i = 0; i < layer.contour(r).size(); ++i) {
                const Point2& a = layer.contour(r)[i];
                const Point2& b = layer.contour(r)[(i + 1) % layer.contour(r).size()];
                if ((a.y <= p.y) != (b.y <= p.y) && orientation(a, b, p) == (a.y < b.y ? 1 : -1))
                    winding += a.y < b.y ? 1 : -1;
            }
    return winding;
}

TEST(CentreRows, CoverThePixelsWhoseCentresAreInMaterial) {
    Random random(641);
    for (int round = 0; round < test::rounds_within_reason(200); ++round) {
        const PixelGrid grid{.width = static_cast<std::uint32_t>(random.integer(1, 40)),
                             .height = static_cast<std::uint32_t>(random.integer(1, 30))};
        std::vector<Layer> parts;
        for (std::int64_t n = random.integer(1, 2); n > 0; --n) {
            std::vector<Contour> rings;
            for (std::int64_t k = random.integer(0, 3); k > 0; --k) {
                Contour& ring = rings.emplace_back();
                for (std::int64_t i = random.integer(3, 8); i > 0; --i) {
                    // Whole coordinates keep away from the centres, and make upright edges.
                    const auto x = static_cast<double>(random.integer(-5, 45));
                    ring.push_back({x, static_cast<double>(random.integer(-5, 35))});
                }
            }
            parts.push_back(layer_of(rings));
        }
        CentreRows rows(parts, grid);
        std::uint32_t row = 0;
        while (row < grid.height) {
            const DrawnRow drawn = rows.draw(row);
            ASSERT_GE(drawn.times, 1U);
            ASSERT_FALSE(drawn.runs.empty());
            EXPECT_EQ(drawn.runs.back().end, grid.width) << round;
            std::vector<std::uint8_t> values;
            double covered = 0;
            for (const PixelRun& run : drawn.runs) {
                ASSERT_GT(run.end, values.size()) << "runs ascend";
                covered += run.value == 255 ? static_cast<double>(run.end - values.size()) : 0;
                values.resize(run.end, run.value);
            }
            EXPECT_EQ(drawn.covered, covered);
            for (std::uint32_t k = 0; k < drawn.times && row + k < grid.height; ++k)
                for (std::uint32_t column = 0; column < grid.width; ++column) {
                    const Point2 centre{column + 0.5, row + k + 0.5};
                    if (winding(parts, {centre.x - 1e-9, centre.y}) !=
                        winding(parts, {centre.x + 1e-9, centre.y}))
                        continue; // on an edge
                    EXPECT_EQ(values[column], winding(parts, centre) != 0 ? 255 : 0)
                        << round << ' ' << column << ' ' << row + k;
                }
            row += drawn.times;
        }
    }
}

} // namespace
} // namespace lamella::centres_cases
