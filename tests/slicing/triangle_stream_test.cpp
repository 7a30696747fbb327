#include "lamella/mesh/mesh.hpp"
#include "lamella/slicing/slice.hpp"

#include "even_planes.hpp"
#include "expect_layers.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/triangle_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace lamella::triangle_stream_cases {
namespace {

/// Bodies that touch in edges, so that the graph pairs non-manifold edges, and a body with an open side.
TriangleSoup body() {
    test::Triangles triangles = test::rugged_drum(500, 30);
    test::Random random(5);
    for (int i = 0; i < 40; ++i) {
        const auto x = static_cast<double>(random.integer(0, 6));
        const auto y = static_cast<double>(random.integer(0, 6));
        const auto z = static_cast<double>(random.integer(-9, 6));
        const TriangleSoup box = make_box(1, 1, 2.5);
        for (std::size_t t = 0; t < box.size(); ++t) {
            Triangle3f moved = box.stored(t);
            for (Point3f& p : moved)
                p = {p.x + static_cast<float>(20 + x), p.y + static_cast<float>(y),
                     p.z + static_cast<float>(z)};
            triangles.push_back(moved);
        }
    }
    triangles.erase(triangles.begin() + 100);
    return test::soup(triangles);
}

/// Passes copies of chunks of `size` triangles in random order, from all threads, each in memory that is
/// freed when its call ends.
TriangleStream stream_of(const TriangleSoup& soup, std::size_t size, std::uint64_t seed) {
    return {.triangles = soup.size(),
            .placed = soup.has_placement(),
            .pass = [&soup, size, seed](unsigned threads, const TriangleStream::Sink& sink) {
                std::vector<std::size_t> begins;
                for (std::size_t begin = 0; begin < soup.size(); begin += size)
                    begins.push_back(begin);
                test::Random random(seed);
                for (std::size_t i = begins.size() - 1; i > 0; --i)
                    std::swap(
                        begins[i],
                        begins[static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(i)))]);
                std::atomic<std::size_t> next{0};
                std::vector<std::thread> team;
                for (unsigned t = 0; t < threads; ++t)
                    team.emplace_back([&] {
                        for (std::size_t i = next++; i < begins.size(); i = next++) {
                            std::vector<Triangle3f> copies;
                            for (std::size_t k = begins[i]; k < std::min(begins[i] + size, soup.size()); ++k)
                                copies.push_back(soup.stored(k));
                            sink(TriangleSoup(std::move(copies)).transformed(soup.placement()), begins[i]);
                        }
                    });
                for (std::thread& thread : team)
                    thread.join();
            }};
}

TEST(TriangleStream, GivesTheLayersOfTheMeshForAnyChunksAndThreads) {
    const TriangleSoup unplaced = body();
    const Transform placement = compose(rotation('x', 20), scaling(-1, 1.5, 1));
    for (const TriangleSoup& soup : {unplaced, unplaced.transformed(placement)}) {
        const Box3 box = bounding_box(soup);
        const Plan plan = test::even_planes(box.min.z, box.max.z, 70);
        const LayerStack expected = slice(soup, plan);
        for (const unsigned threads : test::thread_counts())
            for (const std::size_t size : {97U, 4096U, 1U << 20}) {
                SCOPED_TRACE(testing::Message() << threads << " threads, chunks of " << size);
                LayerStack layers;
                const SliceReport report = slice_to(appending_to(layers), stream_of(soup, size, threads),
                                                    plan, {.execution = {.threads = threads}});
                test::expect_same(layers, expected);
                EXPECT_EQ(report.layers, plan.layers.size());
            }
    }
}

TEST(TriangleStream, StopsWithTheErrorOfItsPass) {
    const TriangleStream failing{
        .triangles = 12, .placed = false, .pass = [](unsigned, const TriangleStream::Sink& sink) {
            sink(make_box(1, 2, 3), 0);
            throw std::runtime_error("the file is gone");
        }};
    LayerStack layers;
    EXPECT_THROW(slice_to(appending_to(layers), failing, test::even_planes(0, 3, 3)), std::runtime_error);
    EXPECT_TRUE(layers.empty());
}

} // namespace
} // namespace lamella::triangle_stream_cases
