#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "jobs/plate_builder.hpp"
#include "jobs/plate_slicing.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace lamella::plate_slicing_cases {
namespace {

/// Each of its own object; with copies.
Plate plate_of(std::vector<std::pair<TriangleSoup, std::uint64_t>> shapes) {
    std::vector<PlateInput> inputs;
    std::vector<MeshFile> files;
    for (auto& [mesh, copies] : shapes) {
        inputs.push_back({.path = "a.stl", .copies = copies, .spacing_mm = 0.1});
        MeshFile& file = files.emplace_back();
        file.objects.push_back({"", mesh});
        file.instances.emplace_back();
    }
    return load_plate(inputs, std::move(files), {});
}

Plan plan_of(const Plate& plate, double layer_height) {
    return plan_uniform(plate.box.min.z, plate.box.max.z, {.layer_height = layer_height});
}

/// What a sink was given.
struct Delivered {
    std::vector<std::vector<Layer>> written; ///< planes, in the order in which they were written
    SliceReport report;
};

Delivered deliver(const Plate& plate, const Plan& plan, std::uint64_t points_in_flight,
                  const Execution& execution = {.threads = 3}, const Engine& engine = engines().front()) {
    Delivered delivered;
    const PlateSink sink{.prepare = [&](const Plane& bodies) {
        return [&delivered, kept = bodies.polylines] {
            delivered.written.push_back(kept);
        };
    }};
    delivered.report = slice_plate_to(
        sink, plate, plan, {.execution = execution, .engine = engine, .points_in_flight = points_in_flight});
    return delivered;
}

/// All planes in ascending order, with the layers that each part has by itself.
void expect_layers(const Delivered& delivered, const Plate& plate, const Plan& plan) {
    ASSERT_EQ(delivered.written.size(), plan.layers.size());
    for (std::size_t part = 0; part < plate.parts.size(); ++part) {
        const PlatePart& its = plate.parts[part];
        const LayerStack alone = slice(plate.shapes[its.shape].mesh, plan);
        for (std::size_t i = 0; i < plan.layers.size(); ++i) {
            ASSERT_EQ(delivered.written[i].size(), plate.parts.size());
            const Layer& layer = delivered.written[i][part];
            EXPECT_EQ(layer.index, plan.layers[i].index);
            EXPECT_EQ(layer.z, plan.layers[i].z);
            EXPECT_EQ(layer.bottom, plan.layers[i].bottom);
            EXPECT_EQ(layer.top, plan.layers[i].top);
            EXPECT_TRUE(in_normal_form(layer));
            LayerBuilder moved;
            for (std::size_t c = 0; c < alone[i].contours(); ++c) {
                for (const Point2& p : alone[i].contour(c))
                    moved.add_point({p.x + its.dx, p.y + its.dy});
                moved.end_contour(alone[i].closed(c));
            }
            EXPECT_TRUE(same_contours(layer, moved.finish(0, 0, 0, 0))) << "part " << part << " plane " << i;
        }
    }
}

TEST(PlateSlicing, GivesEachPlaneOnceInOrderWithTheLayersOfItsPartsHoweverFewPointsMayWait) {
    const std::vector<Plate> plates{plate_of({{make_torus(6, 2, 48, 24), 1}}),
                                    plate_of({{make_torus(6, 2, 48, 24), 3}, {make_sphere(3, 3), 1}})};
    for (const Plate& plate : plates) {
        const Plan plan = plan_of(plate, 0.07);
        for (const std::uint64_t points : {0U, 1U, 100U, 2000U, 1'000'000U}) {
            SCOPED_TRACE(testing::Message() << plate.parts.size() << " parts, " << points << " points");
            expect_layers(deliver(plate, plan, points), plate, plan);
        }
    }
}

TEST(PlateSlicing, MakesASourceOfTheSamePlanes) {
    Plate plate = plate_of({{make_torus(6, 2, 48, 24), 3}, {make_sphere(3, 3), 2}});
    const Plan plan = plan_of(plate, 0.3);
    const auto expect_same = [&] {
        const PlaneSource source = planes_of(plate, plan);
        const PlateSink compare{.prepare = [&](const Plane& bodies) {
            const std::vector<Layer> expected = material_of(bodies.polylines, plate.negatives).parts;
            const std::vector<Layer> found = source.plane(bodies.polylines.front().index).polylines;
            EXPECT_EQ(found.size(), expected.size());
            for (std::size_t part = 0; part < expected.size(); ++part)
                EXPECT_TRUE(same_contours(found.at(part), expected[part])) << part;
            return Commit();
        }};
        static_cast<void>(slice_to(compare, plate, plan, {.execution = {.threads = 1}}));
        ASSERT_EQ(source.parts.size(), plate.parts.size());
        EXPECT_EQ(source.parts.back().box, plate.parts.back().box);
    };
    expect_same();
    plate.negatives.push_back(
        {.shape = 1, .dx = plate.parts[0].dx, .box = plate.parts.back().box, .parts = {0}});
    expect_same();
}

TEST(PlateSlicing, SlicesAShapeOnlyWhereItStands) {
    // Boxes on top of each other, and one beside them that reaches over all; planes on their faces, too.
    std::vector<PlateInput> inputs(4);
    std::vector<MeshFile> files(4);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        inputs[i] = {.path = "a.stl", .placement = translation(0, 0, i == 3 ? 0 : static_cast<double>(i))};
        files[i].objects.push_back({"", i == 3 ? make_box(1, 1, 3) : make_box(1, 1, 1)});
        files[i].instances.emplace_back();
    }
    const Plate plate = load_plate(inputs, std::move(files), {});
    for (const PlaneRule rule : {PlaneRule::section_above, PlaneRule::section_below}) {
        Plan plan = plan_uniform(-1, 4, {.layer_height = 0.25}, SliceAt::bottom);
        plan.rule = rule;
        for (const std::uint64_t points : {0U, 40U}) {
            std::uint64_t sliced = 0;
            const Execution told{.threads = 2, .progress = [&](const Progress& progress) {
                                     if (progress.stage == Stage::slice)
                                         sliced = progress.done;
                                 }};
            expect_layers(deliver(plate, plan, points, told), plate, plan);
            // Each on planes from its lower face to its upper one; then all four of them on each plane.
            EXPECT_EQ(sliced, 3 * 5 + 13U + 4 * plan.layers.size());
        }
    }
}

