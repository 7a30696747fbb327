#include "fixtures/expect_error.hpp"
#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/even_planes.hpp"
#include "slicing/naive_section.hpp"
#include "slicing/paper/paper_engines.hpp"
#include "slicing/paper/serial_engine.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lamella {
namespace {

using test::even_planes;
using test::expect_error;
using test::expect_same;
using test::slice_as_listed;
using test::slice_with;
using test::Triangles;

/// z from -10 to 10.
TriangleSoup body() {
    return test::soup(test::rugged_drum(40, 60));
}

TEST(SerialEngine, FindsTheTwoCutEdgesOfEveryTriangleOnEveryPlane) {
    for (const SliceAt at : {SliceAt::middle, SliceAt::top}) {
        const Plan plan = plan_listed({-1, 0, 0.5, 1, 2, 2.5, 3, 4}, at);
        const Triangles triangles = test::random_triangles(500, 3, 1);
        const TriangleSoup soup = test::soup(triangles);
        const LayerSink sink;
        const Execution execution;
        SliceReport report;
        const Mesh ref = soup;
        const SliceJob job{ref, plan, sink, execution, 0, report};
        const SerialEngine engine(job);
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            const TriangleSections sections = engine.sections(i);
            EXPECT_EQ(sections[1].end, sections[0].begin) << "the upper section is upon the lower one";
            for (std::uint32_t plane = 0; plane < engine.planes(); ++plane) {
                const std::vector<test::CutSegment> expected =
                    test::naive_section({&triangles[i], 1}, plan.layers[plane].z, plan.rule);
                std::vector<test::CutSegment> found;
                for (const TriangleSection& s : sections)
                    if (s.begin <= plane && plane < s.end)
                        found.push_back({{*s.from.low, *s.from.high},
                                         {*s.to.low, *s.to.high},
                                         engine.cut(s.from).at(engine.z(plane)),
                                         engine.cut(s.to).at(engine.z(plane))});
                ASSERT_EQ(found.size(), expected.size()) << "triangle " << i << ", plane " << plane;
                for (std::size_t k = 0; k < found.size(); ++k) {
                    EXPECT_EQ(found[k].from_edge, expected[k].from_edge);
                    EXPECT_EQ(found[k].to_edge, expected[k].to_edge);
                    EXPECT_EQ(found[k].from, expected[k].from);
                    EXPECT_EQ(found[k].to, expected[k].to);
                }
            }
        }
    }
}

