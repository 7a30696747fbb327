#include "fixtures/random.hpp"
#include "jobs/stream_sums.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <utility>
#include <vector>

namespace lamella::stream_sums_cases {
namespace {

/// More than two pieces of a fold, the last of them not full.
const TriangleSoup& streamed() {
    static const TriangleSoup rook = make_rook();
    return rook;
}

Transform placement() {
    return compose(translation(3, -2, 100), compose(rotation('x', 30), scaling(-1, 2, 0.5)));
}

using Batch = std::pair<std::uint64_t, TriangleSoup>;

/// Of so many triangles each, with their numbers, in random order.
std::vector<Batch> batches(std::size_t size, std::uint64_t seed) {
    const TriangleSoup& all = streamed();
    std::vector<Batch> result;
    for (std::size_t begin = 0; begin < all.size(); begin += size)
        result.emplace_back(result.size(), all.part(begin, std::min(all.size(), begin + size)));
    test::Random random(seed);
    for (std::size_t i = result.size() - 1; i > 0; --i)
        std::swap(result[i],
                  result[static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(i)))]);
    return result;
}

/// add(batch) from two threads.
template <class Add>
void from_two_threads(const std::vector<Batch>& all, const Add& add) {
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < 2; ++t)
        threads.emplace_back([&, t] {
            for (std::size_t i = t; i < all.size(); i += 2)
                add(all[i]);
        });
    for (std::thread& thread : threads)
        thread.join();
}

TEST(Extent, IsTheBoxOfThePlacedMeshAndItsFirstCornerAsStoredInAnyOrder) {
    const Box3 box = bounding_box(streamed().transformed(placement()));
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        Extent extent(placement());
        from_two_threads(batches(5000, seed),
                         [&](const Batch& batch) { extent.add(batch.second, batch.first); });
        EXPECT_EQ(extent.box(), box) << seed;
        EXPECT_EQ(extent.first_corner(), streamed().stored(0)[0]) << seed;
    }
}

TEST(Extent, TakesTheFirstCornerOfWhatIsUsable) {
    // The batches before were left out, as nothing of them was usable.
    Extent extent({});
    EXPECT_TRUE(extent.box().empty());
    extent.add(streamed().part(700, 800), 9);
    extent.add(streamed().part(500, 600), 4);
    extent.add(streamed().part(600, 700), 6);
    EXPECT_EQ(extent.first_corner(), streamed().stored(500)[0]);
}

TEST(VolumeSum, HasTheBitsOfTheVolumeOfTheMeshInAnyOrder) {
    const TriangleSoup placed = streamed().transformed(placement());
    ASSERT_GT(placed.size(), 2 * fold_chunk);
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        VolumeSum sum(placement(), streamed().stored(0)[0]);
        from_two_threads(batches(fold_chunk, seed), [&](const Batch& batch) {
            sum.add(batch.second.transformed(placement()), batch.first);
        });
        double six_volumes = 0;
        for (const double piece : sum.chunks())
            six_volumes += piece;
        EXPECT_EQ(six_volumes / 6, volume(placed)) << seed;
    }
}

TEST(VolumeSum, CountsABatchThatWasLeftOutAsNothing) {
    VolumeSum sum({}, {0, 0, 0});
    EXPECT_TRUE(sum.chunks().empty());
    sum.add(make_box(1, 2, 3), 2);
    EXPECT_EQ(sum.chunks(), (std::vector<double>{0, 0, 36}));
}

} // namespace
} // namespace lamella::stream_sums_cases