TEST(PlateSlicing, GivesBrokenPartsTheLayersThatTheyHaveAlone) {
    test::Random random(2);
    for (int round = 0; round < 10; ++round) {
        std::vector<Triangle3f> some;
        const TriangleSoup whole = make_torus(6, 2, 24, 12);
        for (std::size_t i = 0; i < whole.size(); ++i)
            if (random.integer(0, 5) != 0)
                some.push_back(whole.stored(i));
        const Plate plate = plate_of({{TriangleSoup(some), 2}, {make_box(1, 2, 3), 1}});
        const Plan plan = plan_of(plate, 0.3);
        expect_layers(deliver(plate, plan, static_cast<std::uint64_t>(random.integer(0, 500))), plate, plan);
    }
}

TEST(PlateSlicing, KeepsTheNormalFormWhereMovingMakesPointsEqual) {
    // Two rings whose first points differ by less than numbers can tell where the part stands: there the
    // other coordinate decides which comes first.
    const auto box_at = [](float x, float y) {
        std::vector<Triangle3f> triangles;
        const TriangleSoup box = make_box(1, 1, 1);
        for (std::size_t i = 0; i < box.size(); ++i) {
            Triangle3f t = box.stored(i);
            for (Point3f& p : t)
                p = {p.x + x, p.y + y, p.z};
            triangles.push_back(t);
        }
        return triangles;
    };
    std::vector<Triangle3f> both = box_at(1e-6F, 0);
    const std::vector<Triangle3f> other = box_at(0, 5);
    both.insert(both.end(), other.begin(), other.end());
    Plate plate = plate_of({{TriangleSoup(both), 2}});
    plate.parts[1].dx = 0x1p40;
    const Plan plan = plan_of(plate, 0.5);
    const Delivered delivered = deliver(plate, plan, 0);
    const Layer& here = delivered.written.front()[0];
    const Layer& there = delivered.written.front()[1];
    EXPECT_EQ(here.contour(0).front().y, 5);
    EXPECT_EQ(there.contour(0).front().y, 0);
    expect_layers(delivered, plate, plan);
}

