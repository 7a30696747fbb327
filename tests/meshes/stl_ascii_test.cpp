#include "fixtures/stl_text.hpp"
#include "meshes/stl_ascii.hpp"

#include <cmath>
#include <limits>
#include <random>

namespace lamella::stl_test {
namespace {

const Triangles one = some_triangles(1);
const Triangles two = some_triangles(2);
const Triangles many = some_triangles(24);

Triangles twice(Triangles triangles) {
    const Triangles copy = triangles;
    triangles.insert(triangles.end(), copy.begin(), copy.end());
    return triangles;
}

/// A file of one facet whose first coordinate is this text.
std::string with_coordinate(std::string_view number) {
    return fmt::format("solid x\nfacet normal 0 0 1\nouter loop\nvertex {} 0 0\nvertex 0 1 0\nvertex 0 0 "
                       "1\nendloop\nendfacet\nendsolid\n",
                       number);
}

TEST(StlAscii, AcceptsEveryLineEnd) {
    expect_clean(solid(many), many);
    expect_clean(replaced(solid(many), "\n", "\r\n"), many);
    expect_clean(replaced(solid(many), "\n", "\r"), many);
}

TEST(StlAscii, AcceptsAnyBlanks) {
    expect_clean(replaced(solid(many), " ", "\t"), many);
    expect_clean(replaced(solid(many), " ", " \v\f\t  "), many);
    expect_clean(replaced(solid(many), "\n", "\n\n\r\n"), many);
}

TEST(StlAscii, AcceptsAWholeFileOnOneLine) {
    expect_clean(replaced(solid(many), "\n", " "), many);
    expect_clean(replaced(solid(many) + solid(many), "\n", " "), twice(many));
    EXPECT_EQ(read(replaced(solid(many, "my part"), "\n", " ")).name, "my part");
}

TEST(StlAscii, AcceptsOneWordALine) {
    expect_clean(replaced(replaced(solid(many), " ", "\n"), "solid\npart", "solid part"), many);
}

TEST(StlAscii, AcceptsKeywordsInAnyCase) {
    expect_clean(upper_case(solid(many)), many);
    expect_clean(replaced(replaced(solid(many), "facet", "Facet"), "solid", "sOLID"), many);
}

TEST(StlAscii, AcceptsAnyName) {
    const std::vector<std::string> names = {"",
                                            "two words",
                                            std::string(5000, 'n'),
                                            "čřšřěá 部品",
                                            "facet",
                                            "endsolid",
                                            "endfacet facet",
                                            "solid solid",
                                            "bad facet normal",
                                            "facet normals",
                                            "a facet outline"};
    for (const std::string& name : names) {
        expect_clean(solid(many, name), many);
        expect_clean(solid(many, name) + solid(many, name), twice(many));
        if (name.size() < 1000) {
            EXPECT_EQ(read(solid(many, name)).name, name);
        }
    }
    EXPECT_EQ(read(solid(many, std::string(5000, 'n'))).name, std::string(1000, 'n') + "...");
    EXPECT_EQ(read("solid\t blanks around \t\r\n" + facet(one[0]) + "endsolid").name, "blanks around");
}

TEST(StlAscii, JoinsAllSolidsOfAFile) {
    expect_clean(solid(many) + solid(many, "other"), twice(many));
    expect_clean("solid empty\nendsolid empty\n" + solid(many), many);
    expect_clean(solid(many) + "solid empty\nendsolid\n", many);
    EXPECT_EQ(read(solid(many, "first") + solid(many, "second")).name, "first");
}

TEST(StlAscii, AcceptsFacetsAfterTheEndOfASolid) {
    expect_clean(solid(many) + facet(one[0]) + "endsolid", [] {
        Triangles all = many;
        all.push_back(one[0]);
        return all;
    }());
}

TEST(StlAscii, DoesNotCareForNormals) {
    for (const std::string_view normal :
         {"normal nan nan nan", "normal -nan(ind) 1.#IND -1.#QNAN", "normal", "", "normal 0", "normal 0 0",
          "normal 0,0 0,0 1,0", "normal inf -inf 1e99"})
        expect_clean("solid\n" + facet(one[0], normal) + "endsolid\n", one);
}

TEST(StlAscii, PassesOverWhatIsNoNormalAndSaysSo) {
    for (const std::string_view normal : {"normal weirdvalue weirdvalue weirdvalue", "normal undefined",
                                          "normal 0 0 1 4 5", "normal 0 0 weirdvalue", "normal x\t1 2 3 4"}) {
        const std::string text = solid(two) + "solid\n" + facet(one[0], normal) + facet(one[0]) +
                                 facet(one[0], normal) + "endsolid\n";
        for (const std::string& form : {text, replaced(text, "\n", "\r\n")}) {
            const MeshFile file = read(form);
            EXPECT_EQ(file.stored_triangles, 5U) << normal;
            ASSERT_EQ(file.warnings.size(), 1U) << normal;
            EXPECT_EQ(file.warnings[0],
                      "line 18: 2 normals are other words or more than three numbers, which "
                      "were passed over (this is the first); normals are not needed");
        }
        EXPECT_EQ(read(replaced(text, "\n", " ")).stored_triangles, 5U) << normal << ", on one line";
    }
}

TEST(StlAscii, TakesEndsInTwoWordsForOneAndSaysSo) {
    for (const auto& [one_word, two_words] :
         {std::pair("endfacet", "end facet"), {"endloop", "end loop"}, {"endloop", "END\n Loop"}}) {
        const MeshFile file = read(replaced(solid(many), one_word, two_words));
        EXPECT_EQ(triangles_of(file), many);
        ASSERT_EQ(file.warnings.size(), 1U);
        EXPECT_TRUE(file.warnings[0].find("24 keywords are written as two words") != std::string::npos)
            << file.warnings[0];
    }
    const MeshFile file = read(replaced(solid(many), "endsolid", "end solid"));
    EXPECT_EQ(triangles_of(file), many);
    ASSERT_EQ(file.warnings.size(), 1U);
    EXPECT_EQ(triangles_of(read("solid\nend solid\n" + solid(one))), one);
    EXPECT_NE(error_of(replaced(solid(many), "endfacet", "end face")).find("expected 'endfacet'"),
              std::string::npos);
    EXPECT_NE(error_of(replaced(solid(many), "endfacet", "end facet"), {.strict = true}, ErrorKind::defect)
                  .find("line 8: 24 keywords"),
              std::string::npos);
}

TEST(StlAscii, LeavesOutWordsBehindKeywordsAndSaysSo) {
    for (const char* keyword : {"outer loop", "endloop", "endfacet"}) {
        const MeshFile file = read(replaced(solid(many), keyword, std::string(keyword) + " and more"));
        EXPECT_EQ(triangles_of(file), many);
        ASSERT_EQ(file.warnings.size(), 1U);
        EXPECT_TRUE(file.warnings[0].find("24 lines have further words") != std::string::npos)
            << file.warnings[0];
    }
}

TEST(StlAscii, PassesOverComments) {
    for (const char* comment : {"# facet normal", "; outer loop", "// vertex 1 2 3", "! endsolid", "#"}) {
        const std::string line = std::string(comment) + "\n";
        expect_clean(line + solid(many), many);
        expect_clean(replaced(solid(many), "facet normal", line + "facet normal"), many);
        expect_clean(replaced(solid(many), "vertex", line + " vertex"), many);
        expect_clean(
            replaced(replaced(solid(many), "endloop\n", "endloop " + line), "endfacet\n", "endfacet " + line),
            many);
        expect_clean(solid(many) + line, many);
    }
}

TEST(StlAscii, EveryPrefixWithOddWordsGivesItsWholeTriangles) {
    const std::string text =
        replaced(replaced(replaced(solid(two), "endfacet", "end facet 7"), "endloop", "end loop"), "endsolid",
                 "# end\nend solid");
    const std::size_t first = text.find("outer");
    for (std::size_t size = first; size <= text.size(); ++size) {
        const std::string prefix = text.substr(0, size);
        const std::size_t whole = prefix.rfind("end facet") == std::string::npos          ? 0
                                  : prefix.find("end facet") == prefix.rfind("end facet") ? 1
                                                                                          : 2;
        if (whole == 0)
            EXPECT_NE(error_of(prefix), "") << prefix;
        else
            EXPECT_EQ(triangles_of(read(prefix)).size(), whole) << prefix;
    }
}

TEST(StlAscii, ReadsNumbersInEveryWriting) {
    const auto value = [](std::string_view text) {
        return soup_of(read(with_coordinate(text))).stored(0)[0].x;
    };
    EXPECT_EQ(value("1"), 1.0F);
    EXPECT_EQ(value("1."), 1.0F);
    EXPECT_EQ(value(".5"), 0.5F);
    EXPECT_EQ(value("+.5"), 0.5F);
    EXPECT_EQ(value("-.5"), -0.5F);
    EXPECT_EQ(value("+12.25"), 12.25F);
    EXPECT_EQ(value("1.0E+01"), 10.0F);
    EXPECT_EQ(value("-1.25e-2"), -0.0125F);
    EXPECT_EQ(value("1e3"), 1000.0F);
    EXPECT_EQ(value("007"), 7.0F);
    EXPECT_EQ(value("16777217"), 16777216.0F) << "rounded to the nearest, ties to even";
    EXPECT_EQ(value("0.1000000000000000055511151231257827"), 0.1F);
    EXPECT_EQ(value(std::string(400, '0') + "1"), 1.0F);
    EXPECT_EQ(value("3.4028235e38"), std::numeric_limits<float>::max());
}

TEST(StlAscii, TakesNumbersTooSmallForAFloatForTheNearest) {
    const auto value = [](std::string_view text) {
        return soup_of(read(with_coordinate(text))).stored(0)[0].x;
    };
    EXPECT_EQ(value("1e-45"), std::numeric_limits<float>::denorm_min());
    EXPECT_EQ(value("1e-40"), 1e-40F);
    const std::vector<std::string> too_small = {"1e-50",
                                                "-1e-50",
                                                "1e-400",
                                                "0.0000001e-4000000000",
                                                "1e-99999999999999999999999",
                                                "0." + std::string(400, '0') + "1"};
    for (const std::string& tiny : too_small)
        EXPECT_EQ(value(tiny), 0.0F) << tiny;
}

TEST(StlAscii, LeavesOutTrianglesWithACornerThatIsNotFinite) {
    const std::vector<std::string> numbers = {"nan",
                                              "NaN",
                                              "-nan",
                                              "+nan",
                                              "nan(ind)",
                                              "-nan(ind)",
                                              "inf",
                                              "-Infinity",
                                              "+INF",
                                              "1.#IND",
                                              "-1.#IND",
                                              "1.#QNAN",
                                              "1.#INF00",
                                              "1e39",
                                              "-3.5e38",
                                              "1e400",
                                              "+1e99999999999999999999",
                                              std::string(400, '9'),
                                              "0.001e+500"};
    for (const std::string& number : numbers) {
        const std::string text = solid(many) + with_coordinate(number);
        expect_warning(
            text, many,
            "line 172: left out 1 of 25 triangles, which have a corner that is NaN or infinite (this is "
            "the first)");
        EXPECT_EQ(read(text).stored_triangles, 25U);
        EXPECT_EQ(read(text).nonfinite_triangles, 1U);
        EXPECT_EQ(
            error_of(with_coordinate(number)),
            "part.stl: line 2: holds no usable triangle: each of the 1 has a corner that is NaN or infinite");
    }
}

TEST(StlAscii, RefusesWhatIsNoNumber) {
    for (const std::string_view number :
         {"blah", "1,", "--1", "+-1", "-+1", "0x10", "1.5f", "1e", "1e+", "1..2", ".", "+", "1_000", "1.5.",
          "vertex", "\"1\"", "1e999x", "ınf"}) {
        const std::string error = error_of(with_coordinate(number));
        EXPECT_TRUE(error.starts_with(fmt::format("part.stl: line 4: found '{}', expected a number", number)))
            << error;
    }
}

TEST(StlAscii, ExplainsDecimalCommas) {
    EXPECT_EQ(error_of(with_coordinate("1,5")),
              "part.stl: line 4: found '1,5', expected a number with a decimal point and no comma");
    EXPECT_EQ(error_of(with_coordinate("1.5,")),
              "part.stl: line 4: found '1.5,', expected a number with a decimal point and no comma");
}

TEST(StlAscii, RefusesFacetsThatAreNotTriangles) {
    const std::string quad = replaced(solid(one), "endloop", "vertex 1 1 1 endloop");
    EXPECT_EQ(error_of(quad),
              "part.stl: line 2: this facet has more than three vertices, and only triangles can be "
              "read; triangulate the mesh first");
    const std::string corner = "      vertex 0.5 -0.25 0.125\n";
    EXPECT_EQ(error_of(replaced(solid(one), corner, "")),
              "part.stl: line 6: found 'endloop', expected 'vertex'");
}

TEST(StlAscii, NamesTheLineOfAFaultWithAnyLineEnd) {
    for (const std::string_view end : {"\n", "\r\n", "\r"}) {
        const std::string text =
            replaced(solid(two) + "solid b\n" + replaced(facet(one[0]), "endloop", "endlop"), "\n", end);
        EXPECT_EQ(error_of(text), "part.stl: line 23: found 'endlop', expected 'endloop'");
    }
}

TEST(StlAscii, NamesWhatStandsInTheWay) {
    EXPECT_EQ(error_of(replaced(solid(one), "outer loop", "outer lop")),
              "part.stl: line 3: found 'lop', expected 'loop'");
    EXPECT_EQ(error_of(replaced(solid(one), "normal 0 0 1", "normal 0 0 1\n4")),
              "part.stl: line 3: found '4', expected 'outer'");
    EXPECT_EQ(error_of(replaced(solid(one), "outer loop", "vertex")),
              "part.stl: line 3: found 'vertex', expected 'outer'");
    EXPECT_EQ(error_of(replaced(solid(two), "  endfacet\n  facet", "  endfacet\n  fact")),
              "part.stl: line 9: found 'fact', expected 'facet' or 'endsolid'");
    EXPECT_EQ(error_of("solid part\nvertex 0 0 0\n"),
              "part.stl: line 2: found 'vertex', expected 'facet' or 'endsolid'");
    EXPECT_EQ(error_of(replaced(solid(one), "endloop", std::string(100, 'x'))),
              "part.stl: line 7: found '" + std::string(40, 'x') + "...', expected 'endloop'");
}

TEST(StlAscii, RefusesNulBytesWithinTheText) {
    std::string text = solid(two);
    text[text.find("vertex") + 3] = '\0';
    EXPECT_EQ(error_of(text), "part.stl: line 4: found 'ver\\x00ex', expected 'vertex'");
    std::string zero = solid(two);
    zero[zero.find("endfacet") - 1] = '\0';
    EXPECT_EQ(error_of(zero), "part.stl: line 8: found '\\x00endfacet', expected 'endfacet'");
}

TEST(StlAscii, WarnsOfAMissingEndOfASolid) {
    const std::string body = solid(many).substr(0, solid(many).find("endsolid"));
    expect_warning(body, many,
                   "line 170: the file ends without 'endsolid'; it may be cut off, took all 24 triangles");
    expect_warning(body + "endsol", many,
                   "line 170: the file ends without 'endsolid'; it may be cut off, took all 24 triangles");
    expect_warning(body + solid(many), twice(many),
                   "line 170: a solid begins before the one above has ended; 'endsolid' is missing");
}

TEST(StlAscii, LeavesOutTheFacetInWhichTheFileEnds) {
    const std::string whole = solid(many);
    const Triangles before(many.begin(), many.end() - 1);
    const std::size_t last = whole.rfind("  facet") + 2;
    for (std::size_t size = last + 5; size < whole.rfind("endfacet") + 8; ++size)
        expect_warning(
            whole.substr(0, size), before,
            "line 163: the file ends within this facet, which is left out; took the 23 triangles before "
            "it (the file is cut off)");
}

TEST(StlAscii, WarnsOfWhatFollowsTheLastSolid) {
    expect_warning(solid(many) + "\x1A", many,
                   "line 171: left out '\\x1a' and what follows it, after the last 'endsolid'");
    expect_warning(
        solid(many) + std::string(10, '\0') + "\nmade by x", many,
        "line 171: left out '\\x00\\x00\\x00\\x00\\x00\\x00\\x00\\x00\\x00\\x00' and what follows it, after "
        "the last 'endsolid'");
    EXPECT_EQ(error_of(solid(many) + "sold more\n" + facet(one[0])),
              "part.stl: line 171: found 'sold', expected 'solid' or the end of the file")
        << "triangles must not get lost";
}

TEST(StlAscii, RefusesAFileWithoutATriangle) {
    EXPECT_EQ(error_of("solid part\nendsolid part\n"),
              "part.stl: holds no triangle: an ASCII STL file without a facet, 3 lines long");
    EXPECT_NE(error_of("solid part").find("holds no triangle"), std::string::npos);
    EXPECT_EQ(error_of("solid part\nfacet normal 0 0 1\nouter lo"),
              "part.stl: line 3: holds no triangle: the file ends within its first facet");
}

/// Files of several megabytes are parsed in pieces. Nothing of that may be seen.
class StlAsciiInChunks : public testing::Test {
  protected:
    static const Triangles& large() {
        static const Triangles triangles = some_triangles(20'000);
        return triangles;
    }
    static const std::string& text() {
        static const std::string file = solid(large());
        return file;
    }
    static void expect_same_with_any_threads(const std::string& bytes) {
        const MeshFile first = read(bytes, {}, 1);
        const Triangles triangles = triangles_of(first);
        for (const unsigned threads : {2U, 7U}) {
            const MeshFile file = read(bytes, {}, threads);
            EXPECT_EQ(triangles_of(file), triangles);
            EXPECT_EQ(file.warnings, first.warnings);
            EXPECT_EQ(file.stored_triangles, first.stored_triangles);
            EXPECT_EQ(file.nonfinite_triangles, first.nonfinite_triangles);
        }
    }
};

TEST_F(StlAsciiInChunks, GivesTheSameWithAnyNumberOfThreads) {
    ASSERT_GT(text().size(), 2U << 20);
    expect_clean(text(), large());
    expect_same_with_any_threads(text());
    expect_same_with_any_threads(replaced(text(), "\n", " "));
    expect_same_with_any_threads(text() + text() + text());
    expect_same_with_any_threads(replaced(text(), "vertex 300", "vertex nan"));
    expect_same_with_any_threads(text().substr(0, text().size() * 3 / 4));
}

TEST_F(StlAsciiInChunks, IsNotFooledByNamesThatLookLikeFacets) {
    // Everything in these names looks like a good place to begin a piece.
    std::string trap;
    while (trap.size() < 3'000'000)
        trap += "endfacet facet ";
    const std::string file = solid(two, trap) + solid(two);
    for (const unsigned threads : {1U, 7U}) {
        const MeshFile mesh = read(file, {}, threads);
        EXPECT_EQ(triangles_of(mesh), twice(two));
        EXPECT_TRUE(mesh.warnings.empty());
    }
}

TEST_F(StlAsciiInChunks, ReportsTheFirstOfManyFaultsWithItsLine) {
    std::mt19937 random(7);
    for (int round = 0; round < 5; ++round) {
        std::string broken = text();
        std::size_t first = broken.size();
        for (int fault = 0; fault < 4; ++fault) {
            const std::size_t at = broken.find("endloop", random() % (broken.size() - 1000));
            broken[at] = '?';
            first = std::min(first, at);
        }
        const auto line =
            std::count(broken.begin(), broken.begin() + static_cast<std::ptrdiff_t>(first), '\n') + 1;
        for (const unsigned threads : {1U, 2U, 7U}) {
            EXPECT_EQ(test::error_of(ErrorKind::input, [&] { (void)read(broken, {}, threads); }),
                      fmt::format("part.stl: line {}: found '?ndloop', expected 'endloop'", line));
        }
    }
}

TEST_F(StlAsciiInChunks, ReadsSolidsThatEndAnywhere) {
    // A new solid every few facets, so that pieces begin and end in and between solids.
    std::string file;
    Triangles expected;
    for (std::size_t i = 0; i < large().size(); i += 50) {
        const Triangles part(large().begin() + static_cast<std::ptrdiff_t>(i),
                             large().begin() + static_cast<std::ptrdiff_t>(i + 50));
        file += solid(part, "endfacet facet normal");
        expected.insert(expected.end(), part.begin(), part.end());
    }
    expect_clean(file, expected);
    expect_same_with_any_threads(file);
}

} // namespace
} // namespace lamella::stl_test
