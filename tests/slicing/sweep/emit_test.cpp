#include "slicing/sweep/emit.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella::emit_cases {
namespace {

constexpr double top_z = 1;

/// Upright edges over the corners of a contour, as prepared columns.
class Corners {
  public:
    explicit Corners(const std::vector<Point2>& corners) : columns_(6 * EdgeColumns::padded(corners.size())) {
        const std::size_t stride = EdgeColumns::padded(corners.size());
        for (std::size_t i = 0; i < corners.size(); ++i) {
            double* column = columns_.data() + i;
            column[0] = 0;
            column[stride] = top_z;
            column[2 * stride] = column[3 * stride] = corners[i].x;
            column[4 * stride] = column[5 * stride] = corners[i].y;
        }
        edges_ = {columns_.data(), corners.size()};
        point_kernels().prepare(edges_);
    }
    [[nodiscard]] EdgeColumns edges() const { return edges_; }

  private:
    PageArray<double> columns_;
    EdgeColumns edges_{};
};

/// Contours on the plane 0, as runs of one plane.
struct Contours {
    Runs runs;
    std::vector<Corners> corners;
    std::vector<LayerEntry> entries;
    Scratch scratch;

    Contours() { runs.begin_task({0, 1}); }
    void add(const std::vector<Point2>& points, std::uint32_t start, bool closed) {
        const std::vector<std::uint32_t> nodes(points.size(), static_cast<std::uint32_t>(corners.size()));
        corners.emplace_back(points);
        const Run& run = runs.add(0, {nodes, 1, closed});
        const std::uint64_t index = Runs::index_of(run, 0);
        runs.ring(index) = {points[start], start, static_cast<std::uint32_t>(points.size()), 0};
        entries.push_back({points[start], index, closed});
    }
    void put_in_order() {
        lamella::put_in_order(
            entries, 0.5, runs,
            [&](const Run& run, Scratch&) { return corners[runs.nodes(run).front()].edges(); }, scratch);
    }
};

TEST(Emit, WritesARingFromItsStartWithoutRepeatedPoints) {
    const Corners corners({{5, 0}, {5, 5}, {0, 5}, {0, 5}, {0, 0}});
    Scratch scratch;
    const std::vector<Point2> expected{{0, 0}, {5, 0}, {5, 5}, {0, 5}};
    std::vector<Point2> points(4);
    write_ring({corners.edges(), true}, 0.5, {{0, 0}, 3, 4, 0}, points.data(), false, scratch);
    EXPECT_EQ(points, expected);
}

TEST(Emit, PutsRingsBeforeChainsAndEachOfThemByItsFirstPoint) {
    Contours contours;
    contours.add({{1, 1}, {2, 2}}, 0, false);
    contours.add({{5, 0}, {6, 0}, {6, 6}}, 0, true);
    contours.add({{9, 0}, {9, 9}, {3, 0}}, 2, true);
    contours.put_in_order();
    EXPECT_EQ(contours.entries[0].first, (Point2{3, 0}));
    EXPECT_EQ(contours.entries[1].first, (Point2{5, 0}));
    EXPECT_FALSE(contours.entries[2].closed);
}

TEST(Emit, PutsRingsThatTouchInTheOrderOfWhatFollows) {
    Contours contours;
    contours.add({{0, 0}, {5, 9}, {4, 9}}, 0, true);
    contours.add({{0, 0}, {5, 1}, {5, 2}}, 0, true);
    contours.add({{0, 0}, {2, 3}, {1, 3}}, 0, true);
    contours.put_in_order();
    std::vector<std::uint64_t> rings;
    for (const LayerEntry& entry : contours.entries)
        rings.push_back(entry.ring);
    EXPECT_EQ(rings, (std::vector<std::uint64_t>{2, 1, 0}));
}

TEST(Emit, GivesEachContourItsPlaceBehindTheOneBefore) {
    Contours contours;
    contours.add({{0, 0}, {2, 0}, {2, 2}, {0, 2}}, 0, true);
    contours.add({{5, 0}, {6, 0}, {6, 6}}, 0, true);
    contours.add({{1, 1}, {2, 2}}, 0, false);
    Layer layer;
    place_contours(contours.entries, contours.runs, layer);
    EXPECT_EQ(layer.offsets, (std::vector<std::uint64_t>{0, 4, 7, 9}));
    EXPECT_EQ(layer.rings, 2U);
    EXPECT_EQ(contours.runs.ring(2).position, 7U);
}

} // namespace
} // namespace lamella::emit_cases