TEST(PlateSlicing, SlicesAShapeOnceForAllItsParts) {
    const TriangleSoup torus = make_torus(6, 2, 24, 16);
    const Engine& counting = engine("eecc");
    const Plate one = plate_of({{torus, 1}});
    const Plate nine = plate_of({{torus, 9}});
    const Plan plan = plan_of(one, 0.5);
    const SliceReport alone = deliver(one, plan, 0, {}, counting).report;
    const SliceReport together = deliver(nine, plan, 0, {}, counting).report;
    ASSERT_TRUE(alone.matching && together.matching);
    EXPECT_EQ(together.matching->inserted.total(), alone.matching->inserted.total());
}

TEST(PlateSlicing, ReportsProgressOfAllWindowsAsThatOfOneRunToItsEnd) {
    const Plate plate = plate_of({{make_torus(6, 2, 48, 24), 2}, {make_sphere(3, 3), 2}});
    const Plan plan = plan_of(plate, 0.1);
    for (const std::uint64_t points : {0U, 1000U}) {
        std::map<Stage, Progress> last;
        const Execution told{.threads = 2, .progress = [&](const Progress& progress) {
                                 Progress& before = last[progress.stage];
                                 EXPECT_GE(progress.done, before.done) << stage_name(progress.stage);
                                 EXPECT_TRUE(before.total == 0 || before.total == progress.total);
                                 before = progress;
                             }};
        static_cast<void>(deliver(plate, plan, points, told));
        ASSERT_TRUE(last.contains(Stage::slice) && last.contains(Stage::link));
        for (const auto& [stage, progress] : last)
            EXPECT_EQ(progress.done, progress.total) << stage_name(stage);
        // The torus has no layers above and below it.
        const auto of_the_torus =
            std::count_if(plan.layers.begin(), plan.layers.end(),
                          [](const PlannedLayer& layer) { return -2 < layer.z && layer.z < 2; });
        EXPECT_EQ(last[Stage::slice].total,
                  plan.layers.size() + static_cast<std::uint64_t>(of_the_torus) + 4 * plan.layers.size());
    }
}

TEST(PlateSlicing, IsNotAtTheEndOfItsProgressWhileManyCopiesAreMadeOfAFewLayers) {
    const Plate plate = plate_of({{make_box(1, 2, 5), 200}});
    const Plan plan = plan_of(plate, 0.5);
    Progress now;
    const Execution told{.threads = 1, .progress = [&](const Progress& progress) {
                             now = progress;
                         }};
    double first = 1;
    const PlateSink sink{.prepare = [&](const Plane&) -> Commit {
        if (now.stage == Stage::slice && now.total > 0)
            first = std::min(first, static_cast<double>(now.done) / static_cast<double>(now.total));
        return {};
    }};
    static_cast<void>(slice_to(sink, plate, plan, {.execution = told}));
    EXPECT_LT(first, 0.01);
    EXPECT_EQ(now.done, now.total);
}

/// In how many windows the plate is sliced: each looks at all triangles, so many of them are told of a stage.
std::uint64_t windows_of(const Plate& plate, const Plan& plan, std::uint64_t points_in_flight,
                         const Engine& engine = engines().front(), Stage stage = Stage::link) {
    std::uint64_t triangles = 0;
    for (const PlateShape& shape : plate.shapes)
        triangles += shape.mesh.size();
    std::uint64_t looked_at = 0;
    const Execution execution{.threads = 1, .progress = [&](const Progress& progress) {
                                  if (progress.stage == stage)
                                      looked_at = progress.total;
                              }};
    static_cast<void>(deliver(plate, plan, points_in_flight, execution, engine));
    EXPECT_EQ(looked_at % triangles, 0U);
    return looked_at / triangles;
}

TEST(PlateSlicing, FillsWindowsWithTwiceThePointsInFlight) {
    // 2 x 10 points of the walls of a cylinder and 8 of a box on each plane.
    const Plate plate = plate_of({{make_cylinder(3, 5, 10), 2}, {make_box(1, 2, 5), 1}});
    const Plan plan = plan_of(plate, 0.1);
    ASSERT_EQ(plan.layers.size(), 50U);
    constexpr std::uint64_t points_of_a_plane = 28;
    for (const std::uint64_t points_in_flight : {1U, 14U, 27U, 28U, 41U, 42U, 200U, 699U, 700U}) {
        const std::uint64_t planes = std::max<std::uint64_t>(1, 2 * points_in_flight / points_of_a_plane);
        EXPECT_EQ(windows_of(plate, plan, points_in_flight), (50 + planes - 1) / planes) << points_in_flight;
    }
}

