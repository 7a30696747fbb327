#include "container/in_memory.hpp"
#include "core/executor.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "meshes/assembly.hpp"
#include "parts/shapes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace lamella::assembly_cases {
namespace {

using test::Random;

std::vector<MeshInstance> placed(const std::vector<AssemblyNode>& nodes,
                                 const std::vector<AssemblyUse>& roots,
                                 const std::vector<MeshObject>& objects,
                                 const MeshReadOptions& options = {}) {
    const ByteSource source = test::source_of("x");
    ReadLimits limits(source, options);
    const Execution execution{.threads = 1};
    Executor executor(execution);
    return place_meshes("x", nodes, roots, objects, limits, executor);
}

const std::vector<MeshObject> boxes{{"", make_box(1, 2, 3)}, {"", make_box(2, 2, 2)}};

MeshRole random_role(Random& random) {
    const std::int64_t which = random.integer(0, 5);
    return which == 0 ? MeshRole::support : which == 1 ? MeshRole::negative : MeshRole::part;
}

TEST(Assembly, PlacesOneInstanceForEachPathToAMesh) {
    Random random(561);
    for (int round = 0; round < test::rounds_within_reason(500); ++round) {
        // Nodes use only nodes before them.
        std::vector<AssemblyNode> nodes;
        for (std::int64_t n = random.integer(1, 6); n > 0; --n) {
            AssemblyNode node;
            node.location = fmt::format("node {}", nodes.size());
            if (random.integer(0, 1) == 0)
                node.name = fmt::format("name {}", nodes.size());
            node.is_body = random.integer(0, 3) == 0;
            if (nodes.empty() || random.integer(0, 2) == 0) {
                node.unit = scaling(2, 2, 2);
                for (std::int64_t k = random.integer(0, 2); k > 0; --k)
                    node.meshes.push_back({static_cast<std::size_t>(k - 1), random_role(random)});
            } else {
                for (std::int64_t k = random.integer(0, 3); k > 0; --k)
                    node.uses.push_back({static_cast<std::size_t>(random.integer(0, std::ssize(nodes) - 1)),
                                         translation(static_cast<double>(k), 0, 1),
                                         {},
                                         random_role(random),
                                         {}});
            }
            nodes.push_back(node);
        }
        std::vector<AssemblyUse> roots;
        for (std::int64_t n = random.integer(0, 3); n > 0; --n)
            roots.push_back({static_cast<std::size_t>(random.integer(0, std::ssize(nodes) - 1)),
                             translation(0, 100.0 * static_cast<double>(n), 0),
                             {},
                             random_role(random),
                             {}});
        struct Path {
            std::size_t object;
            Point3 origin; ///< of the mesh
            std::string name;
            MeshRole role;
            std::vector<std::size_t> body; ///< the root, and the uses up to the innermost body
        };
        std::vector<Path> expected;
        const std::function<void(const AssemblyUse&, Point3, std::string, MeshRole, std::vector<std::size_t>,
                                 std::vector<std::size_t>)>
            go = [&](const AssemblyUse& use, Point3 origin, std::string name, MeshRole role,
                     std::vector<std::size_t> path, std::vector<std::size_t> body) {
                const AssemblyNode& node = nodes[use.node];
                const auto& offset = use.placement.offset;
                origin = {origin.x + offset[0], origin.y + offset[1], origin.z + offset[2]};
                name = node.name.empty() ? name : node.name;
                role = use.role == MeshRole::part ? role : use.role;
                if (node.is_body)
                    body = path;
                for (const AssemblyMesh& mesh : node.meshes)
                    expected.push_back(
                        {mesh.object, origin, name, mesh.role == MeshRole::part ? role : mesh.role, body});
                for (std::size_t k = 0; k < node.uses.size(); ++k) {
                    std::vector<std::size_t> longer = path;
                    longer.push_back(k);
                    go(node.uses[k], origin, name, role, longer, body);
                }
            };
        for (std::size_t r = 0; r < roots.size(); ++r)
            go(roots[r], {}, "", MeshRole::part, {r, 1000}, {r});
        const std::vector<MeshInstance> found = placed(nodes, roots, boxes);
        ASSERT_EQ(found.size(), expected.size()) << round;
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_EQ(found[i].object, expected[i].object) << round;
            EXPECT_EQ(found[i].name, expected[i].name) << round;
            EXPECT_EQ(found[i].support, expected[i].role == MeshRole::support) << round;
            EXPECT_EQ(found[i].negative, expected[i].role == MeshRole::negative) << round;
            const auto& offset = found[i].placement.offset;
            EXPECT_EQ((Point3{offset[0], offset[1], offset[2]}), expected[i].origin) << round;
            EXPECT_EQ(found[i].placement.linear[0][0], 2) << "the unit";
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_EQ(found[i].body == found[k].body, expected[i].body == expected[k].body) << round;
        }
    }
}