class PaperEngine : public testing::TestWithParam<std::string> {
  protected:
    [[nodiscard]] const Engine& tested() const { return engine(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Each, PaperEngine, testing::ValuesIn(test::paper_engines()), test::engine_test_name);

TEST_P(PaperEngine, ReportsTheWeldOfASoupByItself) {
    SliceReport report;
    const LayerStack of_soup = slice_with(GetParam(), body(), even_planes(40), &report);
    EXPECT_GT(report.weld_seconds, 0.0);
    EXPECT_GT(report.link_seconds, 0.0);
    EXPECT_GT(report.slice_seconds, 0.0);
    EXPECT_EQ(report.layers, 40U);
    ASSERT_TRUE(report.matching.has_value());
    const LayerStack of_mesh = slice_as_listed(GetParam(), weld(body()), even_planes(40), &report);
    EXPECT_EQ(report.weld_seconds, 0.0);
    expect_same(of_mesh, of_soup);
}

TEST_P(PaperEngine, HandsLayersOverInOrderAndLetsGoOfThem) {
    const Plan plan = even_planes(100);
    std::uint64_t in_hand = 0;
    LayerStack stack;
    const LayerSink sink{.prepare = [&](Layer&& layer) -> Commit {
        EXPECT_EQ(in_hand++, 0U) << "the one before was not written yet";
        return [&, kept = std::move(layer)]() mutable {
            --in_hand;
            stack.push_back(std::move(kept));
        };
    }};
    slice_to(sink, body(), plan, {.execution = {.threads = 7}, .engine = tested()});
    expect_same(stack, slice(body(), plan));
    std::uint64_t calls = 0;
    const LayerSink without_ordered_part{.prepare = [&](Layer&&) -> Commit {
        ++calls;
        return {};
    }};
    slice_to(without_ordered_part, body(), plan, {.engine = tested()});
    EXPECT_EQ(calls, 100U);
}

TEST_P(PaperEngine, CountsProgressOfEachStageUpToTheWhole) {
    std::vector<Progress> seen;
    const Execution execution{.progress = [&](const Progress& p) {
        seen.push_back(p);
    }};
    (void)slice(body(), even_planes(50), {.execution = execution, .engine = tested()});
    EXPECT_LE(seen.size(), 320U);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        EXPECT_LE(seen[i].done, seen[i].total);
        const bool stage_begins = i == 0 || seen[i].stage != seen[i - 1].stage;
        if (!stage_begins) {
            EXPECT_GE(seen[i].done, seen[i - 1].done);
            EXPECT_EQ(seen[i].total, seen[i - 1].total);
            continue;
        }
        EXPECT_EQ(seen[i].done, 0U);
        if (i > 0) {
            EXPECT_LT(seen[i - 1].stage, seen[i].stage) << "stages come in their order, each once";
            EXPECT_EQ(seen[i - 1].done, seen[i - 1].total);
        }
    }
    ASSERT_FALSE(seen.empty());
    EXPECT_EQ(seen.back().stage, Stage::slice);
    EXPECT_EQ(seen.back().done, 50U);
}

TEST_P(PaperEngine, EndsWhenItIsCancelled) {
    CancelFlag stopped;
    stopped.request();
    const Execution before{.cancel = &stopped};
    expect_error(ErrorKind::cancelled, {},
                 [&] { (void)slice(body(), even_planes(10), {.execution = before, .engine = tested()}); });
    expect_error(ErrorKind::cancelled, {},
                 [&] { (void)slice(TriangleSoup(), Plan(), {.execution = before, .engine = tested()}); });
    for (const Stage stage : {Stage::weld, Stage::link, Stage::slice}) {
        if (stage == Stage::link && GetParam() == "conventional")
            continue; // it has nothing to link
        CancelFlag stop;
        std::uint64_t delivered = 0;
        const Execution execution{.progress =
                                      [&](const Progress& p) {
                                          if (p.stage == stage && p.done >= p.total / 3)
                                              stop.request();
                                      },
                                  .cancel = &stop};
        const LayerSink sink{.prepare = [&](Layer&&) -> Commit {
            ++delivered;
            return {};
        }};
        expect_error(ErrorKind::cancelled, {}, [&] {
            slice_to(sink, body(), even_planes(90), {.execution = execution, .engine = tested()});
        });
        EXPECT_LE(delivered, stage == Stage::slice ? 40U : 0U);
    }
}

TEST_P(PaperEngine, PassesOnWhatTheSinkAndTheProgressFunctionThrow) {
    for (const bool ordered : {false, true}) {
        std::uint64_t delivered = 0;
        const LayerSink sink{.prepare = [&](Layer&& layer) -> Commit {
            if (!ordered && layer.index == 25)
                throw std::runtime_error("disk full");
            return [&delivered, ordered, index = layer.index] {
                if (ordered && index == 25)
                    throw std::runtime_error("disk full");
                ++delivered;
            };
        }};
        EXPECT_THROW(slice_to(sink, body(), even_planes(50), {.engine = tested()}), std::runtime_error);
        EXPECT_EQ(delivered, 25U);
    }
    const Execution execution{.progress = [](const Progress& p) {
        if (p.stage == Stage::slice && p.done == p.total)
            throw std::runtime_error("enough");
    }};
    EXPECT_THROW((void)slice(body(), even_planes(50), {.execution = execution, .engine = tested()}),
                 std::runtime_error);
}

TEST_P(PaperEngine, OfNothingOrBesideTheMeshMakesEmptyLayers) {
    EXPECT_TRUE(slice_with(GetParam(), make_box(1, 1, 1), Plan()).empty());
    for (const LayerStack& stack :
         {slice_with(GetParam(), TriangleSoup(), plan_listed({0, 1})),
          slice_with(GetParam(), IndexedMesh(), plan_listed({0, 1})),
          slice_with(GetParam(), make_box(1, 1, 1), plan_listed({-5, 7})),
          slice_with(GetParam(), test::soup({Triangle3f{}}), plan_listed({0, 1}))}) {
        ASSERT_EQ(stack.size(), 2U);
        for (const Layer& layer : stack) {
            test::expect_sound(layer);
            EXPECT_EQ(layer.contours(), 0U);
        }
    }
}

TEST(SerialEngines, AreThoseThatCount) {
    for (const Engine& one : engines()) {
        LayerStack stack;
        const SliceReport report = slice_to(appending_to(stack), body(), even_planes(5), {.engine = one});
        EXPECT_EQ(report.matching.has_value(), one.welds) << one.name;
        EXPECT_EQ(report.weld_seconds > 0, one.welds) << one.name;
    }
}

} // namespace
} // namespace lamella
