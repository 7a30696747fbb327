#include "lamella/mesh/shapes.hpp"
#include "lamella/slicing/slice.hpp"

#include "pipeline/share_store.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace lamella {
namespace {

const Plan& plan() {
    static const Plan planes = plan_uniform(0, bounding_box(make_rook()).max.z, {.layer_height = 1});
    return planes;
}

std::vector<std::uint64_t> hashes_of(const TriangleSoup& mesh, PlaneRange share) {
    std::vector<std::uint64_t> hashes;
    for (const Layer& layer : slice(mesh, part_of(plan(), share)))
        hashes.push_back(content_hash(layer));
    return hashes;
}

TEST(ShareStore, GivesEachShareTheTrianglesOfItsLayers) {
    const TriangleSoup rook = make_rook();
    const TriangleSoup moved = rook.transformed(translation(1, 2, 3));
    const std::array counts{count_planes(rook, plan()), count_planes(moved, plan())};
    const auto planes = static_cast<std::uint32_t>(plan().layers.size());
    const std::vector<std::vector<PlaneRange>> divisions{
        {{0, planes}}, {{0, 10}, {10, 11}, {11, planes}}, {{5, 9}, {20, planes}}};
    for (const std::vector<PlaneRange>& shares : divisions) {
        ShareStore store(plan(), shares, counts);
        // In pieces, backwards: order does not matter.
        constexpr std::size_t piece = 1000;
        for (std::size_t end = rook.size(); end > 0; end -= std::min(end, piece))
            for (const std::size_t shape : {0U, 1U}) {
                const TriangleSoup& mesh = shape == 0 ? rook : moved;
                ASSERT_TRUE(store.add(shape, mesh.part(end - std::min(end, piece), end)));
            }
        EXPECT_TRUE(store.full());
        for (std::size_t s = 0; s < shares.size(); ++s) {
            EXPECT_EQ(hashes_of(store.take(s, 0, {}), shares[s]), hashes_of(rook, shares[s])) << s;
            EXPECT_EQ(hashes_of(store.take(s, 1, {}).transformed(moved.placement()), shares[s]),
                      hashes_of(moved, shares[s]))
                << s;
        }
    }
}

TEST(ShareStore, SaysWhenTrianglesAreMissingOrTooMany) {
    const TriangleSoup rook = make_rook();
    const std::array counts{count_planes(rook, plan())};
    const std::array<PlaneRange, 2> shares{{{0, 7}, {7, static_cast<std::uint32_t>(plan().layers.size())}}};
    ShareStore store(plan(), shares, counts);
    EXPECT_TRUE(store.add(0, rook.part(0, rook.size() / 2)));
    EXPECT_FALSE(store.full());
    EXPECT_TRUE(store.add(0, rook.part(rook.size() / 2, rook.size())));
    EXPECT_TRUE(store.full());
    EXPECT_FALSE(store.add(0, rook));
}

} // namespace
} // namespace lamella
