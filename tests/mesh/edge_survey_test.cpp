#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "mesh/assemble.hpp"
#include "mesh/edge_survey.hpp"
#include "mesh/naive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace lamella::edge_survey_cases {
namespace {

using test::Random;
using Vertices = std::array<std::uint32_t, 3>;

IndexedMesh random_mesh(Random& random) {
    IndexedMesh mesh;
    mesh.vertices.resize(static_cast<std::size_t>(random.integer(3, 12)));
    add_random_triangles(mesh, random.integer(0, 60), random);
    return mesh;
}

/// Uses of an edge, by its lower and its higher vertex.
struct Uses {
    int up = 0;
    int down = 0;
};

std::map<VertexPair, Uses> uses_in(const IndexedMesh& mesh) {
    std::map<VertexPair, Uses> all;
    for (const auto& t : mesh.triangles)
        for (int k = 0; k < 3 && !naive_degenerate(t); ++k) {
            Uses& uses = all[std::minmax(t[k], t[(k + 1) % 3])];
            ++(t[k] < t[(k + 1) % 3] ? uses.up : uses.down);
        }
    return all;
}

/// The triangles with the same vertices, by these; first those of even order.
std::map<Vertices, std::array<std::vector<std::uint32_t>, 2>> same_vertices(const IndexedMesh& mesh) {
    std::map<Vertices, std::array<std::vector<std::uint32_t>, 2>> all;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        Vertices t = mesh.triangles[i];
        if (naive_degenerate(t))
            continue;
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        const bool odd = t[1] > t[2];
        std::sort(t.begin(), t.end());
        all[t][odd ? 1 : 0].push_back(i);
    }
    return all;
}

TEST(EdgeSurvey, AgreesWithALoopOverAllEdges) {
    Random random(401);
    for (int round = 0; round < test::rounds_within_reason(400); ++round) {
        const IndexedMesh mesh = random_mesh(random);
        const Execution execution{.threads = 1 + static_cast<unsigned>(round) % 3};
        Executor executor(execution);
        const EdgeSurvey survey = survey_edges(executor, mesh, true);
        const EdgeCounts expected = naive_edges(mesh);
        EXPECT_EQ(survey.counts.boundary_edges, expected.boundary) << round;
        EXPECT_EQ(survey.counts.nonmanifold_edges, expected.nonmanifold) << round;
        EXPECT_EQ(survey.counts.orientation_conflicts, expected.unbalanced) << round;
        EXPECT_EQ(survey.counts.duplicate_triangles, naive_duplicates(mesh)) << round;

        EdgeLocations locations;
        for (const auto& [edge, uses] : uses_in(mesh)) {
            if (uses.up + uses.down == 1)
                locations.boundary.push_back(uses.up == 1 ? VertexPair{edge.second, edge.first} : edge);
            else if (uses.up != uses.down)
                locations.conflicts.push_back(edge);
            if (uses.up + uses.down > 2)
                locations.nonmanifold.push_back(edge);
        }
        std::uint64_t opposite_pairs = 0;
        for (const auto& [vertices, triangles] : same_vertices(mesh)) {
            opposite_pairs += std::min(triangles[0].size(), triangles[1].size());
            std::vector<std::uint32_t> all = triangles[0];
            all.insert(all.end(), triangles[1].begin(), triangles[1].end());
            std::sort(all.begin(), all.end());
            locations.duplicates.insert(locations.duplicates.end(), all.begin() + 1, all.end());
        }
        std::sort(locations.boundary.begin(), locations.boundary.end());
        std::sort(locations.duplicates.begin(), locations.duplicates.end());
        EXPECT_EQ(survey.locations.boundary, locations.boundary) << round;
        EXPECT_EQ(survey.locations.nonmanifold, locations.nonmanifold) << round;
        EXPECT_EQ(survey.locations.conflicts, locations.conflicts) << round;
        EXPECT_EQ(survey.locations.duplicates, locations.duplicates) << round;
        EXPECT_EQ(survey.opposite_pairs, opposite_pairs) << round;
    }
}

