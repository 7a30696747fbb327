#include "lamella/c/lamella.h"
#include "lamella/contour/normal_form.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"
#include "lamella/write/mesh_writer.hpp"

#include "parts/shapes.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <thread>
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
    ASSERT_EQ(lamella_prepare(mesh.get(), nullptr, &prepared), LAMELLA_OK);
    const CSlicer slicer(prepared);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        lamella_layer layer;
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
    lamella_layer layer;
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
    lamella_settings many_threads{};
    many_threads.threads = 4'000'000'000;
    EXPECT_EQ(lamella_slice(box.get(), 1, &many_threads, &layers), LAMELLA_USAGE);
    EXPECT_NE(std::string(lamella_error()).find("threads: found 4000000000"), std::string::npos)
        << lamella_error();
    EXPECT_EQ(lamella_prepare(nullptr, nullptr, &slicer), LAMELLA_USAGE);
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
    lamella_settings small = {};
    small.max_memory = 1000;
    const std::string path = folder.file("torus.obj");
    write_obj(path, weld(make_torus(6, 2, 40, 20)), "torus");
    EXPECT_EQ(lamella_read_mesh(path.c_str(), &small, &mesh), LAMELLA_LIMIT) << lamella_error();
    EXPECT_EQ(mesh, nullptr);
    EXPECT_EQ(slicer, nullptr);
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
