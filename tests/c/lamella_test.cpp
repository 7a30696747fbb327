#include "lamella/c/lamella.h"
#include "lamella/contour/close_gaps.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/meshes/mesh_writer.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/offset.hpp"
#include "lamella/slicing/layering.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include "fixtures/layers.hpp"
#include "parts/shapes.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace lamella::c_cases {
namespace {

template <auto free>
struct Free {
    template <class T>
    void operator()(T* handle) const {
        free(handle);
    }
};
using CMesh = std::unique_ptr<lamella_mesh, Free<lamella_free_mesh>>;
using CLayers = std::unique_ptr<lamella_layers, Free<lamella_free_layers>>;
using CSlicer = std::unique_ptr<lamella_slicer, Free<lamella_free_slicer>>;

/// Returns a struct whose other fields are zero.
template <class T>
T sized() {
    T made{};
    made.size = sizeof(T);
    return made;
}

CMesh mesh_of(const IndexedMesh& mesh) {
    lamella_mesh* made = nullptr;
    EXPECT_EQ(lamella_make_mesh(&mesh.vertices.front().x, mesh.vertices.size(), mesh.triangles.front().data(),
                                mesh.triangles.size(), &made),
              LAMELLA_OK)
        << lamella_error();
    return CMesh(made);
}

Layer plain(const lamella_layer& layer) {
    const auto* const points = reinterpret_cast<const Point2*>(layer.points);
    return {.index = layer.index,
            .z = layer.z,
            .bottom = layer.bottom,
            .top = layer.top,
            .points = PointArray(std::vector<Point2>(points, points + layer.point_count)),
            .offsets = {layer.offsets, layer.offsets + layer.contour_count + 1},
            .rings = layer.rings};
}

TEST(C, GivesTheLayersOfTheLibrary) {
    const IndexedMesh torus = weld(make_torus(6, 2, 40, 20));
    const Plan plan = plan_uniform(-2, 2, {.layer_height = 0.1});
    const LayerStack expected = slice(torus, plan);
    const CMesh mesh = mesh_of(torus);
    lamella_layers* sliced = nullptr;
    ASSERT_EQ(lamella_slice(mesh.get(), 0.1, nullptr, &sliced), LAMELLA_OK) << lamella_error();
    const CLayers layers(sliced);
    EXPECT_STREQ(lamella_warnings(), "");
    ASSERT_EQ(lamella_layer_count(layers.get()), expected.size());
    lamella_slicer* prepared = nullptr;
    ASSERT_EQ(lamella_prepare(mesh.get(), LAMELLA_SECTION_ABOVE, nullptr, &prepared), LAMELLA_OK);
    const CSlicer slicer(prepared);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        auto layer = sized<lamella_layer>();
        ASSERT_EQ(lamella_get_layer(layers.get(), i, &layer), LAMELLA_OK);
        EXPECT_TRUE(same_contours(plain(layer), expected[i]));
        EXPECT_EQ(layer.index, i);
        EXPECT_EQ(layer.bottom, expected[i].bottom);
        lamella_layers* cut = nullptr;
        ASSERT_EQ(lamella_section(slicer.get(), layer.z, &cut), LAMELLA_OK);
        const CLayers section(cut);
        ASSERT_EQ(lamella_get_layer(section.get(), 0, &layer), LAMELLA_OK);
        EXPECT_TRUE(same_contours(plain(layer), expected[i]));
    }
}

TEST(C, WarnsOfWhatIsLost) {
    IndexedMesh open = weld(make_box(4, 4, 4));
    open.triangles.pop_back();
    const CMesh mesh = mesh_of(open);
    lamella_layers* sliced = nullptr;
    ASSERT_EQ(lamella_slice(mesh.get(), 1, nullptr, &sliced), LAMELLA_OK);
    const CLayers layers(sliced);
    EXPECT_NE(std::string(lamella_warnings()).find("open"), std::string::npos) << lamella_warnings();
    EXPECT_GT(lamella_triangle_count(mesh.get()), 0U); // takes no warning away
    EXPECT_STRNE(lamella_warnings(), "");
}

