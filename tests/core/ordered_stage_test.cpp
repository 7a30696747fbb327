#include "lamella/contour/layer.hpp"
#include "lamella/core/error.hpp"
#include "lamella/slicing/slice.hpp"

#include "core/ordered_stage.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace lamella {
namespace {

Layer layer_number(std::uint32_t plane) {
    Layer layer;
    layer.index = plane;
    return layer;
}

/// All numbers below n, in random order.
std::vector<std::uint32_t> mixed(std::uint32_t n, std::uint64_t seed) {
    std::vector<std::uint32_t> order(n);
    std::iota(order.begin(), order.end(), 0U);
    test::Random random(seed);
    for (std::uint32_t i = n; i > 1; --i)
        std::swap(order[i - 1], order[static_cast<std::size_t>(random.integer(0, i - 1))]);
    return order;
}

/// A delivery of so many planes, and what it needs.
struct Delivery {
    Delivery(std::uint64_t planes, LayerSink to, const Execution& by = {})
        : execution(by), executor(execution), sink(std::move(to)), progress(execution, Stage::slice, planes) {
    }

    void deliver(std::uint32_t plane) { delivery.deliver(plane, sink.prepare(layer_number(plane))); }

    Execution execution;
    Executor executor;
    LayerSink sink;
    ProgressMeter progress;
    OrderedStage delivery{executor, progress};
};

const LayerSink nothing_in_order{.prepare = [](Layer&&) {
    return Commit();
}};

TEST(OrderedStage, RunsTheOrderedPartsInOrderWhateverTheOrderOfDelivery) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        std::vector<std::uint64_t> arrived;
        std::vector<std::uint64_t> ordered;
        const LayerSink sink{.prepare = [&](Layer&& layer) -> Commit {
            arrived.push_back(layer.index);
            return [&ordered, index = layer.index] {
                ordered.push_back(index);
            };
        }};
        Delivery delivery(50, sink);
        const std::vector<std::uint32_t> order = mixed(50, seed);
        for (const std::uint32_t plane : order)
            delivery.deliver(plane);
        EXPECT_TRUE(std::equal(arrived.begin(), arrived.end(), order.begin(), order.end()))
            << "the parallel part must not wait";
        ASSERT_EQ(ordered.size(), 50U);
        EXPECT_TRUE(std::is_sorted(ordered.begin(), ordered.end()));
    }
}

TEST(OrderedStage, RunsTheOrderedPartsOneAtATimeUnderManyThreads) {
    constexpr std::uint32_t planes = 2000;
    std::atomic<int> inside{0};
    std::atomic<int> parallel{0};
    std::vector<std::uint64_t> ordered; // not guarded: the promise is that it need not be
    const LayerSink sink{.prepare = [&](Layer&& layer) -> Commit {
        ++parallel;
        return [&, index = layer.index] {
            EXPECT_EQ(++inside, 1);
            ordered.push_back(index);
            --inside;
        };
    }};
    Delivery delivery(planes, sink, {.threads = 7});
    const std::vector<std::uint32_t> order = mixed(planes, 1);
    delivery.executor.for_chunks(
        planes, 1, [&](std::uint64_t i, std::uint64_t, unsigned) { delivery.deliver(order[i]); });
    EXPECT_EQ(parallel, static_cast<int>(planes));
    ASSERT_EQ(ordered.size(), planes);
    for (std::uint32_t i = 0; i < planes; ++i)
        ASSERT_EQ(ordered[i], i);
}

TEST(OrderedStage, RunsEachCompletionOnceAfterItsCommit) {
    for (const unsigned workers : test::thread_counts()) {
        constexpr std::uint32_t planes = 300;
        std::vector<std::atomic<int>> runs(planes);
        std::atomic<std::uint32_t> committed{0};
        const LayerSink sink{.prepare = [&](Layer&& layer) -> Commit {
            return [&, plane = static_cast<std::uint32_t>(layer.index)](Completions& after) {
                EXPECT_EQ(committed++, plane);
                if (plane % 3 != 0)
                    after.emplace_back([&, plane] {
                        EXPECT_GT(committed, plane);
                        ++runs[plane];
                    });
            };
        }};
        Delivery all(planes, sink, {.threads = workers});
        all.executor.for_chunks(planes, 1, [&](std::uint64_t plane, std::uint64_t, unsigned) {
            all.deliver(static_cast<std::uint32_t>(plane));
        });
        for (std::uint32_t plane = 0; plane < planes; ++plane)
            EXPECT_EQ(runs[plane], plane % 3 == 0 ? 0 : 1) << plane << ", workers " << workers;
    }
}

