// Meshes from the wild: they slice without a crash, closed where they are closed, with their volume.

#include "fixtures/layer_checks.hpp"
#include "fixtures/named_solids.hpp"
#include "fixtures/shared_meshes.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>
#include <lamella/jobs.hpp>

#include <array>
#include <cmath>

namespace lamella {
namespace {

TEST(SharedMeshes, AreThere) {
    if (test::shared_stl_meshes().empty())
        GTEST_SKIP() << "no meshes in " << LAMELLA_SHARED << "/meshes; set LAMELLA_SHARED to test with them";
}

class EverySharedMesh : public testing::TestWithParam<test::SharedMesh> {};

INSTANTIATE_TEST_SUITE_P(Stl, EverySharedMesh, testing::ValuesIn(test::shared_stl_meshes()),
                         test::shared_mesh_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EverySharedMesh);

/// The mesh, or nothing where the file is refused, which is right for files without a triangle only.
std::optional<TriangleSoup> read(const test::SharedMesh& shared) {
    try {
        return *read_mesh(shared.path).mesh().soup();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_NE(std::string(error.what()).find(shared.file), std::string::npos) << error.what();
        return std::nullopt;
    }
}

TEST_P(EverySharedMesh, SlicesClosedWhereItIsClosed) {
    const std::optional<TriangleSoup> mesh = read(GetParam());
    if (!mesh) {
        EXPECT_FALSE(GetParam().watertight);
        return;
    }
    for (const test::NamedPlan& plan : test::plans_for(*mesh, 40)) {
        SCOPED_TRACE(plan.name);
        const LayerStack layers = slice(*mesh, plan.plan);
        ASSERT_NO_FATAL_FAILURE(test::expect_well_formed(layers, plan.plan));
        const Verification found = verify(layers, {.mesh = *mesh, .rule = plan.plan.rule});
        if (GetParam().watertight) {
            EXPECT_EQ(found.findings.count(FindingKind::open_contours), 0U);
            EXPECT_EQ(found.findings.count(FindingKind::other_areas), 0U)
                << testing::PrintToString(found.findings.texts());
        }
        EXPECT_EQ(test::hashes(slice(shuffled(*mesh, 1), plan.plan, {.execution = {.threads = 7}})),
                  test::hashes(layers));
        EXPECT_EQ(test::hashes(slice(weld(*mesh), plan.plan, {.execution = {.threads = 1}})),
                  test::hashes(layers));
    }
}

TEST_P(EverySharedMesh, HasItsVolumeInLayers) {
    if (!GetParam().watertight || !GetParam().volume_mm3)
        GTEST_SKIP() << "not closed";
    const std::optional<TriangleSoup> mesh = read(GetParam());
    ASSERT_TRUE(mesh.has_value());
    const Box3 box = bounding_box(*mesh);
    const double height = (box.max.z - box.min.z) / 400;
    const LayerStack layers = slice(*mesh, plan_uniform(box.min.z, box.max.z, {.layer_height = height}));
    double volume_of_layers = 0;
    double before = 0;
    double change = 0;
    for (const Layer& layer : layers) {
        const double area = measure(layer).area_mm2;
        volume_of_layers += area * layer.thickness();
        change += std::abs(area - before);
        before = area;
    }
    change += std::abs(before);
    const double expected = *GetParam().volume_mm3;
    EXPECT_NEAR(volume_of_layers, expected, 2 * height * change + 1e-6 * std::abs(expected));
}

class SharedMeshOfAnyFormat : public testing::TestWithParam<test::SharedMesh> {};

INSTANTIATE_TEST_SUITE_P(Shared, SharedMeshOfAnyFormat, testing::ValuesIn(test::shared_meshes()),
                         test::shared_mesh_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SharedMeshOfAnyFormat);

TEST_P(SharedMeshOfAnyFormat, IsClosedAndHasItsVolumeWhereTheFileIsClosed) {
    if (!GetParam().closed)
        GTEST_SKIP() << "not closed";
    const std::array inputs{PlateInput{.path = GetParam().path}};
    const IndexedMesh mesh = weld(joined(load_plate(inputs)));
    const Inspection inspected = inspect(mesh);
    EXPECT_TRUE(inspected.closed());
    const double height = (inspected.box.max.z - inspected.box.min.z) / 200;
    const LayerStack layers =
        slice(mesh, plan_uniform(inspected.box.min.z, inspected.box.max.z, {.layer_height = height}));
    double volume = 0;
    double change = 0;
    double before = 0;
    for (const Layer& layer : layers) {
        EXPECT_EQ(layer.open_chains(), 0U) << "z " << layer.z;
        EXPECT_EQ(open_gaps(layer).count, 0U);
        const double area = measure(layer).area_mm2;
        volume += area * layer.thickness();
        change += std::abs(area - before);
        before = area;
    }
    change += std::abs(before);
    EXPECT_NEAR(volume, inspected.volume_mm3, 2 * height * change);
    if (GetParam().volume_mm3) {
        EXPECT_NEAR(inspected.volume_mm3, *GetParam().volume_mm3, 1e-5 * std::abs(inspected.volume_mm3));
    }
}

} // namespace
} // namespace lamella
