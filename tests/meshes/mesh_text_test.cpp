#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "meshes/amf_document.hpp"
#include "meshes/mesh_text.hpp"
#include "meshes/three_mf_model.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::mesh_text_cases {
namespace {

using test::Random;

IndexedMesh random_mesh(Random& random, std::int64_t most) {
    IndexedMesh mesh;
    for (std::int64_t n = random.integer(1, most); n > 0; --n)
        mesh.vertices.push_back({random.real(-9, 9), random.real(-9, 9), random.real(-9, 9)});
    for (std::int64_t n = random.integer(1, most); n > 0; --n) {
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
            "<vertex><coordinates><x>{}</x><y>{}</y><z>{}</z></coordinates></vertex>\r\n", p.x, p.y, p.z);
    for (const TriangleIndices& t : mesh.triangles)
        text.triangles +=
            fmt::format("<triangle><v1>{}</v1><v2>{}</v2><v3>{}</v3></triangle>", t[0], t[1], t[2]);
    return text;
}

/// What was read of a list.
template <class Item>
struct Read {
    std::vector<Item> items;
    std::size_t room = 0;
    std::size_t stop = 0; ///< offset in the list
    std::optional<std::uint64_t> lines;
};

template <class Item>
Read<Item> read(std::string_view list, const MeshTextKind<Item>& kind, std::size_t vertices,
                unsigned threads) {
    constexpr std::string_view before = "<list>";
    const std::string document = fmt::format("{}{}{}></a>", before, list, kind.end_of_list);
    XmlCursor cursor(document, before.size(), document.rfind('<'));
    Executor executor({.threads = threads});
    Read<Item> result;
    read_list(
        cursor, kind, vertices, result.items, [&](std::size_t count) { result.room = count; }, executor);
    result.stop = cursor.position() - before.size();
    result.lines = cursor.lines();
    return result;
}

TEST(MeshText, ReadsTheMeshesThatWereWritten) {
    Random random(551);
    for (int round = 0; round < test::rounds_within_reason(100); ++round) {
        const bool is_amf = round % 2 == 0;
        const MeshTextForm& form = is_amf ? amf_text_form() : three_mf_text_form();
        const IndexedMesh mesh = random_mesh(random, round % 25 == 0 ? 60'000 : 40);
        const Written text = is_amf ? amf(mesh) : three_mf(mesh);
        for (const unsigned threads : {1U, 2U, 3U}) {
            const auto vertices = read(text.vertices, form.vertex, 0, threads);
            EXPECT_TRUE(vertices.items == mesh.vertices) << round;
            EXPECT_EQ(vertices.room, mesh.vertices.size());
            EXPECT_EQ(vertices.stop, text.vertices.size());
            EXPECT_EQ(vertices.lines, line_at(text.vertices + "<", text.vertices.size()) - 1);
            const auto triangles = read(text.triangles, form.triangle, mesh.vertices.size(), threads);
            EXPECT_TRUE(triangles.items == mesh.triangles) << round;
            EXPECT_EQ(triangles.room, mesh.triangles.size());
        }
        std::size_t degenerate = 0;
        for (const TriangleIndices& t : mesh.triangles)
            degenerate += t[0] == t[1] || t[1] == t[2] || t[2] == t[0] ? 1 : 0;
        EXPECT_EQ(degenerate_triangles(mesh), degenerate);
    }
}

TEST(MeshText, StopsBeforeTheFirstElementThatIsNotPlain) {
    Random random(552);
    for (int round = 0; round < test::rounds_within_reason(40); ++round) {
        const MeshTextForm& form = three_mf_text_form();
        const IndexedMesh mesh = random_mesh(random, round % 10 == 0 ? 60'000 : 40);
        const Written text = three_mf(mesh);
        const auto odd = static_cast<std::size_t>(random.bits() % mesh.triangles.size());
        std::size_t at = 0;
        for (std::size_t i = 0; i < odd; ++i)
            at = text.triangles.find("<triangle", at + 1);
        for (const std::string_view element :
             {"<!-- -->", "<triangle v1='&#48;' v2='0' v3='0'/>", "<triangle v1='0' v2='0' v3='60000'/>",
              "<triangle v1='0' v2='0'/>", "text", "<other/>", "<triangle v1='0' v1='0' v3='0'/>"}) {
            std::string changed = text.triangles;
            changed.insert(at, element);
            for (const unsigned threads : {1U, 3U}) {
                const auto some = read(changed, form.triangle, mesh.vertices.size(), threads);
                EXPECT_EQ(some.stop, at) << element;
                ASSERT_EQ(some.items.size(), odd) << element;
                EXPECT_TRUE(std::equal(some.items.begin(), some.items.end(), mesh.triangles.begin()));
            }
        }
    }
}

// Whatever is changed, indices are valid, and what is left begins with a tag or a text.
TEST(MeshText, ReadsNoInvalidIndices) {
    Random random(553);
    std::size_t left = 0;
    std::size_t whole = 0;
    for (int round = 0; round < test::rounds_within_reason(4000); ++round) {
        const bool is_amf = round % 2 == 0;
        const MeshTextForm& form = is_amf ? amf_text_form() : three_mf_text_form();
        const IndexedMesh mesh = random_mesh(random, 6);
        std::string text = (is_amf ? amf(mesh) : three_mf(mesh)).triangles;
        for (std::int64_t n = random.integer(1, 2); n > 0 && !text.empty(); --n) {
            const auto at = static_cast<std::size_t>(random.bits() % text.size());
            if (random.integer(0, 1) == 0)
                text[at] = "<>/\"= 0a&9-."[random.bits() % 12];
            else
                text.erase(at, static_cast<std::size_t>(random.integer(1, 9)));
        }
        const auto some = read(text, form.triangle, mesh.vertices.size(), 1);
        EXPECT_LE(some.items.size(), some.room);
        EXPECT_LE(some.stop, text.size());
        for (const TriangleIndices& t : some.items)
            for (const std::uint32_t corner : t)
                EXPECT_LT(corner, mesh.vertices.size());
        (some.stop == text.size() ? whole : left) += 1;
    }
    EXPECT_GT(left, test::slowed ? 0U : 100U);
    EXPECT_GT(whole, test::slowed ? 0U : 10U);
}

TEST(MeshText, ReadsNothingOfAListWithoutEndOrOfOtherElements) {
    const std::string vertex = "<vertex x='1' y='2' z='3'/>";
    const auto triangle = read("<triangle/>" + vertex, three_mf_text_form().vertex, 0, 1);
    EXPECT_EQ(triangle.stop, 0U);
    EXPECT_TRUE(triangle.items.empty());
    const std::string document = vertex + "</a>";
    XmlCursor cursor(document, 0, document.rfind('<'));
    Executor executor({.threads = 2});
    std::vector<Point3> items;
    read_list(
        cursor, three_mf_text_form().vertex, 0, items, [](std::size_t) {}, executor);
    EXPECT_EQ(cursor.position(), 0U);
}

} // namespace
} // namespace lamella::mesh_text_cases
