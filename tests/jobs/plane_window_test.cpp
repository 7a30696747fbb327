#include "fixtures/random.hpp"
#include "jobs/plane_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace lamella::plane_window_cases {
namespace {

using Indices = std::vector<std::uint64_t>;

using Window = PlaneWindow<std::uint64_t>;

/// What a plane was worked on with.
struct Seen {
    std::uint64_t plane;
    Indices below;
    Indices above;
};

/// What became of all planes.
struct Record {
    std::mutex mutex;
    std::vector<Seen> worked_on;
    Indices written;

    [[nodiscard]] Window::Work work() {
        return [this](const PlaneNeighbours<std::uint64_t>& plane) -> Commit {
            Seen seen{*plane.own, {}, {}};
            for (const std::uint64_t* number : plane.below)
                seen.below.push_back(*number);
            for (const std::uint64_t* number : plane.above)
                seen.above.push_back(*number);
            const std::uint64_t number = seen.plane;
            EXPECT_EQ(plane.plane, number);
            const std::lock_guard lock(mutex);
            worked_on.push_back(std::move(seen));
            return [this, number] {
                written.push_back(number);
            };
        };
    }
};

Window::Shared plane(std::uint32_t number) {
    return std::make_shared<const std::uint64_t>(number);
}

/// Each of the wanted planes once, in order, with all of its neighbours among those that came.
void expect_complete(const Record& record, PlaneRange coming, PlaneRange wanted, std::uint32_t below,
                     std::uint32_t above) {
    ASSERT_EQ(record.written.size(), wanted.size());
    for (std::uint32_t i = 0; i < wanted.size(); ++i)
        EXPECT_EQ(record.written[i], wanted.begin + i);
    ASSERT_EQ(record.worked_on.size(), wanted.size());
    for (const Seen& seen : record.worked_on) {
        Indices expected_below;
        for (std::uint64_t p = seen.plane; p-- > coming.begin && expected_below.size() < below;)
            expected_below.push_back(p);
        Indices expected_above;
        for (std::uint64_t p = seen.plane + 1; p < coming.end && expected_above.size() < above; ++p)
            expected_above.push_back(p);
        EXPECT_EQ(seen.below, expected_below);
        EXPECT_EQ(seen.above, expected_above);
    }
}

TEST(PlaneWindow, GivesEachPlaneItsNeighboursInWhateverOrderPlanesCome) {
    test::Random random(1);
    for (int round = 0; round < 300; ++round) {
        const auto number = [&](std::int64_t most) {
            return static_cast<std::uint32_t>(random.integer(0, most));
        };
        const std::uint32_t first = number(5);
        const PlaneRange coming{first, first + 1 + number(20)};
        const std::uint32_t begin = coming.begin + number(coming.size() - 1);
        const PlaneRange wanted{begin, begin + 1 + number(coming.end - begin - 1)};
        const std::uint32_t below = number(4);
        const std::uint32_t above = number(4);
        Record record;
        Window window(coming, wanted, below, above, record.work());
        // Some planes at a time in parallel, here in any order; then their halves in order.
        for (std::uint32_t at = coming.begin; at < coming.end;) {
            const std::uint32_t end = std::min(coming.end, at + 1 + number(6));
            std::vector<std::uint32_t> order;
            for (std::uint32_t p = at; p < end; ++p)
                order.insert(order.begin() + number(static_cast<std::int64_t>(order.size())), p);
            std::vector<Commit> in_order(end - at);
            for (const std::uint32_t p : order)
                in_order[p - at] = window.prepare(p, plane(p));
            for (const Commit& action : in_order)
                action();
            at = end;
        }
        SCOPED_TRACE(testing::Message() << coming.begin << ":" << coming.end << " wanted " << wanted.begin
                                        << ":" << wanted.end << " " << below << " " << above);
        expect_complete(record, coming, wanted, below, above);
        EXPECT_EQ(window.held(), 0U);
    }
}

TEST(PlaneWindow, HoldsNoMoreThanTheNeighbours) {
    constexpr std::uint32_t planes = 1000;
    Record record;
    Window window({0, planes}, {0, planes}, 3, 2, record.work());
    for (std::uint32_t p = 0; p < planes; ++p) {
        window.prepare(p, plane(p))();
        EXPECT_LE(window.held(), 5U);
        EXPECT_EQ(record.written.size(), p + 1 == planes ? planes : p - std::min(p, 1U));
    }
    EXPECT_EQ(window.held(), 0U);
}

TEST(PlaneWindow, WaitsForNothingWithoutNeighbours) {
    Record record;
    Window window({4, 10}, {4, 10}, 0, 0, record.work());
    for (std::uint32_t p = 4; p < 10; ++p) {
        const Commit write = window.prepare(p, plane(p));
        EXPECT_EQ(record.worked_on.size(), p - 3);
        EXPECT_EQ(window.held(), 0U);
        write();
        EXPECT_EQ(record.written.back(), p);
    }
}

TEST(PlaneWindow, ReturnsTheContentOfAnAdjacentPlaneThatIsHeld) {
    Record record;
    Window window({0, 9}, {0, 9}, 1, 1, record.work());
    EXPECT_EQ(window.held_beside(3), nullptr);
    const Commit third = window.prepare(3, plane(3));
    for (const std::uint32_t beside : {2U, 4U}) {
        ASSERT_NE(window.held_beside(beside), nullptr);
        EXPECT_EQ(*window.held_beside(beside), 3U);
    }
    EXPECT_EQ(window.held_beside(5), nullptr);
}

TEST(PlaneWindow, TakesPlanesFromManyThreads) {
    constexpr std::uint32_t planes = 400;
    Record record;
    Window window({0, planes}, {10, planes - 10}, 4, 4, record.work());
    std::vector<Commit> in_order(planes);
    std::atomic<std::uint32_t> next{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            for (std::uint32_t p = next++; p < planes; p = next++)
                in_order[p] = window.prepare(p, plane(p));
        });
    for (std::thread& thread : threads)
        thread.join();
    for (const Commit& action : in_order)
        action();
    expect_complete(record, {0, planes}, {10, planes - 10}, 4, 4);
    EXPECT_EQ(window.held(), 0U);
}

} // namespace
} // namespace lamella::plane_window_cases