TEST(PlateSlicing, SlicesAllPlanesAtOnceWhereTheEngineWelds) {
    const Plate plate = plate_of({{make_cylinder(3, 5, 10), 2}, {make_box(1, 2, 5), 1}});
    EXPECT_EQ(windows_of(plate, plan_of(plate, 0.1), 1, engine("eecc")), 1U);
}

TEST(PlateSlicing, HandsAFewPlanesAtATimeToASinkThatMakesMuchOfThem) {
    const Plate plate = plate_of({{make_torus(6, 2, 24, 16), 1}});
    const Plan plan = plan_of(plate, 0.02);
    std::atomic<std::int64_t> on_their_way{0};
    std::atomic<std::int64_t> most{0};
    std::vector<std::uint64_t> written;
    const PlateSink sink{.prepare = [&](const Plane& bodies) -> Commit {
        const std::int64_t now = ++on_their_way;
        for (std::int64_t before = most; before < now && !most.compare_exchange_weak(before, now);) {
        }
        return [&, index = bodies.polylines.front().index] {
            --on_their_way;
            written.push_back(index);
        };
    }};
    std::vector<Progress> told;
    const Execution execution{.threads = 2, .progress = [&](const Progress& progress) {
                                  if (progress.stage == Stage::slice)
                                      told.push_back(progress);
                              }};
    static_cast<void>(slice_plate_to(
        sink, plate, plan, {.execution = execution, .points_in_flight = 1'000'000}, SinkCost::expanding));
    EXPECT_EQ(written.size(), plan.layers.size());
    EXPECT_TRUE(std::is_sorted(written.begin(), written.end()));
    EXPECT_LE(most, 8);
    // Contents of is what the sink has done.
    ASSERT_GT(told.size(), 10U);
    for (std::size_t i = 0; i < told.size(); ++i) {
        EXPECT_EQ(told[i].total, plan.layers.size());
        EXPECT_GE(told[i].done, i == 0 ? 0 : told[i - 1].done);
    }
    EXPECT_EQ(told.front().done, 0U);
    EXPECT_EQ(told.back().done, plan.layers.size());
}

TEST(PlateSlicing, PassesOnTheLayersOfEachBodyForAnyThreads) {
    const Plate plate = plate_of({{make_torus(6, 2, 48, 24), 2}, {make_box(1, 2, 3), 1}});
    const Plan plan = plan_of(plate, 0.3);
    for (const unsigned threads : {1U, 2U, 7U}) {
        Delivered delivered;
        const PlateSink sink{.prepare = [&](const Plane& bodies) -> Commit {
            return [&delivered, kept = bodies.polylines] {
                delivered.written.push_back(kept);
            };
        }};
        delivered.report = slice_to(sink, plate, plan, {.execution = {.threads = threads}});
        expect_layers(delivered, plate, plan);
    }
}

TEST(PlateSlicing, FillsEachBodyBeforeNegativeVolumesAreSubtracted) {
    const auto square = [](double x, double side) {
        return std::vector<Point2>{{x, 0}, {x + side, 0}, {x + side, side}, {x, side}};
    };
    const auto layer_of = [](const std::vector<std::vector<Point2>>& rings) {
        LayerBuilder builder;
        for (const std::vector<Point2>& ring : rings)
            builder.add_contour(ring, true);
        return builder.finish(0, 0.5, 0, 1);
    };
    const std::vector<Layer> bodies{layer_of({square(0, 4), square(2, 4)}), layer_of({square(20, 4)}),
                                    layer_of({square(1, 2), square(2, 2)})};
    const std::vector<PlateNegative> negatives{{.shape = 0, .dx = 0, .dy = 0, .box = {}, .parts = {0}}};
    const PlateMaterial made =
        material_of(bodies, negatives, {.fill = FillRule::nonzero, .min_area_mm2 = 20});
    ASSERT_EQ(made.bodies.size(), 3U);
    EXPECT_EQ(made.bodies[0].rings, 1U);
    EXPECT_EQ(made.bodies[2].rings, 1U);
    ASSERT_EQ(made.parts.size(), 2U);
    EXPECT_TRUE(made.parts[0].points.empty()) << "6 x 4 mm less 3 x 2 mm are below 20 mm2";
    EXPECT_TRUE(made.parts[1].points.empty());
    EXPECT_EQ(made.changes.changed_layers, 1U);
    EXPECT_EQ(made.changes.groups_united, 2U);
    const PlateMaterial plain = material_of(bodies, {});
    ASSERT_EQ(plain.parts.size(), bodies.size());
    EXPECT_TRUE(plain.bodies.empty());
    for (std::size_t i = 0; i < bodies.size(); ++i)
        EXPECT_TRUE(same_contours(plain.parts[i], bodies[i]));
    EXPECT_EQ(plain.changes.changed_layers, 0U);
}

