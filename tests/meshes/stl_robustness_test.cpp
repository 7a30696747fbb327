// The reader meets an enemy: cut files, changed bytes, lying numbers. Whatever comes, it answers with finite
// triangles or with an error of one line.

#include "fixtures/mutations.hpp"
#include "fixtures/rounds.hpp"
#include "fixtures/stl_text.hpp"

#include <cmath>
#include <memory>
#include <optional>
#include <random>

namespace lamella::stl_test {
namespace {

/// Reads from memory of exactly this size, so that a sanitizer sees one byte too far. Returns the number of
/// triangles, none when the file was refused.
std::optional<std::size_t> survive(std::string_view bytes, unsigned threads = 1) {
    const std::unique_ptr<std::byte[]> exact(new std::byte[bytes.size()]);
    std::memcpy(exact.get(), bytes.data(), bytes.size());
    try {
        const MeshFile file = read_mesh({exact.get(), bytes.size()}, "part.stl", {}, {.threads = threads});
        EXPECT_EQ(soup_of(file).size() + file.nonfinite_triangles, file.stored_triangles);
        EXPECT_FALSE(soup_of(file).empty());
        for (std::size_t i = 0; i < soup_of(file).size(); ++i)
            for (const Point3f& p : soup_of(file).stored(i))
                EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
        for (const std::string& warning : file.warnings)
            EXPECT_EQ(warning.find('\n'), std::string::npos);
        return soup_of(file).size();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
        EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << error.what();
        return std::nullopt;
    }
}

TEST(StlRobustness, EveryPrefixOfABinaryFileGivesItsWholeTriangles) {
    const std::string whole = binary(some_triangles(5));
    for (std::size_t size = 0; size <= whole.size(); ++size) {
        const std::optional<std::size_t> count = survive(std::string_view(whole).substr(0, size));
        EXPECT_EQ(count.value_or(0), size < 84 ? 0 : (size - 84) / 50) << size;
    }
}

TEST(StlRobustness, EveryPrefixOfAnAsciiFileGivesItsWholeTriangles) {
    for (const std::string& whole :
         {solid(some_triangles(5)), replaced(solid(some_triangles(5)), "\n", "\r\n"),
          replaced(solid(some_triangles(5)), "\n", " "), "\xEF\xBB\xBF" + solid(some_triangles(5), "čřš")})
        for (std::size_t size = 0; size <= whole.size(); ++size) {
            const std::string_view prefix = std::string_view(whole).substr(0, size);
            std::size_t expected = 0;
            for (std::size_t at = 0; (at = prefix.find("endfacet", at)) != std::string_view::npos; at += 8)
                ++expected;
            EXPECT_EQ(survive(prefix).value_or(0), expected) << prefix;
        }
}

TEST(StlRobustness, SurvivesMutations) {
    std::mt19937 random(20'21);
    const std::vector<std::string> seeds = {binary(some_triangles(3)),
                                            binary(some_triangles(3), 3, "solid part"),
                                            binary(some_triangles(3), 0xFFFFFFFF, "solid part\nfacet normal"),
                                            solid(some_triangles(3)),
                                            solid(some_triangles(1)) + solid(some_triangles(2), "facet"),
                                            replaced(solid(some_triangles(3)), "\n", " ")};
    const std::vector<std::string> words = {"solid",  "endsolid", "facet",    "normal", "outer", "loop",
                                            "vertex", "endloop",  "endfacet", "nan",    "1e400", "+",
                                            "-",      "\r",       "\n",       "0,5"};
    std::size_t read_anyway = 0;
    for (int round = 0; round < 6000; ++round) {
        std::string bytes = seeds[random() % seeds.size()];
        test::mutate(bytes, random, words);
        read_anyway += survive(bytes).has_value() ? 1 : 0;
    }
    EXPECT_GT(read_anyway, 500U) << "the mutations are so wild that they test nothing";
}

TEST(StlRobustness, SurvivesHostileText) {
    const auto repeat = [](std::string_view unit) {
        std::string text;
        while (text.size() < 2'200'000)
            text += unit;
        return text;
    };
    for (const std::string_view unit :
         {"facet ", "facet normal ", "facet normal 0 ", "facet outer ", "endfacet facet ", "endsolid ",
          "solid ", "endsolid\nsolid\n", "endsolid\nx\n", "endsolid x endfacet facet normal 0 outer ",
          "vertex ", "0 ", " ", "\r"})
        for (const std::string_view begin : {"solid ", "solid\n"}) {
            if (test::slowed && begin == "solid\n")
                continue;
            const std::string text = std::string(begin) + repeat(unit);
            EXPECT_FALSE(survive(text, 2).has_value()) << begin << unit;
            survive(text + "\n" + facet(some_triangles(1)[0]), 2);
            survive(text + "\nendsolid\n" + solid(some_triangles(1)), 2);
        }
}

} // namespace
} // namespace lamella::stl_test
