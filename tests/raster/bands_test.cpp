#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "raster/bands.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace lamella::bands_cases {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;

using Edge = std::pair<Point2, Point2>;

TEST(Bands, HoldEachEdgeThatReachesThemOnce) {
    Random random(631);
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        const PixelGrid grid{.width = static_cast<std::uint32_t>(random.integer(1, 4000)),
                             .height = static_cast<std::uint32_t>(random.integer(1, 900)),
                             .u0 = 0.25};
        std::vector<Layer> parts;
        for (std::int64_t n = random.integer(1, 3); n > 0; --n) {
            std::vector<Contour> rings;
            for (std::int64_t k = random.integer(0, 3); k > 0; --k) {
                Contour& ring = rings.emplace_back();
                // Some leave the image, and some have more points than are converted at a time.
                for (std::int64_t i = random.integer(3, round % 20 == 0 ? 2000 : 12); i > 0; --i)
                    ring.push_back({random.real(-10, 4010), random.real(-100, 1000)});
            }
            parts.push_back(layer_of(rings));
        }
        const Bands bands(parts, grid);
        ASSERT_GE(bands.rows(), 1U);
        const std::uint32_t count = (grid.height + bands.rows() - 1) / bands.rows();
        for (std::uint32_t band = 0; band < count; ++band) {
            const double top = band * bands.rows();
            const double bottom = top + bands.rows();
            std::map<Edge, int> found;
            bands.for_each_line(band, [&](std::span<const Point2> points) {
                for (std::size_t i = 0; i + 1 < points.size(); ++i)
                    ++found[{points[i], points[i + 1]}];
            });
            for (const Layer& layer : parts)
                for (std::size_t r = 0; r < layer.rings; ++r)
                    for (std::size_t i = 0; i < layer.contour(r).size(); ++i) {
                        const Edge edge{
                            position_in_image(layer.contour(r)[i], grid),
                            position_in_image(layer.contour(r)[(i + 1) % layer.contour(r).size()], grid)};
                        const auto [low, high] = std::minmax(edge.first.y, edge.second.y);
                        const auto known = found.find(edge);
                        if (high > top + 1e-9 && low < bottom - 1e-9) {
                            ASSERT_TRUE(known != found.end()) << round << ' ' << band;
                        }
                        if (known != found.end()) {
                            EXPECT_EQ(known->second, 1) << round << ' ' << band;
                            EXPECT_TRUE(high >= top - 1e-9 && low <= bottom + 1e-9) << round << ' ' << band;
                            found.erase(known);
                        }
                    }
            EXPECT_TRUE(found.empty()) << round << ": no other edges";
        }
    }
}

} // namespace
} // namespace lamella::bands_cases