TEST(PlateSlicing, RefusesAPlanThatDoesNotAscendEvenBesideAllParts) {
    for (const std::uint64_t copies : {1U, 2U}) {
        const Plate plate = plate_of({{make_box(1, 1, 1), copies}});
        EXPECT_TRUE(slice(plate, Plan()).empty());
        Plan plan = plan_uniform(5, 6, {.layer_height = 0.5});
        std::swap(plan.layers.front(), plan.layers.back());
        test::expect_error(ErrorKind::usage, {"must ascend"}, [&] { (void)slice(plate, plan); });
    }
}

TEST(PlateSlicing, MakesEmptyLayersOfAPlateWithoutParts) {
    const Plan plan = plan_uniform(0, 1, {.layer_height = 0.5});
    const LayerStack layers = slice(Plate(), plan);
    ASSERT_EQ(layers.size(), 2U);
    EXPECT_EQ(layers[1].z, plan.layers[1].z);
    EXPECT_EQ(layers[1].contours(), 0U);
}

TEST(PlateSlicing, ReportsTheContentOfTheLayersAndVisitsEachTriangleOfEachShape) {
    for (const std::uint64_t copies : {1U, 3U}) {
        const Plate plate = plate_of({{make_torus(6, 2, 48, 24), copies}, {make_sphere(3, 3), 1}});
        const Plan plan = plan_of(plate, 0.1);
        std::atomic<std::uint64_t> visited{0};
        LayerStack layers;
        const SliceReport report = slice_to(
            appending_to(layers), plate, plan,
            {.points_in_flight = 5000, .visitor = [&](const Mesh&, std::uint64_t begin, std::uint64_t end) {
                 visited += end - begin;
             }});
        std::uint64_t contours = 0;
        std::uint64_t points = 0;
        for (const Layer& layer : layers) {
            contours += layer.contours();
            points += layer.points.size();
        }
        EXPECT_EQ(report.layers, plan.layers.size());
        EXPECT_EQ(report.contours, contours);
        EXPECT_EQ(report.points, points);
        EXPECT_EQ(visited, plate.shapes[0].mesh.size() + plate.shapes[1].mesh.size());
    }
}

TEST(PlateSlicing, StopsWithWhatTheSinkThrows) {
    const Plate plate = plate_of({{make_torus(6, 2, 24, 16), 2}});
    const Plan plan = plan_of(plate, 0.1);
    std::size_t written = 0;
    const auto slice_until = [&](bool in_order) {
        const PlateSink sink{.prepare = [&, in_order](const Plane& bodies) -> Commit {
            const bool now = bodies.polylines.front().index == 20;
            if (now && !in_order)
                throw Error(ErrorKind::output, "no room");
            return [&written, now] {
                if (now)
                    throw Error(ErrorKind::output, "no room");
                ++written;
            };
        }};
        test::expect_error(ErrorKind::output, {"no room"}, [&] {
            static_cast<void>(
                slice_plate_to(sink, plate, plan, {.execution = {.threads = 2}, .points_in_flight = 500}));
        });
    };
    slice_until(true);
    EXPECT_EQ(written, 20U);
    written = 0;
    slice_until(false);
    EXPECT_LE(written, 20U);
}

} // namespace
} // namespace lamella::plate_slicing_cases
