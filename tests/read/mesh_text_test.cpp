#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "read/amf_document.hpp"
#include "read/in_memory.hpp"
#include "read/mesh_text.hpp"
#include "read/three_mf_model.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::mesh_text_cases {
namespace {

using test::Random;
constexpr std::uint64_t most_bytes = 100'000'000;

IndexedMesh random_mesh(Random& random, std::int64_t most) {
    IndexedMesh mesh;
    for (std::int64_t n = random.integer(1, most); n > 0; --n)
        mesh.vertices.push_back({random.real(-9, 9), random.real(-9, 9), random.real(-9, 9)});
    for (std::int64_t n = random.integer(0, most); n > 0; --n) {
        TriangleIndices& t = mesh.triangles.emplace_back();
        for (std::uint32_t& corner : t)
            corner = static_cast<std::uint32_t>(random.bits() % mesh.vertices.size());
    }
    return mesh;
}

struct Written {
    std::string vertices;
    std::string triangles;
};

Written three_mf(const IndexedMesh& mesh) {
    Written text;
    for (const Point3& p : mesh.vertices)
        text.vertices += fmt::format("<vertex x=\"{}\" y=\"{}\" z=\"{}\" />\n", p.x, p.y, p.z);
    for (const TriangleIndices& t : mesh.triangles)
        text.triangles += fmt::format("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/> ", t[0], t[1], t[2]);
    return text;
}

Written amf(const IndexedMesh& mesh) {
    Written text;
    for (const Point3& p : mesh.vertices)
        text.vertices += fmt::format(
            "<vertex><coordinates><x>{}</x><y>{}</y><z>{}</z></coordinates></vertex>\n", p.x, p.y, p.z);
    for (const TriangleIndices& t : mesh.triangles)
        text.triangles +=
            fmt::format("<triangle><v1>{}</v1><v2>{}</v2><v3>{}</v3></triangle>", t[0], t[1], t[2]);
    return text;
}

/// The sequences of several texts, each of them followed by '<'.
struct Texts {
    void add(const Written& written) {
        texts.emplace_back();
        for (const auto& [text, runs] : {std::pair(&written.vertices, &MeshText::vertices),
                                         {&written.triangles, &MeshText::triangles}}) {
            kept.push_back(std::make_unique<std::string>(*text + "</"));
            if (!text->empty())
                (texts.back().*runs).push_back(std::string_view(*kept.back()).substr(0, text->size()));
        }
    }
    std::vector<std::unique_ptr<std::string>> kept;
    std::vector<MeshText> texts;
};

TEST(MeshText, ReadsTheMeshesThatWereWritten) {
    Random random(551);
    for (int round = 0; round < test::rounds_within_reason(100); ++round) {
        const bool is_amf = round % 2 == 0;
        Texts texts;
        std::vector<IndexedMesh> meshes;
        for (std::int64_t n = random.integer(1, 5); n > 0; --n) {
            meshes.push_back(random_mesh(random, round % 25 == 0 ? 30'000 : 40));
            texts.add(is_amf ? amf(meshes.back()) : three_mf(meshes.back()));
        }
        const ByteSource source = test::source_of("x");
        ReadLimits limits(source, MeshReadOptions{.max_memory = most_bytes});
        const std::uint64_t before = test::bytes_counted(limits, most_bytes);
        const Execution execution{.threads = 1 + static_cast<unsigned>(round) % 3};
        Executor executor(execution);
        const auto found =
            read_mesh_texts(texts.texts, is_amf ? amf_text_form() : three_mf_text_form(), limits, executor);
        ASSERT_EQ(found.size(), meshes.size());
        std::uint64_t bytes = 0;
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            ASSERT_TRUE(found[i]) << round;
            EXPECT_TRUE(found[i]->vertices == meshes[i].vertices) << round;
            EXPECT_TRUE(found[i]->triangles == meshes[i].triangles) << round;
            bytes += meshes[i].vertices.size() * sizeof(Point3) +
                     meshes[i].triangles.size() * sizeof(TriangleIndices);
            std::size_t degenerate = 0;
            for (const TriangleIndices& t : meshes[i].triangles)
                degenerate += t[0] == t[1] || t[1] == t[2] || t[2] == t[0] ? 1 : 0;
            EXPECT_EQ(degenerate_triangles(*found[i]), degenerate);
        }
        EXPECT_EQ(test::bytes_counted(limits, most_bytes) - before, bytes);
        for (const auto& mesh : found)
            give_back(*mesh, limits);
        EXPECT_EQ(test::bytes_counted(limits, most_bytes), before);
    }
}

// Whatever is changed, a mesh is either left to the parser or has valid indices; and nothing stays counted.
TEST(MeshText, LeavesTextsThatAreNotPlainToTheParser) {
    Random random(552);
    std::size_t left = 0;
    std::size_t read = 0;
    for (int round = 0; round < test::rounds_within_reason(4000); ++round) {
        const bool is_amf = round % 2 == 0;
        const IndexedMesh mesh = random_mesh(random, 6);
        Written text = is_amf ? amf(mesh) : three_mf(mesh);
        std::string& some =
            random.integer(0, 1) == 0 && !text.triangles.empty() ? text.triangles : text.vertices;
        for (std::int64_t n = random.integer(1, 2); n > 0; --n) {
            const auto at = static_cast<std::size_t>(random.bits() % some.size());
            if (random.integer(0, 1) == 0)
                some[at] = "<>/\"= 0a&9-."[random.bits() % 12];
            else
                some.erase(at, static_cast<std::size_t>(random.integer(1, 9)));
            if (some.empty() || some[0] != '<')
                some.insert(0, "<");
        }
        Texts texts;
        texts.add(text);
        texts.add(is_amf ? amf(mesh) : three_mf(mesh));
        const ByteSource source = test::source_of("x");
        ReadLimits limits(source, MeshReadOptions{.max_memory = most_bytes});
        const std::uint64_t before = test::bytes_counted(limits, most_bytes);
        const Execution execution{.threads = 1};
        Executor executor(execution);
        const auto found =
            read_mesh_texts(texts.texts, is_amf ? amf_text_form() : three_mf_text_form(), limits, executor);
        ASSERT_TRUE(found[1]);
        EXPECT_TRUE(found[1]->triangles == mesh.triangles) << "the other mesh is as it was";
        if (found[0]) {
            ++read;
            for (const TriangleIndices& t : found[0]->triangles)
                for (const std::uint32_t corner : t)
                    EXPECT_LT(corner, found[0]->vertices.size());
            give_back(*found[0], limits);
        } else {
            ++left;
        }
        give_back(*found[1], limits);
        EXPECT_EQ(test::bytes_counted(limits, most_bytes), before) << round;
    }
    EXPECT_GT(left, test::slowed ? 0U : 100U);
    EXPECT_GT(read, test::slowed ? 0U : 10U);
}

TEST(MeshText, TakesARunUpToTheEndOfItsList) {
    const std::string_view document = "<vertices><vertex/><vertex/></vertices>";
    std::vector<std::string_view> runs;
    Executor executor({.threads = 1});
    XmlCursor cursor(document, 10, document.rfind('<'));
    take_run(cursor, "</triangles", runs, executor);
    EXPECT_EQ(cursor.position(), 10U);
    take_run(cursor, "</vertices", runs, executor);
    EXPECT_EQ(cursor.position(), 28U);
    EXPECT_EQ(runs, std::vector<std::string_view>{"<vertex/><vertex/>"});
    EXPECT_EQ(runs.size(), 1U);
}

TEST(MeshText, TakesLongRunsAlikeWithAnyNumberOfThreads) {
    test::Random random(9);
    for (int round = 0; round < test::rounds_within_reason(30); ++round) {
        std::string document(static_cast<std::size_t>(random.integer(1, 12'000'000)), 'v');
        for (int i = 0; i < 1000; ++i)
            document[static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(document.size()) -
                                                                    1))] = "\r\n"[random.integer(0, 1)];
        const auto location = static_cast<std::size_t>(
            random.integer(0, static_cast<std::int64_t>(std::min<std::size_t>(document.size(), 3'000'000))));
        const std::size_t length = document.size() - location;
        document += "</v></v>";
        for (const unsigned threads : {1U, 2U, 5U}) {
            Executor executor({.threads = threads});
            std::vector<std::string_view> runs;
            XmlCursor cursor(document, location, document.rfind('<'));
            take_run(cursor, "</w", runs, executor);
            EXPECT_EQ(cursor.position(), location);
            take_run(cursor, "</v", runs, executor);
            EXPECT_EQ(cursor.position(), location + length) << threads;
            EXPECT_EQ(cursor.lines(), line_at(std::string_view(document).substr(location), length) - 1)
                << threads;
            EXPECT_EQ(runs.size(), 1U);
        }
    }
}

} // namespace
} // namespace lamella::mesh_text_cases
