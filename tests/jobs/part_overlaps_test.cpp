#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"

#include "fixtures/layers.hpp"
#include "jobs/part_overlaps.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace lamella::part_overlaps_cases {
namespace {

using test::normal_layer;
using test::rectangle;

Layer square_at(double x) {
    return normal_layer({rectangle(x, 0, x + 10, 10)});
}

std::vector<double> areas_of(const UnitedParts& united) {
    std::vector<double> areas;
    for (const Layer& part : united.parts)
        areas.push_back(measure(part).area_mm2);
    return areas;
}

TEST(PartOverlaps, OfOneObjectAreUnitedIntoItsFirstPart) {
    const std::vector<Layer> parts{square_at(0), square_at(5), square_at(30), square_at(12)};
    const std::vector<std::uint32_t> objects{0, 0, 0, 0};
    const UnitedParts united = unite_overlapping_parts(parts, objects, std::vector<bool>(4));
    EXPECT_EQ(areas_of(united), (std::vector<double>{220, 0, 100, 0})) << "a chain of three, and one apart";
    EXPECT_EQ(united.overlaps_mm2, std::vector<double>(4, 0));
    EXPECT_TRUE(same_contours(united.parts[2], parts[2]));
}

TEST(PartOverlaps, OfOtherPartsAreMeasured) {
    const std::vector<Layer> parts{square_at(0), square_at(5), square_at(5)};
    const UnitedParts united =
        unite_overlapping_parts(parts, std::vector<std::uint32_t>{0, 1, 2}, std::vector<bool>(3));
    EXPECT_EQ(areas_of(united), (std::vector<double>{100, 100, 100}));
    EXPECT_EQ(united.overlaps_mm2, (std::vector<double>{0, 50, 150}));
    const UnitedParts two =
        unite_overlapping_parts(parts, std::vector<std::uint32_t>{0, 0, 2}, std::vector<bool>(3));
    EXPECT_EQ(areas_of(two), (std::vector<double>{150, 0, 100}));
    EXPECT_EQ(two.overlaps_mm2, (std::vector<double>{0, 0, 100}));
}

TEST(PartOverlaps, AreNoneWherePartsTouchOrSupportsReachIntoThem) {
    const std::vector<Layer> parts{square_at(0), square_at(10), square_at(5)};
    const std::vector<bool> supports{false, false, true};
    for (const std::uint32_t other : {0U, 1U}) {
        const UnitedParts united =
            unite_overlapping_parts(parts, std::vector<std::uint32_t>{0, other, 0}, supports);
        EXPECT_EQ(areas_of(united), (std::vector<double>{100, 100, 100}));
        EXPECT_EQ(united.overlaps_mm2, std::vector<double>(3, 0));
    }
}

} // namespace
} // namespace lamella::part_overlaps_cases