TEST(C, RefusesWhatItCannotUse) {
    const CMesh box = mesh_of(weld(make_box(1, 1, 1)));
    lamella_mesh* mesh = nullptr;
    lamella_layers* layers = nullptr;
    lamella_slicer* slicer = nullptr;
    auto layer = sized<lamella_layer>();
    double numbers[12] = {};
    const double none = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(lamella_read_mesh(nullptr, nullptr, &mesh), LAMELLA_USAGE);
    EXPECT_STREQ(lamella_error(), "path: found a null pointer");
    EXPECT_EQ(lamella_read_mesh("x", nullptr, nullptr), LAMELLA_USAGE);
    EXPECT_EQ(lamella_slice(nullptr, 1, nullptr, &layers), LAMELLA_USAGE);
    EXPECT_EQ(lamella_slice(box.get(), 0, nullptr, &layers), LAMELLA_USAGE);
    EXPECT_EQ(lamella_slice(box.get(), none, nullptr, &layers), LAMELLA_USAGE);
    EXPECT_EQ(lamella_slice_at(box.get(), nullptr, 3, nullptr, &layers), LAMELLA_USAGE);
    EXPECT_EQ(lamella_slice_at(box.get(), numbers, 2, nullptr, &layers), LAMELLA_USAGE); // 0 and 0
    // Counts that no array has, such as -1, and threads that no system has.
    const std::uint32_t corners[3] = {0, 0, 0};
    const std::size_t absurd = static_cast<std::size_t>(-1);
    EXPECT_EQ(lamella_make_mesh(numbers, absurd, corners, 1, &mesh), LAMELLA_USAGE);
    EXPECT_EQ(lamella_make_mesh(numbers, 1, corners, absurd, &mesh), LAMELLA_USAGE);
    EXPECT_EQ(lamella_slice_at(box.get(), numbers, absurd, nullptr, &layers), LAMELLA_USAGE);
    EXPECT_EQ(lamella_read_mesh_bytes(numbers, absurd, "x.stl", nullptr, &mesh), LAMELLA_USAGE);
    auto many_threads = sized<lamella_settings>();
    many_threads.threads = 4'000'000'000;
    EXPECT_EQ(lamella_slice(box.get(), 1, &many_threads, &layers), LAMELLA_USAGE);
    EXPECT_NE(std::string(lamella_error()).find("threads: found 4000000000"), std::string::npos)
        << lamella_error();
    EXPECT_EQ(lamella_prepare(nullptr, LAMELLA_SECTION_ABOVE, nullptr, &slicer), LAMELLA_USAGE);
    EXPECT_EQ(lamella_section(nullptr, 1, &layers), LAMELLA_USAGE);
    EXPECT_EQ(lamella_transform_mesh(box.get(), nullptr, &mesh), LAMELLA_USAGE);
    const double flat[12] = {0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}; // x becomes 0
    EXPECT_EQ(lamella_transform_mesh(box.get(), flat, &mesh), LAMELLA_USAGE);
    EXPECT_EQ(lamella_mesh_box(box.get(), nullptr), LAMELLA_USAGE);
    EXPECT_EQ(lamella_get_layer(nullptr, 0, &layer), LAMELLA_USAGE);
    EXPECT_EQ(lamella_write_layers(nullptr, "x.cli", nullptr, nullptr), LAMELLA_USAGE);
    EXPECT_EQ(lamella_layer_count(nullptr), 0U);
    EXPECT_EQ(lamella_triangle_count(nullptr), 0U);
    ASSERT_EQ(lamella_slice(box.get(), 0.5, nullptr, &layers), LAMELLA_OK);
    const CLayers kept(layers);
    EXPECT_EQ(lamella_get_layer(kept.get(), 2, &layer), LAMELLA_USAGE);
    EXPECT_EQ(lamella_write_layers(kept.get(), "part.unknown", nullptr, nullptr), LAMELLA_USAGE);
    const TemporaryFolder folder;
    EXPECT_EQ(lamella_write_layers(kept.get(), folder.file("no/part.cli").c_str(), nullptr, nullptr),
              LAMELLA_OUTPUT);
    auto small = sized<lamella_settings>();
    small.max_memory = 1000;
    const std::string path = folder.file("torus.obj");
    write_obj(path, weld(make_torus(6, 2, 40, 20)), "torus");
    EXPECT_EQ(lamella_read_mesh(path.c_str(), &small, &mesh), LAMELLA_LIMIT) << lamella_error();
    EXPECT_EQ(mesh, nullptr);
    EXPECT_EQ(slicer, nullptr);
}

