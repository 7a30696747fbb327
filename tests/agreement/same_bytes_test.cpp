// The same solid gives the same bytes: for any number of threads, any order of the triangles, streamed or
// not, from a soup or an indexed mesh.

#include "fixtures/layer_checks.hpp"
#include "fixtures/named_solids.hpp"
#include "fixtures/skip_if_slowed.hpp"
#include "parts/shapes.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <lamella/formats.hpp>

#include <atomic>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace lamella {
namespace {

using test::hashes;
using test::NamedPlan;
using test::Placement;
using test::Solid;

class SameBytes : public testing::TestWithParam<Solid> {
  protected:
    void SetUp() override {
        if (std::string_view(GetParam().name) == "rook") {
            LAMELLA_SKIP_IF_SLOWED();
        }
    }
};

const std::vector<Solid> large_solids{{"rook", [] {
                                           return make_rook();
                                       }}};

const std::vector<Solid> defective_solids{
    {"boxes_sharing_an_upright_edge",
     [] {
         return TriangleSoup(test::boxes_sharing_an_upright_edge());
     }},
    {"boxes_back_to_back",
     [] {
         return TriangleSoup(test::boxes_back_to_back());
     }},
    {"box_twice",
     [] {
         return TriangleSoup(test::box_twice());
     }},
    {"box_without_a_side",
     [] {
         return TriangleSoup(test::box_without_a_side());
     }},
    {"box_with_a_flipped_triangle",
     [] {
         return TriangleSoup(test::box_with_a_flipped_triangle());
     }},
    {"three_sheets_on_an_edge",
     [] {
         return TriangleSoup(test::three_sheets_on_an_edge());
     }},
};

INSTANTIATE_TEST_SUITE_P(Small, SameBytes, testing::ValuesIn(test::small_solids()), test::solid_name);
INSTANTIATE_TEST_SUITE_P(Large, SameBytes, testing::ValuesIn(large_solids), test::solid_name);
INSTANTIATE_TEST_SUITE_P(Defective, SameBytes, testing::ValuesIn(defective_solids), test::solid_name);

/// Three placements are enough here: axes, no axes, and far from the origin.
std::vector<Placement> few_placements() {
    std::vector<Placement> result;
    for (const Placement& placement : test::placements())
        if (placement.name == "as_made" || placement.name == "tilted" || placement.name == "far_away")
            result.push_back(placement);
    return result;
}

/// Calls check(mesh, plan) for all placements and plans of the solid.
template <class Check>
void for_all(const Solid& solid, const Check& check) {
    const TriangleSoup made = solid.make();
    for (const Placement& placement : few_placements()) {
        const TriangleSoup mesh = made.transformed(placement.map);
        for (const NamedPlan& plan : test::plans_for(mesh, 60)) {
            SCOPED_TRACE(placement.name + ", planes " + plan.name);
            check(mesh, plan.plan);
        }
    }
}

TEST_P(SameBytes, ForAnyNumberOfThreads) {
    for_all(GetParam(), [](const TriangleSoup& mesh, const Plan& plan) {
        const std::vector<std::uint64_t> one = hashes(slice(mesh, plan, {.execution = {.threads = 1}}));
        EXPECT_EQ(hashes(slice(mesh, plan, {.execution = {.threads = 2}})), one);
        EXPECT_EQ(hashes(slice(mesh, plan, {.execution = {.threads = 7}})), one);
    });
}

TEST_P(SameBytes, ForAnyOrderOfTheTriangles) {
    for_all(GetParam(), [](const TriangleSoup& mesh, const Plan& plan) {
        const std::vector<std::uint64_t> in_order = hashes(slice(mesh, plan));
        for (const std::uint64_t seed : {1U, 2U, 3U})
            EXPECT_EQ(hashes(slice(shuffled(mesh, seed), plan)), in_order);
    });
}

TEST_P(SameBytes, ForAnyFirstCornerOfTheTriangles) {
    const TriangleSoup mesh = GetParam().make();
    test::Triangles turned;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const Triangle3f t = mesh.stored(i);
        turned.push_back(i % 3 == 0   ? t
                         : i % 3 == 1 ? Triangle3f{t[1], t[2], t[0]}
                                      : Triangle3f{t[2], t[0], t[1]});
    }
    for (const NamedPlan& plan : test::plans_for(mesh, 60))
        EXPECT_EQ(hashes(slice(TriangleSoup(turned), plan.plan)), hashes(slice(mesh, plan.plan)))
            << plan.name;
}

TEST_P(SameBytes, WhetherStreamedOrNot) {
    for_all(GetParam(), [](const TriangleSoup& mesh, const Plan& plan) {
        LayerStack at_once;
        const SliceReport report = slice_to(appending_to(at_once), mesh, plan);
        for (const unsigned threads : {1U, 2U, 7U}) {
            LayerStack streamed;
            std::atomic<int> writing{0};
            const LayerSink sink{.prepare = [&](Layer&& layer) -> Commit {
                auto kept = std::make_shared<Layer>(std::move(layer));
                return [&, kept] {
                    EXPECT_EQ(writing.fetch_add(1), 0); // one at a time
                    streamed.push_back(std::move(*kept));
                    writing.fetch_sub(1);
                };
            }};
            const SliceReport streamed_report =
                slice_to(sink, mesh, plan, {.execution = {.threads = threads}});
            ASSERT_NO_FATAL_FAILURE(test::expect_well_formed(streamed, plan)); // also: in ascending z
            EXPECT_EQ(hashes(streamed), hashes(at_once));
            EXPECT_EQ(streamed_report.contours, report.contours);
            EXPECT_EQ(streamed_report.points, report.points);
            EXPECT_EQ(streamed_report.open_chains, report.open_chains);
        }
    });
}

