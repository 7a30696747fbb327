#include "container/in_memory.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "meshes/body_selection.hpp"
#include "meshes/mesh_text.hpp"
#include "meshes/remarks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace lamella::body_selection_cases {
namespace {

using test::Random;

TEST(BodySelection, TakesPartsNegativesAndWhatIsIncluded) {
    for (const MeshRoleRow& row : mesh_roles()) {
        EXPECT_EQ(BodySelection({}).takes(row.role), !row.left_out) << row.name;
        EXPECT_TRUE(BodySelection({row.role}).takes(row.role)) << row.name;
    }
    EXPECT_EQ(BodySelection({}).taken_as(MeshRole::negative), MeshRole::negative);
    EXPECT_EQ(BodySelection({MeshRole::negative}).taken_as(MeshRole::negative), MeshRole::part);
    EXPECT_EQ(BodySelection({MeshRole::support}).taken_as(MeshRole::support), MeshRole::support);
    EXPECT_EQ(BodySelection({MeshRole::modifier}).taken_as(MeshRole::modifier), MeshRole::part);
}

TEST(BodySelection, ReportsWhatItLeftOutInOneNote) {
    const auto notes = [](const BodySelection& selection) {
        Remarks remarks("x", true); // a note is no error for strict callers
        selection.report(remarks);
        return remarks.take();
    };
    BodySelection selection({});
    EXPECT_EQ(selection.left_out(), 0U);
    EXPECT_TRUE(notes(selection).empty());
    selection.leave_out(MeshRole::modifier, "a");
    EXPECT_EQ(selection.left_out(), 1U);
    EXPECT_EQ(notes(selection),
              std::vector<std::string>{"1 body was left out as no material: 1 modifier (\"a\"); "
                                       "`include` modifier to read it as a solid"});
    for (const char* name : {"", "b", "c", "d"})
        selection.leave_out(MeshRole::modifier, name);
    selection.leave_out(MeshRole::support, "");
    const std::vector<std::string> both = notes(selection);
    ASSERT_EQ(both.size(), 1U);
    EXPECT_TRUE(both[0].starts_with("6 bodies were left out as no material: ")) << both[0];
    EXPECT_NE(both[0].find("5 modifiers (\"a\", \"b\", \"c\", ...)"), std::string::npos) << both[0];
    EXPECT_NE(both[0].find("1 support, "), std::string::npos) << both[0];
}

TEST(BodySelection, DividesTheTrianglesOfAMeshByTheirRoles) {
    Random random(571);
    for (int round = 0; round < test::rounds_within_reason(1000); ++round) {
        IndexedMesh mesh;
        for (std::int64_t n = random.integer(3, 12); n > 0; --n)
            mesh.vertices.push_back({static_cast<double>(n), random.real(0, 9), random.real(0, 9)});
        const auto triangles = static_cast<std::uint64_t>(random.integer(0, 30));
        for (std::uint64_t i = 0; i < triangles; ++i) {
            TriangleIndices& t = mesh.triangles.emplace_back();
            for (std::uint32_t& corner : t)
                corner = static_cast<std::uint32_t>(random.bits() % mesh.vertices.size());
        }
        // Ranges in any order, which may overlap and lie beyond the mesh. The first in the mesh prevails.
        std::vector<VolumeRange> volumes;
        for (std::int64_t n = random.integer(0, 4); n > 0; --n) {
            const auto begin = static_cast<std::uint64_t>(random.integer(0, 35));
            volumes.push_back({begin, begin + static_cast<std::uint64_t>(random.integer(0, 12)),
                               static_cast<MeshRole>(random.integer(0, 7)), n % 2 == 0 ? "named" : ""});
        }
        std::vector<VolumeRange> ordered = volumes;
        std::stable_sort(ordered.begin(), ordered.end(),
                         [](const VolumeRange& a, const VolumeRange& b) { return a.begin < b.begin; });
        std::vector<MeshRole> roles(triangles, MeshRole::part);
        std::uint64_t done = 0;
        for (const VolumeRange& volume : ordered) {
            done = std::max(done, std::min(volume.begin, triangles));
            for (; done < std::min(volume.end, triangles); ++done)
                roles[done] = volume.role;
        }
        BodySelection selection(round % 2 == 0 ? MeshRoles{}
                                               : MeshRoles{MeshRole::modifier, MeshRole::support});
        std::map<MeshRole, std::vector<Triangle3>> expected;
        std::uint64_t taken = 0;
        for (std::uint64_t i = 0; i < triangles; ++i)
            if (selection.takes(roles[i])) {
                expected[selection.taken_as(roles[i])].push_back(corners(mesh, i));
                ++taken;
            }
        const ByteSource source = test::source_of("x");
        constexpr std::uint64_t most = 1'000'000;
        ReadLimits limits(source, MeshReadOptions{.max_triangles = triangles + 100, .max_memory = most});
        const std::uint64_t before = test::bytes_counted(limits, most);
        limits.add_triangles(triangles);
        limits.add_bytes(mesh.vertices.size() * sizeof(Point3) + triangles * sizeof(TriangleIndices));
        std::vector<MeshBody> bodies;
        const std::vector<RoleMesh> found =
            divided_by_role(mesh, volumes, "object", selection, bodies, limits);
        ASSERT_EQ(found.size(), expected.size()) << round;
        std::uint64_t bytes = 0;
        for (const RoleMesh& one : found) {
            std::vector<Triangle3> its;
            for (std::size_t i = 0; i < one.mesh.triangles.size(); ++i)
                its.push_back(corners(one.mesh, i));
            EXPECT_EQ(its, expected[one.role]) << round;
            bytes += one.mesh.vertices.size() * sizeof(Point3) + its.size() * sizeof(TriangleIndices);
        }
        EXPECT_EQ(test::bytes_counted(limits, most) - before, bytes) << round;
        EXPECT_EQ(limits.triangles_left(), triangles + 100 - taken) << round;
        std::uint64_t in_bodies = 0;
        for (const MeshBody& body : bodies) {
            in_bodies += body.triangles;
            EXPECT_GT(body.triangles, 0U);
            EXPECT_TRUE(body.name == "object" || body.name == "named");
            EXPECT_EQ(body.left_out, !selection.takes(body.role));
        }
        EXPECT_EQ(in_bodies, triangles) << round;
    }
}

} // namespace
} // namespace lamella::body_selection_cases