TEST(EdgeSurvey, JoinsTrianglesThatShareEdges) {
    Random random(402);
    for (int round = 0; round < test::rounds_within_reason(400); ++round) {
        const IndexedMesh mesh = random_mesh(random);
        const Execution execution{.threads = 2};
        Executor executor(execution);
        const EdgeSurvey survey = survey_edges(executor, mesh, false);
        std::uint64_t parts = 0;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
            parts += survey.parts.find(i) == i && !naive_degenerate(mesh.triangles[i]);
        EXPECT_EQ(parts, naive_shells(mesh)) << round;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
            for (std::uint32_t k = 0; k < i; ++k) {
                const auto edges = [&](std::uint32_t t) {
                    std::vector<VertexPair> ends;
                    for (int j = 0; j < 3 && !naive_degenerate(mesh.triangles[t]); ++j)
                        ends.emplace_back(std::minmax(mesh.triangles[t][j], mesh.triangles[t][(j + 1) % 3]));
                    return ends;
                };
                const std::vector<VertexPair> mine = edges(i);
                for (const VertexPair& edge : edges(k))
                    if (std::find(mine.begin(), mine.end(), edge) != mine.end()) {
                        EXPECT_EQ(survey.parts.find(i), survey.parts.find(k)) << round;
                    }
            }
    }
}

TEST(EdgeSurvey, MarksATriangleAtEachEdgeThatIsNotBalanced) {
    Random random(403);
    for (int round = 0; round < test::rounds_within_reason(400); ++round) {
        const IndexedMesh mesh = random_mesh(random);
        const Execution execution{.threads = 2};
        Executor executor(execution);
        const EdgeSurvey survey = survey_edges(executor, mesh, false);
        std::map<VertexPair, bool> marked; // of edges that are not balanced
        for (const auto& [edge, uses] : uses_in(mesh))
            if (uses.up != uses.down)
                marked[edge] = false;
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            if (survey.open[i] == 0)
                continue;
            const auto& t = mesh.triangles[i];
            bool at_one = false;
            for (int k = 0; k < 3; ++k)
                if (const auto found = marked.find(std::minmax(t[k], t[(k + 1) % 3])); found != marked.end())
                    at_one = found->second = true;
            EXPECT_TRUE(at_one) << round;
        }
        for (const auto& [edge, is_marked] : marked)
            EXPECT_TRUE(is_marked) << round << ' ' << edge.first << ' ' << edge.second;
    }
}

TEST(EdgeSurvey, FindsTheTrianglesOfTheSameVertices) {
    Random random(404);
    for (int round = 0; round < test::rounds_within_reason(400); ++round) {
        const IndexedMesh mesh = random_mesh(random);
        const Execution execution{.threads = 1 + static_cast<unsigned>(round) % 3};
        Executor executor(execution);
        std::vector<std::vector<std::uint32_t>> found;
        for (const std::vector<TriangleOverEdge>& group : find_same_vertices(executor, mesh)) {
            std::vector<std::uint32_t>& triangles = found.emplace_back();
            for (const TriangleOverEdge& t : group) {
                triangles.push_back(t.triangle);
                Vertices corners = mesh.triangles[t.triangle];
                std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
                EXPECT_EQ(t.highest, std::max(corners[1], corners[2]));
                EXPECT_EQ(t.upwards, corners[1] < corners[2]) << "from the lowest to the next vertex";
            }
        }
        std::vector<std::vector<std::uint32_t>> expected;
        for (const auto& [vertices, triangles] : same_vertices(mesh)) {
            std::vector<std::uint32_t> all = triangles[0];
            all.insert(all.end(), triangles[1].begin(), triangles[1].end());
            std::sort(all.begin(), all.end());
            if (all.size() > 1)
                expected.push_back(all);
        }
        std::sort(found.begin(), found.end());
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(found, expected) << round;
    }
}

} // namespace
} // namespace lamella::edge_survey_cases