/// A mesh file in which each face has vertices of its own.
struct RepeatingFile {
    std::string_view extension;
    std::string (*text)(const TriangleSoup& mesh);
};

std::string corner_lines(const TriangleSoup& mesh, std::string_view before, std::string_view after) {
    std::string text;
    for (std::size_t i = 0; i < mesh.size(); ++i)
        for (const Point3f& p : mesh.stored(i))
            text += fmt::format("{}{} {} {}{}\n", before, double{p.x}, double{p.y}, double{p.z},
                                after); // to all digits
    return text;
}

/// Rows of three numbers each, counted from `first`.
std::string face_lines(const TriangleSoup& mesh, std::string_view before, std::size_t first) {
    std::string text;
    for (std::size_t i = 0; i < mesh.size(); ++i)
        text += fmt::format("{} {} {} {}\n", before, 3 * i + first, 3 * i + first + 1, 3 * i + first + 2);
    return text;
}

const std::vector<RepeatingFile> repeating_files{
    {"obj",
     [](const TriangleSoup& mesh) {
         return corner_lines(mesh, "v ", "") + face_lines(mesh, "f", 1);
     }},
    {"off",
     [](const TriangleSoup& mesh) {
         return fmt::format("OFF\n{} {} 0\n", 3 * mesh.size(), mesh.size()) + corner_lines(mesh, "", "") +
                face_lines(mesh, "3", 0);
     }},
    {"ply",
     [](const TriangleSoup& mesh) {
         return fmt::format("ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float "
                            "y\nproperty float z\nelement face {}\nproperty list uchar int "
                            "vertex_indices\nend_header\n",
                            3 * mesh.size(), mesh.size()) +
                corner_lines(mesh, "", "") + face_lines(mesh, "3", 0);
     }},
    {"amf",
     [](const TriangleSoup& mesh) {
         std::string text = "<?xml version=\"1.0\"?><amf unit=\"millimeter\"><object "
                            "id=\"1\"><mesh><vertices>\n";
         for (std::size_t i = 0; i < mesh.size(); ++i)
             for (const Point3f& p : mesh.stored(i))
                 text += fmt::format("<vertex><coordinates><x>{}</x><y>{}</y><z>{}</z></coordinates>"
                                     "</vertex>\n",
                                     double{p.x}, double{p.y}, double{p.z});
         text += "</vertices><volume>\n";
         for (std::size_t i = 0; i < mesh.size(); ++i)
             text += fmt::format("<triangle><v1>{}</v1><v2>{}</v2><v3>{}</v3></triangle>\n", 3 * i, 3 * i + 1,
                                 3 * i + 2);
         return text + "</volume></mesh></object></amf>\n";
     }},
};

TEST_P(SameBytes, FromFilesThatRepeatTheirVertices) {
    const TriangleSoup mesh = GetParam().make();
    const TemporaryFolder folder;
    for (const RepeatingFile& file : repeating_files) {
        SCOPED_TRACE(file.extension);
        const std::string path = folder.file(fmt::format("part.{}", file.extension));
        write_file(path, file.text(mesh));
        const MeshFile part = read_mesh(path);
        ASSERT_EQ(part.mesh().indexed()->vertices.size(), 3 * mesh.size()) << "as the file lists them";
        for (const NamedPlan& plan : test::plans_for(mesh, 20))
            for (const Engine& engine : engines())
                EXPECT_EQ(hashes(slice(part.mesh(), plan.plan, {.engine = engine})),
                          hashes(slice(mesh, plan.plan, {.engine = engine})))
                    << engine.name << ", planes " << plan.name;
    }
}

TEST_P(SameBytes, FromASoupAndAnIndexedMesh) {
    for_all(GetParam(), [](const TriangleSoup& mesh, const Plan& plan) {
        EXPECT_EQ(hashes(slice(weld(mesh), plan)), hashes(slice(mesh, plan)));
        EXPECT_EQ(section_areas(weld(mesh), plan), section_areas(mesh, plan));
    });
}

TEST_P(SameBytes, ForEachPlaneAloneAndInAPlan) {
    const TriangleSoup mesh = GetParam().make();
    for (const NamedPlan& plan : test::plans_for(mesh, 20)) {
        const LayerStack together = slice(mesh, plan.plan);
        for (std::size_t i = 0; i < plan.plan.layers.size(); ++i) {
            const LayerStack alone = slice(mesh, {{plan.plan.layers[i]}, plan.plan.rule});
            EXPECT_TRUE(same_contours(alone.front(), together[i])) << plan.name << ' ' << i;
        }
    }
}

TEST_P(SameBytes, ForSectionAreasOnAnyNumberOfThreads) {
    for_all(GetParam(), [](const TriangleSoup& mesh, const Plan& plan) {
        const std::vector<double> one = section_areas(mesh, plan, {.threads = 1});
        EXPECT_EQ(section_areas(mesh, plan, {.threads = 7}), one);
    });
}

} // namespace
} // namespace lamella
