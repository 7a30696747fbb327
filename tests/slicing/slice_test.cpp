#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/slicing/slice.hpp"

#include "even_planes.hpp"
#include "expect_layers.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

namespace lamella::slice_cases {
namespace {

using test::even_planes;
using test::expect_error;
using test::expect_same;

/// Enough contours and planes that several slabs are worth while. z from -10 to 10.
TriangleSoup body() {
    return test::soup(test::rugged_drum(2000, 60));
}

/// Some boxes side by side with level faces at whole heights.
IndexedMesh steps() {
    test::Random random(31);
    std::vector<Mesh> boxes;
    for (int i = 0; i < 12; ++i) {
        const double bottom = static_cast<double>(random.integer(0, 3));
        boxes.push_back(make_box(2, 2, static_cast<double>(random.integer(1, 4)))
                            .transformed(translation(3.0 * i, 0, bottom))
                            .transformed(rotation('z', 10.0 * i)));
    }
    return weld(joined(boxes));
}

IndexedMesh shaken(IndexedMesh mesh, double by) {
    test::Random random(32);
    for (Point3& p : mesh.vertices)
        p.z += random.real(-by, by);
    return mesh;
}

TEST(Slice, CutsFacesThatAreLevelButForRoundingAsFacesOnThePlaneWhereItSnaps) {
    const IndexedMesh level = steps();
    const IndexedMesh bent = shaken(level, 1e-6);
    for (const SliceAt at : {SliceAt::bottom, SliceAt::top}) {
        Plan plan = plan_listed({0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5, 6, 6.5, 7}, at);
        const LayerStack expected = slice(level, plan);
        std::size_t differing = 0;
        const LayerStack without = slice(bent, plan);
        for (std::size_t i = 0; i < without.size(); ++i)
            differing += std::abs(measure(without[i]).area_mm2 - measure(expected[i]).area_mm2) > 1 ? 1 : 0;
        EXPECT_GT(differing, 3U);
        plan.snap_mm = 1e-5;
        for (const Engine& engine : engines()) {
            const LayerStack layers = slice(bent, plan, {.engine = engine});
            const std::vector<double> areas = section_areas(bent, plan);
            ASSERT_EQ(layers.size(), expected.size());
            for (std::size_t i = 0; i < layers.size(); ++i) {
                SCOPED_TRACE(testing::Message() << engine.name << ", layer " << i);
                EXPECT_EQ(layers[i].open_chains(), 0U);
                EXPECT_EQ(layers[i].offsets.size(), expected[i].offsets.size());
                EXPECT_NEAR(measure(layers[i]).area_mm2, measure(expected[i]).area_mm2, 1e-4);
                EXPECT_NEAR(areas[i], measure(expected[i]).area_mm2, 1e-4);
            }
        }
    }
}

TEST(Slice, IsTheSectionOfTheMeshAtAPlaneThatNoVertexIsNearWhateverTheSnapDistance) {
    const IndexedMesh mesh = steps();
    Plan plan = plan_listed({0.25, 1.25, 2.25, 3.25});
    const LayerStack expected = slice(mesh, plan);
    plan.snap_mm = 0.2;
    expect_same(slice(mesh, plan), expected);
}

TEST(Slice, ClosesAllContoursOfClosedMeshesWhateverTheSnapDistance) {
    const IndexedMesh drum = test::indexed(test::rugged_drum(200, 7));
    const Box3 box = bounding_box(drum);
    for (const SliceAt at : {SliceAt::bottom, SliceAt::top})
        for (const double snap : {1e-9, 1e-3, 0.05, 0.2, 3.0}) {
            Plan plan = even_planes(-10, 10, 100, at); // 0.2 apart
            for (PlannedLayer& layer : plan.layers)    // without a height, so that any distance is permitted
                layer.bottom = layer.top = layer.z;
            plan.snap_mm = snap;
            const LayerStack layers = slice(drum, plan, {.execution = {.threads = 3}});
            expect_same(slice(test::soup(test::rugged_drum(200, 7)), plan, {.execution = {.threads = 1}}),
                        layers);
            for (const Layer& layer : layers) {
                test::expect_sound(layer);
                EXPECT_EQ(layer.open_chains(), 0U);
                for (const Point2& p : layer.points)
                    EXPECT_TRUE(box.min.x <= p.x && p.x <= box.max.x && box.min.y <= p.y && p.y <= box.max.y);
            }
            for (const Engine& engine : engines())
                if (engine.name != "conventional") // which goes by points
                    expect_same(slice(drum, plan, {.engine = engine}), layers);
        }
}

TEST(Slice, RefusesAPlanThatDoesNotAscend) {
    Plan plan = even_planes(10);
    std::swap(plan.layers[3], plan.layers[4]);
    for (const Engine& engine : engines())
        expect_error(ErrorKind::usage, {"layer 4 of the plan", "must ascend"},
                     [&] { (void)slice(make_box(1, 1, 1), plan, {.engine = engine}); });
    expect_error(ErrorKind::usage, {"must ascend"}, [&] { (void)section_areas(make_box(1, 1, 1), plan); });
}

TEST(Slice, ReportsWhatItDid) {
    const TriangleSoup soup = body();
    const Plan plan = even_planes(100);
    for (const unsigned threads : {1U, 7U}) {
        LayerStack stack;
        const SliceReport report =
            slice_to(appending_to(stack), soup, plan, {.execution = {.threads = threads}});
        std::uint64_t contours = 0;
        std::uint64_t chains = 0;
        std::uint64_t points = 0;
        for (const Layer& layer : stack) {
            contours += layer.contours();
            chains += layer.open_chains();
            points += layer.points.size();
        }
        EXPECT_EQ(report.layers, 100U);
        EXPECT_EQ(report.contours, contours);
        EXPECT_EQ(report.open_chains, chains);
        EXPECT_EQ(report.points, points);
        EXPECT_GT(report.link_seconds, 0.0);
        EXPECT_GT(report.slice_seconds, 0.0);
    }
}

TEST(SliceTo, HandsOverTheLayersOfSliceInOrder) {
    const TriangleSoup soup = body();
    const Plan plan = even_planes(300);
    const LayerStack expected = slice(soup, plan);
    for (const unsigned threads : {1U, 2U, 7U}) {
        LayerStack stack;
        const SliceReport report =
            slice_to(appending_to(stack), soup, plan, {.execution = {.threads = threads}});
        expect_same(stack, expected);
        EXPECT_EQ(report.layers, 300U);
    }
}

TEST(SliceTo, CallsTheSinkOnceForEveryLayerThatHasNoOrderedPartToo) {
    std::mutex mutex;
    std::vector<std::uint64_t> seen;
    const LayerSink sink{.prepare = [&](Layer&& layer) -> Commit {
        const std::lock_guard lock(mutex);
        seen.push_back(layer.index);
        return {};
    }};
    slice_to(sink, body(), even_planes(200), {.execution = {.threads = 7}});
    std::sort(seen.begin(), seen.end());
    ASSERT_EQ(seen.size(), 200U);
    for (std::uint64_t i = 0; i < 200; ++i)
        EXPECT_EQ(seen[i], i);
}

/// Counts the points of layers from the moment the engine hands them over to the sink's last word on them,
/// and remembers the memory behind them.
class InFlight {
  public:
    [[nodiscard]] LayerSink sink() {
        return {.prepare = [this](Layer&& layer) -> Commit {
            const std::lock_guard lock(mutex_);
            now_ += layer.points.size();
            most_ = std::max(most_, now_);
            if (layer.points.owner())
                blocks_.push_back(layer.points.owner());
            return [this, kept = std::move(layer)] {
                const std::lock_guard inner(mutex_);
                now_ -= kept.points.size();
            };
        }};
    }
    [[nodiscard]] std::uint64_t most_points() const { return most_; }
    [[nodiscard]] std::uint64_t points_left() const { return now_; }
    [[nodiscard]] std::size_t layers_left() const {
        return static_cast<std::size_t>(std::count_if(blocks_.begin(), blocks_.end(),
                                                      [](const auto& block) { return !block.expired(); }));
    }