CLayers layers_of(const LayerStack& stack) {
    EXPECT_EQ(stack.size(), 1U);
    const Layer& from = stack.front();
    auto layer = sized<lamella_layer>();
    layer.index = from.index;
    layer.z = from.z;
    layer.bottom = from.bottom;
    layer.top = from.top;
    layer.points = &from.points.data()->x;
    layer.point_count = from.points.size();
    layer.offsets = from.offsets.data();
    layer.contour_count = from.contours();
    layer.rings = from.rings;
    lamella_layers* made = nullptr;
    EXPECT_EQ(lamella_make_layer(&layer, &made), LAMELLA_OK) << lamella_error();
    return CLayers(made);
}

Layer first_of(const lamella_layers* layers) {
    auto layer = sized<lamella_layer>();
    EXPECT_EQ(lamella_get_layer(layers, 0, &layer), LAMELLA_OK) << lamella_error();
    return plain(layer);
}

TEST(C, CutsByThePlansOfTheLibrary) {
    const IndexedMesh torus = weld(make_torus(6, 2, 40, 20));
    const CMesh mesh = mesh_of(torus);
    const auto expect_layers = [&](const auto& set, const Layering& layering) {
        auto plan = sized<lamella_plan>();
        set(plan);
        const Plan expected = plan_of(layering, bounding_box(torus), [&] { return Mesh(torus); });
        const LayerStack of_library = slice(torus, expected);
        lamella_layers* sliced = nullptr;
        ASSERT_EQ(lamella_slice_by_plan(mesh.get(), &plan, nullptr, &sliced), LAMELLA_OK) << lamella_error();
        const CLayers layers(sliced);
        ASSERT_EQ(lamella_layer_count(layers.get()), of_library.size());
        for (std::size_t i = 0; i < of_library.size(); ++i) {
            auto layer = sized<lamella_layer>();
            ASSERT_EQ(lamella_get_layer(layers.get(), i, &layer), LAMELLA_OK);
            EXPECT_TRUE(same_contours(plain(layer), of_library[i])) << i;
            EXPECT_EQ(layer.z, of_library[i].z);
        }
    };
    expect_layers([](lamella_plan&) {}, {});
    expect_layers(
        [](lamella_plan& plan) {
            plan.layer_height = 0.5;
            plan.cut = LAMELLA_CUT_BOTTOM;
        },
        {.cut = UniformLayers{.layer_height = 0.5}, .at = SliceAt::bottom});
    expect_layers(
        [](lamella_plan& plan) {
            plan.layer_height = 0.5;
            plan.first_layer_height = 1;
            plan.cut = LAMELLA_CUT_TOP;
        },
        {.cut = UniformLayers{.layer_height = 0.5, .first_layer_height = 1}, .at = SliceAt::top});
    expect_layers(
        [](lamella_plan& plan) {
            plan.layer_height = 1;
            plan.cut = LAMELLA_CUT_BOTTOM;
            plan.snap = 0.01;
        },
        {.cut = UniformLayers{.layer_height = 1}, .at = SliceAt::bottom, .snap_mm = 0.01});
    expect_layers(
        [](lamella_plan& plan) {
            plan.min_height = 0.1;
            plan.max_height = 0.4;
            plan.cusp = 0.02;
        },
        {.cut = AdaptiveLayers{.min_height = 0.1, .max_height = 0.4, .cusp_mm = 0.02}});
}