TEST(Assembly, RefusesNodesThatContainThemselves) {
    std::vector<AssemblyNode> nodes(3);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        nodes[i].location = fmt::format("line {}", i);
        nodes[i].uses.push_back({(i + 1) % nodes.size(), {}, {}, MeshRole::part, {}});
    }
    test::expect_error(ErrorKind::input, {"x, line 0: contains itself"},
                       [&] { static_cast<void>(placed(nodes, {}, boxes)); });
}

TEST(Assembly, CountsInstancesBeforeItMakesThem) {
    // Each node uses the one before it twice.
    std::vector<AssemblyNode> nodes(64);
    nodes[0].meshes.push_back({0, MeshRole::part});
    for (std::size_t i = 1; i < nodes.size(); ++i)
        for (int k = 0; k < 2; ++k)
            nodes[i].uses.push_back({i - 1, {}, {}, MeshRole::part, {}});
    const auto from = [&](std::size_t node) {
        return placed(nodes, {{node, {}, {}, MeshRole::part, {}}}, boxes).size();
    };
    EXPECT_EQ(from(10), 1024U);
    test::expect_error(ErrorKind::limit, {"puts 2097152 meshes on the plate"},
                       [&] { static_cast<void>(from(21)); });
    test::expect_error(ErrorKind::limit, {"meshes on the plate"}, [&] { static_cast<void>(from(63)); });
    test::expect_error(ErrorKind::limit, {"`max_triangles`"}, [&] {
        static_cast<void>(
            placed(nodes, {{3, {}, {}, MeshRole::part, {}}}, boxes, {.max_triangles = 8 * 12 - 1}));
    });
}

TEST(Assembly, LimitsNesting) {
    std::vector<AssemblyNode> nodes(100);
    nodes[0].meshes.push_back({0, MeshRole::part});
    for (std::size_t i = 1; i < nodes.size(); ++i)
        nodes[i].uses.push_back({i - 1, {}, {}, MeshRole::part, {}});
    const std::vector<AssemblyNode> few(nodes.begin(), nodes.begin() + 65);
    EXPECT_EQ(placed(few, {{64, {}, {}, MeshRole::part, {}}}, boxes).size(), 1U);
    test::expect_error(ErrorKind::input, {"is nested deeper than 64"}, [&] {
        static_cast<void>(placed(nodes, {{99, {}, {}, MeshRole::part, {}}}, boxes));
    });
}

TEST(Assembly, RefusesPlacementsThatOverflowOrFlatten) {
    std::vector<AssemblyNode> nodes(1);
    nodes[0].meshes.push_back({0, MeshRole::part});
    const auto with = [&](const Transform& placement) {
        static_cast<void>(placed(nodes, {{0, placement, {"a", 7, "this item"}, MeshRole::part, {}}}, boxes));
    };
    test::expect_error(ErrorKind::input, {"x, part 'a', line 7: this item: puts a mesh further away than"},
                       [&] { with(translation(1e39, 0, 0)); });
    test::expect_error(ErrorKind::input, {"flattens a mesh"}, [&] { with(scaling(1, 1, 0)); });
}

} // namespace
} // namespace lamella::assembly_cases