  private:
    std::mutex mutex_;
    std::uint64_t now_ = 0;
    std::uint64_t most_ = 0;
    std::vector<std::weak_ptr<const void>> blocks_;
};

TEST(SliceTo, BoundsThePointsInFlight) {
    const TriangleSoup soup = body();
    const Plan plan = even_planes(test::slowed ? 100 : 2000);
    std::uint64_t all = 0;
    std::uint64_t largest = 0;
    for (const Layer& layer : slice(soup, plan)) {
        all += layer.points.size();
        largest = std::max<std::uint64_t>(largest, layer.points.size());
    }
    for (const unsigned threads : {1U, 2U, 7U}) {
        for (const std::uint64_t bound : {std::uint64_t{1}, all / 100, all / 10}) {
            InFlight flight;
            slice_to(flight.sink(), soup, plan,
                     {.execution = {.threads = threads}, .points_in_flight = bound});
            EXPECT_LE(flight.most_points(), bound + 2 * threads * largest) << threads << " threads";
            EXPECT_EQ(flight.points_left(), 0U);
            EXPECT_EQ(flight.layers_left(), 0U) << "someone still holds a layer";
        }
    }
}

TEST(SliceTo, GivesTheSameLayersHoweverFewPointsMayBeInFlight) {
    const TriangleSoup soup = body();
    const Plan plan = even_planes(60);
    const LayerStack expected = slice(soup, plan);
    for (const std::uint64_t bound : {1U, 20000U, 100000U}) {
        for (const unsigned threads : {1U, 3U}) {
            LayerStack stack;
            slice_to(appending_to(stack), soup, plan,
                     {.execution = {.threads = threads}, .points_in_flight = bound});
            expect_same(stack, expected);
        }
    }
}

TEST(SliceTo, PassesOnWhatTheSinkThrows) {
    const TriangleSoup soup = body();
    const Plan plan = even_planes(500);
    for (const unsigned threads : {1U, 2U, 7U}) {
        std::vector<std::uint64_t> written;
        const auto throws_in = [&](bool ordered) -> LayerSink {
            return {.prepare = [&written, ordered](Layer&& layer) -> Commit {
                if (!ordered && layer.index == 250)
                    throw std::runtime_error("disk full");
                return [&written, ordered, index = layer.index] {
                    if (ordered && index == 250)
                        throw std::runtime_error("disk full");
                    written.push_back(index);
                };
            }};
        };
        for (const bool ordered : {false, true}) {
            written.clear();
            EXPECT_THROW(slice_to(throws_in(ordered), soup, plan, {.execution = {.threads = threads}}),
                         std::runtime_error);
            EXPECT_LE(written.size(), 250U) << "nothing may be written after the gap";
            for (std::size_t i = 0; i < written.size(); ++i)
                EXPECT_EQ(written[i], i);
        }
    }
}

TEST(Slice, CountsProgressUpToTheWholeInBothStages) {
    const TriangleSoup soup = body();
    const Plan plan = even_planes(300);
    for (const unsigned threads : {1U, 2U, 7U}) {
        std::vector<Progress> seen;
        const Execution execution{.threads = threads, .progress = [&](const Progress& p) {
                                      seen.push_back(p);
                                  }};
        (void)slice(soup, plan, {.execution = execution});
        ASSERT_GE(seen.size(), 4U);
        EXPECT_LE(seen.size(), 220U);
        std::size_t i = 0;
        for (const auto& [stage, total] : {std::pair(Stage::link, std::uint64_t{soup.size()}),
                                           std::pair(Stage::slice, std::uint64_t{300})}) {
            const std::size_t first = i;
            for (; i < seen.size() && seen[i].stage == stage; ++i) {
                EXPECT_EQ(seen[i].total, total);
                EXPECT_LE(seen[i].done, total);
                if (i > first) {
                    EXPECT_GE(seen[i].done, seen[i - 1].done);
                }
            }
            ASSERT_GT(i, first);
            EXPECT_EQ(seen[first].done, 0U);
            EXPECT_EQ(seen[i - 1].done, total);
        }
        EXPECT_EQ(i, seen.size()) << "a stage that does not belong here";
    }
}

TEST(Slice, EndsWhenItWasCancelledBeforeItBegan) {
    CancelFlag stop;
    stop.request();
    for (const unsigned threads : {1U, 2U, 7U}) {
        const Execution execution{.threads = threads, .cancel = &stop};
        expect_error(ErrorKind::cancelled, {},
                     [&] { (void)slice(body(), even_planes(10), {.execution = execution}); });
        expect_error(ErrorKind::cancelled, {},
                     [&] { (void)slice(TriangleSoup(), even_planes(10), {.execution = execution}); });
    }
}

TEST(Slice, EndsWhenItIsCancelledOnTheWay) {
    const TriangleSoup soup = body();
    for (const unsigned threads : {1U, 2U, 7U}) {
        for (const Stage stage : {Stage::link, Stage::slice}) {
            CancelFlag stop;
            const Execution execution{.threads = threads,
                                      .progress =
                                          [&](const Progress& p) {
                                              if (p.stage == stage && p.done >= p.total / 3)
                                                  stop.request();
                                          },
                                      .cancel = &stop};
            expect_error(ErrorKind::cancelled, {},
                         [&] { (void)slice(soup, even_planes(300), {.execution = execution}); });
        }
        CancelFlag stop;
        const LayerSink sink{.prepare = [&](Layer&& layer) -> Commit {
            if (layer.index == 100)
                stop.request();
            return {};
        }};
        expect_error(ErrorKind::cancelled, {}, [&] {
            slice_to(sink, soup, even_planes(2000), {.execution = {.threads = threads, .cancel = &stop}});
        });
    }
}

TEST(Slice, HandsOverNoMoreThanOneLayerAThreadAfterItIsCancelled) {
    const TriangleSoup soup = body();
    for (const unsigned threads : {1U, 2U, 7U}) {
        CancelFlag stop;
        std::atomic<unsigned> after{0};
        const LayerSink sink{.prepare = [&](Layer&& layer) -> Commit {
            after += stop.requested() ? 1 : 0;
            if (layer.index % 100 == 50)
                stop.request();
            return {};
        }};
        expect_error(ErrorKind::cancelled, {}, [&] {
            slice_to(sink, soup, even_planes(2000), {.execution = {.threads = threads, .cancel = &stop}});
        });
        EXPECT_LE(after, threads);
    }
}

TEST(Slice, PassesOnWhatTheProgressFunctionThrows) {
    const TriangleSoup soup = body();
    for (const unsigned threads : {1U, 2U, 7U}) {
        for (const Stage stage : {Stage::link, Stage::slice}) {
            for (const bool at_end : {false, true}) {
                const Execution execution{.threads = threads, .progress = [&](const Progress& p) {
                                              if (p.stage == stage && p.done >= (at_end ? p.total : 0))
                                                  throw std::runtime_error("enough");
                                          }};
                EXPECT_THROW((void)slice(soup, even_planes(300), {.execution = execution}),
                             std::runtime_error);
            }
        }
    }
}

TEST(Slice, KeepsLayersAliveAfterTheMeshIsGone) {
    LayerStack stack;
    {
        const TriangleSoup soup = body();
        stack = slice(soup, even_planes(20));
    }
    const Layer kept = stack[10];
    const std::uint64_t hash = content_hash(kept);
    stack.clear();
    EXPECT_EQ(content_hash(kept), hash);
}

} // namespace
} // namespace lamella::slice_cases