TEST(C, CutsBelowAPlaneIfAsked) {
    const CMesh box = mesh_of(weld(make_box(2, 2, 2)));
    for (const auto& [rule, area] : {std::pair{LAMELLA_SECTION_ABOVE, 0.0}, {LAMELLA_SECTION_BELOW, 4.0}}) {
        lamella_slicer* prepared = nullptr;
        ASSERT_EQ(lamella_prepare(box.get(), rule, nullptr, &prepared), LAMELLA_OK);
        const CSlicer slicer(prepared);
        double corners[6];
        ASSERT_EQ(lamella_mesh_box(box.get(), corners), LAMELLA_OK);
        lamella_layers* cut = nullptr;
        ASSERT_EQ(lamella_section(slicer.get(), corners[5], &cut), LAMELLA_OK); // the plane of the lid
        const CLayers section(cut);
        auto layer = sized<lamella_layer>();
        ASSERT_EQ(lamella_get_layer(section.get(), 0, &layer), LAMELLA_OK);
        EXPECT_DOUBLE_EQ(layer.area_mm2, area);
    }
}

TEST(C, MendsMeshes) {
    IndexedMesh flipped = weld(make_torus(6, 2, 40, 20));
    const CMesh sound = mesh_of(flipped);
    for (std::size_t i = 0; i < flipped.triangles.size(); i += 5)
        std::swap(flipped.triangles[i][0], flipped.triangles[i][1]);
    flipped.triangles.push_back(flipped.triangles.front());
    const CMesh mesh = mesh_of(flipped);
    auto mending = sized<lamella_mending>();
    mending.drop_duplicates = 1;
    mending.orient = 1;
    auto counts = sized<lamella_mended>();
    lamella_mesh* made = nullptr;
    ASSERT_EQ(lamella_mend(mesh.get(), &mending, nullptr, &counts, &made), LAMELLA_OK) << lamella_error();
    const CMesh mended(made);
    EXPECT_EQ(counts.repeated_triangles, 1U);
    EXPECT_EQ(counts.flipped_triangles, 320U);
    EXPECT_EQ(lamella_triangle_count(mended.get()), 1600U);
    lamella_layers* sliced[2] = {};
    ASSERT_EQ(lamella_slice(mended.get(), 0.5, nullptr, &sliced[0]), LAMELLA_OK);
    const CLayers of_mended(sliced[0]);
    EXPECT_STREQ(lamella_warnings(), "");
    ASSERT_EQ(lamella_slice(sound.get(), 0.5, nullptr, &sliced[1]), LAMELLA_OK);
    const CLayers of_sound(sliced[1]);
    EXPECT_TRUE(same_contours(first_of(of_mended.get()), first_of(of_sound.get())));
    auto nothing = sized<lamella_mending>();
    EXPECT_EQ(lamella_mend(mesh.get(), &nothing, nullptr, nullptr, &made), LAMELLA_USAGE);
}

TEST(C, ChangesLayersAsTheLibraryDoes) {
    const Layer ring =
        test::normal_layer({test::rectangle(0, 0, 9, 9), test::reversed(test::rectangle(3, 3, 6, 6))});
    const Layer other = test::normal_layer({test::rectangle(4, -1, 20, 4)});
    const CLayers layers = layers_of({ring});
    const CLayers others = layers_of({other});
    EXPECT_TRUE(same_contours(first_of(layers.get()), ring));
    std::int64_t parents[2] = {};
    ASSERT_EQ(lamella_ring_parents(layers.get(), 0, parents), LAMELLA_OK);
    EXPECT_EQ(parents[0], -1);
    EXPECT_EQ(parents[1], 0);
    const auto expect = [](const Layer& expected, auto&& call) {
        lamella_layers* result = nullptr;
        ASSERT_EQ(call(&result), LAMELLA_OK) << lamella_error();
        const CLayers made(result);
        EXPECT_TRUE(same_contours(first_of(made.get()), expected));
    };
    expect(offset(ring, -0.5),
           [&](auto to) { return lamella_offset(layers.get(), -0.5, nullptr, nullptr, to); });
    auto round = sized<lamella_corners>();
    round.join = LAMELLA_ROUND;
    round.arc_tolerance = 0.1;
    expect(offset(ring, 1, {.corners = {.shape = OffsetCorner::round, .arc_tolerance_mm = 0.1}}),
           [&](auto to) { return lamella_offset(layers.get(), 1, &round, nullptr, to); });
    auto blunt = sized<lamella_corners>();
    blunt.mitre_limit = 1.1;
    expect(offset(ring, 1, {.corners = {.mitre_limit = 1.1}}),
           [&](auto to) { return lamella_offset(layers.get(), 1, &blunt, nullptr, to); });
    for (const auto& [operation, expected] : {std::pair{LAMELLA_UNION, BooleanOperation::unite},
                                              {LAMELLA_INTERSECTION, BooleanOperation::intersect},
                                              {LAMELLA_DIFFERENCE, BooleanOperation::subtract},
                                              {LAMELLA_EXCLUSION, BooleanOperation::exclude}})
        expect(combine(ring, other, expected), [&, how = operation](auto to) {
            return lamella_combine(layers.get(), others.get(), how, nullptr, to);
        });
}

