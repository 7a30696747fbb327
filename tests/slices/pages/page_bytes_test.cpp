#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "page_reader.hpp"
#include "slices/pages/page_bytes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace lamella::page_bytes_cases {
namespace {

using test::Random;

TEST(NumberBytes, ReadBackAsTheSameNumbers) {
    Random random(681);
    NumberBytes bytes;
    std::vector<std::uint64_t> numbers{0, 127, 128, std::numeric_limits<std::uint64_t>::max()};
    for (int i = 0; i < 1000; ++i)
        numbers.push_back(random.bits() >> random.integer(0, 63));
    for (const std::uint64_t number : numbers) {
        bytes.add(number);
        bytes.add_signed(static_cast<std::int64_t>(number));
    }
    NumberBytes all;
    all.add(7);
    all.append(bytes);
    PageNumbers read(all.view());
    EXPECT_EQ(read.next(), 7U);
    for (const std::uint64_t number : numbers) {
        EXPECT_EQ(read.next(), number);
        EXPECT_EQ(read.next_signed(), static_cast<std::int64_t>(number));
    }
    EXPECT_TRUE(read.at_end());
}

TEST(PageGrid, HasTheSmallestRoundStepForItsBox) {
    Random random(682);
    for (int round = 0; round < test::rounds_within_reason(1000); ++round) {
        const double width = std::pow(10, random.real(-4, 6));
        const Point3 corner{random.real(-1e3, 1e3), random.real(-1e3, 1e3), 0};
        Box3 box;
        box.add(corner);
        box.add(Point3{corner.x + width, corner.y + width * random.real(0, 1), 1});
        const double edge = box.max.x - box.min.x;
        const double step = page_step_mm(box);
        EXPECT_GE(step, edge / 50'000 * (1 - 1e-12));
        EXPECT_LE(step, edge / 50'000 * 2.5 * (1 + 1e-12)) << "1, 2 or 5 times a power of ten";
        const double digit = step / std::pow(10, std::floor(std::log10(step * (1 + 1e-9))));
        EXPECT_TRUE(std::abs(digit - 1) < 1e-6 || std::abs(digit - 2) < 1e-6 || std::abs(digit - 5) < 1e-6)
            << step;
        const PageGrid grid = page_grid(box);
        EXPECT_EQ(grid.step_mm, step);
        EXPECT_LE(std::abs(static_cast<double>(grid.origin.x) * step - box.min.x), 0.51 * step);
        EXPECT_LE(std::abs(static_cast<double>(grid.origin.y) * step - box.min.y), 0.51 * step);
    }
    EXPECT_EQ(page_step_mm({}), 0.001);
}

TEST(PageBytes, HoldTheContoursOfAPlaneWithinHalfAStep) {
    Random random(683);
    for (int round = 0; round < test::rounds_within_reason(200); ++round) {
        std::vector<Layer> layers;
        const std::vector<PartInfo> parts(2);
        Box3 box;
        for (std::size_t part = 0; part < parts.size(); ++part) {
            std::vector<test::Contour> rings;
            std::vector<test::Contour> chains;
            for (std::int64_t n = random.integer(0, 4); n > 0; --n) {
                test::Contour contour = test::regular_polygon(static_cast<int>(random.integer(3, 30)), 10);
                for (Point2& p : contour) {
                    p.x += random.real(-0.1, 0.1);
                    box.add(Point3{p.x, p.y, 0});
                }
                (random.integer(0, 2) == 0 ? chains : rings).push_back(contour);
            }
            layers.push_back(test::layer_of(rings, chains));
        }
        box.add(Point3{-10.5, -10.5, 0});
        const std::vector<Point2> locations{{1, 2}, {-3, 4.5}};
        const PageGrid grid = page_grid(box);
        std::uint64_t shown = 0;
        const NumberBytes bytes = layer_numbers(Plane(layers), parts, locations, grid, shown);
        const PageLayer read =
            page_layer(bytes.view(), parts.size(), grid.step_mm,
                       {static_cast<double>(grid.origin.x), static_cast<double>(grid.origin.y)});
        const auto near = [&](const Point2& a, const Point2& b) {
            return std::abs(a.x - b.x) <= 0.51 * grid.step_mm && std::abs(a.y - b.y) <= 0.51 * grid.step_mm;
        };
        std::uint64_t points = 0;
        for (std::size_t part = 0; part < parts.size(); ++part) {
            ASSERT_EQ(read.parts[part].contours.size(), layers[part].contours());
            for (std::size_t i = 0; i < layers[part].contours(); ++i) {
                const auto contour = layers[part].contour(i);
                const PageContour& found = read.parts[part].contours[i];
                EXPECT_EQ(found.closed, layers[part].closed(i));
                ASSERT_EQ(found.points.size(), contour.size());
                points += contour.size();
                // A ring may begin at another of its points.
                bool same = false;
                for (std::size_t first = 0; first < contour.size() && !same; ++first) {
                    same = true;
                    for (std::size_t k = 0; k < contour.size() && same; ++k)
                        same = near(found.points[k], contour[(first + k) % contour.size()]);
                }
                EXPECT_TRUE(same) << round;
            }
        }
        EXPECT_EQ(shown, points);
        ASSERT_EQ(read.crossings.size(), locations.size());
        for (std::size_t i = 0; i < locations.size(); ++i)
            EXPECT_TRUE(near(read.crossings[i], locations[i]));
    }
}

} // namespace
} // namespace lamella::page_bytes_cases