TEST(OrderedStage, CommitsPlanesWhileACompletionRuns) {
    std::atomic<bool> running{false};
    std::atomic<bool> second{false};
    const LayerSink sink{.prepare = [&](Layer&& layer) -> Commit {
        if (layer.index == 1)
            return [&] {
                second = true;
            };
        return [&](Completions& after) {
            after.emplace_back([&] {
                running = true;
                while (!second)
                    std::this_thread::yield();
            });
        };
    }};
    Delivery two(2, sink);
    std::thread first([&] { two.deliver(0); });
    while (!running)
        std::this_thread::yield();
    two.deliver(1);
    first.join();
    EXPECT_EQ(two.delivery.delivered(), 2U);
}

TEST(OrderedStage, PassesAnExceptionOfACompletionToTheCaller) {
    const LayerSink sink{.prepare = [](Layer&& layer) -> Commit {
        return [fails = layer.index == 5](Completions& after) {
            after.emplace_back([fails] {
                if (fails)
                    throw std::runtime_error("no space");
            });
        };
    }};
    Delivery all(100, sink, {.threads = 3});
    EXPECT_THROW(all.executor.for_chunks(100, 1,
                                         [&](std::uint64_t plane, std::uint64_t, unsigned) {
                                             all.deliver(static_cast<std::uint32_t>(plane));
                                         }),
                 std::runtime_error);
}

TEST(OrderedStage, CountsLayersWithoutAnOrderedPart) {
    Delivery delivery(3, nothing_in_order);
    for (const std::uint32_t plane : {0U, 1U, 2U})
        delivery.deliver(plane);
    EXPECT_TRUE(delivery.delivery.wait_for(3));
}

TEST(OrderedStage, LetsGoOfAnOrderedPartOnceItHasRun) {
    const auto token = std::make_shared<int>(0);
    const LayerSink sink{.prepare = [&](Layer&&) -> Commit {
        return [kept = token] {
        };
    }};
    Delivery delivery(3, sink);
    delivery.deliver(1);
    EXPECT_EQ(token.use_count(), 2);
    delivery.deliver(0);
    EXPECT_EQ(token.use_count(), 1);
}

TEST(OrderedStage, PassesAnExceptionOfTheParallelPartToWhoDelivered) {
    const LayerSink sink{.prepare = [](Layer&& layer) -> Commit {
        if (layer.index == 1)
            throw std::runtime_error("no room for layer 1");
        return {};
    }};
    Delivery delivery(3, sink);
    EXPECT_NO_THROW(delivery.deliver(0));
    EXPECT_THROW(delivery.deliver(1), std::runtime_error);
}

TEST(OrderedStage, StopsForGoodWhenAnOrderedPartThrows) {
    std::vector<std::uint64_t> ordered;
    const LayerSink sink{.prepare = [&](Layer&& layer) -> Commit {
        return [&, index = layer.index] {
            if (index == 1)
                throw std::runtime_error("disk full");
            ordered.push_back(index);
        };
    }};
    Delivery delivery(4, sink);
    delivery.deliver(2);
    delivery.deliver(1);
    EXPECT_THROW(delivery.deliver(0), std::runtime_error);
    EXPECT_NO_THROW(delivery.deliver(3));
    EXPECT_EQ(ordered, (std::vector<std::uint64_t>{0})) << "nothing may follow the failure";
    EXPECT_FALSE(delivery.delivery.wait_for(2)) << "whoever waits must not wait for ever";
    EXPECT_TRUE(delivery.delivery.wait_for(1));
}

TEST(OrderedStage, HoldsBackWhoeverWaitsForAPlane) {
    Delivery delivery(10, nothing_in_order, {.threads = 2});
    std::atomic<int> delivered{0};
    delivery.executor.run([&](unsigned worker) {
        if (worker == 0) {
            for (std::uint32_t plane = 0; plane < 10; ++plane) {
                std::this_thread::yield();
                ++delivered;
                delivery.deliver(plane);
            }
        } else {
            for (std::uint32_t plane = 0; plane <= 10; ++plane) {
                EXPECT_TRUE(delivery.delivery.wait_for(plane));
                EXPECT_GE(delivered, static_cast<int>(plane));
            }
        }
    });
}

TEST(OrderedStage, LetsWaitersGoWhenTheCallerCancels) {
    CancelFlag stop;
    Delivery delivery(10, nothing_in_order, {.threads = 2, .cancel = &stop});
    EXPECT_THROW(delivery.executor.run([&](unsigned worker) {
        if (worker == 0)
            stop.request();
        else
            EXPECT_FALSE(delivery.delivery.wait_for(5));
    }),
                 Error);
}

TEST(OrderedStage, LetsWaitersGoWhenAnotherWorkerFails) {
    const LayerSink sink{.prepare = [](Layer&&) -> Commit {
        throw std::runtime_error("parallel");
    }};
    Delivery delivery(10, sink, {.threads = 2});
    EXPECT_THROW(delivery.executor.run([&](unsigned worker) {
        if (worker == 0)
            delivery.deliver(0);
        else
            EXPECT_FALSE(delivery.delivery.wait_for(1));
    }),
                 std::runtime_error);
}

} // namespace
} // namespace lamella