TEST(C, ClosesGaps) {
    const Layer open = test::normal_layer({}, {{{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0.01}}});
    const CLayers layers = layers_of({open});
    lamella_layers* result = nullptr;
    std::uint64_t closed = 0;
    ASSERT_EQ(lamella_close_gaps(layers.get(), 0.1, nullptr, &closed, &result), LAMELLA_OK)
        << lamella_error();
    const CLayers made(result);
    EXPECT_EQ(closed, 1U);
    EXPECT_TRUE(same_contours(first_of(made.get()), close_gaps(open, 0.1).layer));
    EXPECT_EQ(lamella_close_gaps(layers.get(), 0, nullptr, nullptr, &result), LAMELLA_USAGE);
}

TEST(C, WritesTheBytesOfTheFile) {
    const CMesh box = mesh_of(weld(make_box(4, 4, 4)));
    lamella_layers* sliced = nullptr;
    ASSERT_EQ(lamella_slice(box.get(), 1, nullptr, &sliced), LAMELLA_OK);
    const CLayers layers(sliced);
    const TemporaryFolder folder;
    for (const char* const format : {"cli", "svg", "npz"}) {
        const std::string path = folder.file("layers");
        ASSERT_EQ(lamella_write_layers(layers.get(), path.c_str(), format, nullptr), LAMELLA_OK);
        std::ifstream file(path, std::ios::binary);
        const std::string written{std::istreambuf_iterator<char>(file), {}};
        lamella_bytes* made = nullptr;
        ASSERT_EQ(lamella_write_layers_bytes(layers.get(), format, nullptr, &made), LAMELLA_OK)
            << lamella_error();
        const std::unique_ptr<lamella_bytes, Free<lamella_free_bytes>> bytes(made);
        const std::string in_memory(static_cast<const char*>(lamella_bytes_data(made)),
                                    lamella_bytes_size(made));
        EXPECT_EQ(in_memory, written) << format;
        lamella_layers* read = nullptr;
        ASSERT_EQ(lamella_read_layers_bytes(in_memory.data(), in_memory.size(), "it", nullptr, &read),
                  LAMELLA_OK);
        const CLayers again(read);
        EXPECT_EQ(lamella_layer_count(again.get()), 4U);
    }
}

TEST(C, ReadsStructsOfOtherVersions) {
    struct Newer {
        lamella_settings known = sized<lamella_settings>();
        std::uint64_t unknown[3] = {};
    };
    Newer newer;
    newer.known.size = sizeof newer;
    const CMesh box = mesh_of(weld(make_box(1, 1, 1)));
    lamella_layers* sliced = nullptr;
    ASSERT_EQ(lamella_slice(box.get(), 1, &newer.known, &sliced), LAMELLA_OK) << lamella_error();
    const CLayers layers(sliced);
    newer.unknown[1] = 1;
    EXPECT_EQ(lamella_slice(box.get(), 1, &newer.known, &sliced), LAMELLA_USAGE);
    EXPECT_NE(std::string(lamella_error()).find("settings: has fields that"), std::string::npos);
    for (const std::size_t size : {std::size_t{0}, sizeof(lamella_settings) - 1, std::size_t(-1)}) {
        newer.known.size = size;
        EXPECT_EQ(lamella_slice(box.get(), 1, &newer.known, &sliced), LAMELLA_USAGE);
        EXPECT_NE(std::string(lamella_error()).find("settings: its size is"), std::string::npos);
    }
    lamella_layer layer{};
    EXPECT_EQ(lamella_get_layer(layers.get(), 0, &layer), LAMELLA_USAGE);
    struct NewerLayer {
        lamella_layer known = sized<lamella_layer>();
        std::uint64_t unknown = 42;
    } newer_layer;
    newer_layer.known.size = sizeof newer_layer;
    ASSERT_EQ(lamella_get_layer(layers.get(), 0, &newer_layer.known), LAMELLA_OK);
    EXPECT_EQ(newer_layer.known.size, sizeof(NewerLayer));
    EXPECT_EQ(newer_layer.known.rings, 1U);
    EXPECT_EQ(newer_layer.unknown, 42U);
}

TEST(C, RefusesArraysThatAreNoLayer) {
    const double points[] = {0, 0, 4, 0, 4, 4, 0, std::numeric_limits<double>::quiet_NaN()};
    const std::uint64_t offsets[] = {0, 4};
    auto layer = sized<lamella_layer>();
    layer.points = points;
    layer.point_count = 4;
    layer.offsets = offsets;
    layer.contour_count = 1;
    layer.rings = 1;
    lamella_layers* made = nullptr;
    EXPECT_EQ(lamella_make_layer(&layer, &made), LAMELLA_USAGE); // not finite
    layer.point_count = 3;
    EXPECT_EQ(lamella_make_layer(&layer, &made), LAMELLA_USAGE); // the ring has four points
    layer.rings = 2;
    EXPECT_EQ(lamella_make_layer(&layer, &made), LAMELLA_USAGE); // of one contour
    layer.rings = 1;
    layer.points = nullptr;
    EXPECT_EQ(lamella_make_layer(&layer, &made), LAMELLA_USAGE);
    layer.bottom = 1;
    EXPECT_EQ(lamella_make_layer(&layer, &made), LAMELLA_USAGE); // above z
    EXPECT_EQ(made, nullptr);
    const CLayers one = layers_of({test::normal_layer({test::rectangle(0, 0, 1, 1)})});
    const CMesh box = mesh_of(weld(make_box(1, 1, 1)));
    lamella_layers* sliced = nullptr;
    ASSERT_EQ(lamella_slice(box.get(), 0.5, nullptr, &sliced), LAMELLA_OK);
    const CLayers two(sliced);
    EXPECT_EQ(lamella_combine(one.get(), two.get(), LAMELLA_UNION, nullptr, &made), LAMELLA_USAGE);
    EXPECT_STREQ(lamella_error(), "second: found 2 layers, and first has 1");
    EXPECT_EQ(lamella_ring_parents(one.get(), 1, nullptr), LAMELLA_USAGE);
    auto both = sized<lamella_plan>();
    both.layer_height = 1;
    both.max_height = 2;
    EXPECT_EQ(lamella_slice_by_plan(box.get(), &both, nullptr, &made), LAMELLA_USAGE);
}

TEST(C, KeepsTheTextsOfThreadsApart) {
    std::vector<std::string> found(4);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < found.size(); ++t)
        threads.emplace_back([&found, t] {
            const std::string name = "missing " + std::to_string(t);
            for (int round = 0; round < 50; ++round) {
                lamella_mesh* mesh = nullptr;
                static_cast<void>(lamella_read_mesh(name.c_str(), nullptr, &mesh));
                found[t] = lamella_error();
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    for (std::size_t t = 0; t < found.size(); ++t)
        EXPECT_EQ(found[t], "missing " + std::to_string(t) + ": there is no such file");
}

} // namespace
} // namespace lamella::c_cases
