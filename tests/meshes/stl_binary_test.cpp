#include "fixtures/stl_text.hpp"
#include "meshes/stl_binary.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace lamella::stl_test::stl_binary_cases {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

const Triangles many = some_triangles(24);

TEST(StlExtent, FitsWhenSizeAndCountAgree) {
    for (const std::uint32_t count : {0U, 1U, 2U, 85'899'346U, 0xFFFFFFFEU}) {
        const StlExtent extent = stl_extent(84 + 50 * std::uint64_t{count}, count);
        EXPECT_EQ(extent.triangles, count);
        EXPECT_EQ(extent.remark, "");
    }
}

TEST(StlExtent, NeverLeavesTheFile) {
    for (const std::uint64_t size :
         {std::uint64_t{84}, std::uint64_t{133}, std::uint64_t{134}, std::uint64_t{1284},
          std::uint64_t{0xFFFFFFFF}, std::uint64_t{0x100000000}, std::uint64_t{1} << 43})
        for (const std::uint32_t count : {0U, 1U, 24U, 0x05000000U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFFFU}) {
            const StlExtent extent = stl_extent(size, count);
            EXPECT_LE(84 + 50 * extent.triangles, size);
            if (count != 0 && count != 0xFFFFFFFFU) {
                EXPECT_LE(extent.triangles, count);
            }
        }
}

TEST(StlExtent, TakesAllOfAHugeFileWithoutACount) {
    const std::uint64_t triangles = 6'000'000'000;
    EXPECT_EQ(stl_extent(84 + 50 * triangles, 0).triangles, triangles);
    EXPECT_EQ(stl_extent(84 + 50 * triangles + 49, 0xFFFFFFFFU).triangles, triangles);
}

TEST(StlBinary, TakesTheFileSizeWhenTheCountIsUnknown) {
    expect_warning(binary(many, 0), many,
                   "byte 80: the count is 0; took the 24 triangles that the file has room for");
    expect_warning(binary(many, 0xFFFFFFFF), many,
                   "byte 80: the count is 4294967295; took the 24 triangles that the file has room for");
    expect_warning(
        binary(many, 0) + "tail", many,
        "byte 80: the count is 0; took the 24 triangles that the file has room for, and left out 4 bytes "
        "from byte 1284 on");
}

TEST(StlBinary, TakesWhatIsThereWhenTheCountIsTooLarge) {
    for (const std::uint32_t count : {25U, 9999U, 0x80000000U, 0xFFFFFFFEU})
        expect_warning(
            binary(many, count), many,
            fmt::format("byte 80: the count is {}, but the file ends after 24 whole triangles; took those "
                        "(the file is cut off, or the count is wrong)",
                        count));
}

TEST(StlBinary, TakesTheWholeTrianglesOfATruncatedFile) {
    const std::string whole = binary(many);
    expect_warning(
        whole.substr(0, whole.size() - 20), Triangles(many.begin(), many.end() - 1),
        "byte 80: the count is 24, but the file ends after 23 whole triangles; took those (the file is "
        "cut off, or the count is wrong), and left out 30 bytes from byte 1234 on");
}

TEST(StlBinary, LeavesOutTrailingBytes) {
    expect_warning(binary(many) + "7 bytes", many,
                   "byte 1284: left out 7 bytes that follow the 24 triangles of the count");
    expect_warning(binary(many, 3), Triangles(many.begin(), many.begin() + 3),
                   "byte 234: left out 1050 bytes that follow the 3 triangles of the count");
}

TEST(StlBinary, RefusesAFileWithoutATriangle) {
    EXPECT_EQ(
        error_of(binary({}, 0)),
        "part.stl: holds no triangle: a binary STL file whose count is 0 and that ends after 84 bytes (its "
        "first triangle would end at byte 134)");
    EXPECT_NE(error_of(binary({}, 12)).find("holds no triangle"), std::string::npos);
    EXPECT_NE(error_of(binary(some_triangles(1)).substr(0, 133)).find("holds no triangle"),
              std::string::npos);
}

TEST(StlBinary, LeavesOutTrianglesWithACornerThatIsNotFinite) {
    for (const float bad : {nan, -nan, infinity, -infinity, std::numeric_limits<float>::signaling_NaN(),
                            std::bit_cast<float>(0x7F800001), std::bit_cast<float>(0xFFFFFFFF)})
        for (std::size_t word = 0; word < 9; ++word)
            for (const std::size_t at : {std::size_t{0}, std::size_t{7}, std::size_t{23}}) {
                Triangles broken = many;
                std::memcpy(reinterpret_cast<char*>(&broken[at]) + 4 * word, &bad, 4);
                Triangles kept = many;
                kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(at));
                expect_warning(
                    binary(broken), kept,
                    fmt::format("left out 1 of 24 triangles, which have a corner that is NaN or infinite "
                                "(the first is triangle {} at byte {})",
                                at + 1, 84 + 50 * at));
                const MeshFile file = read(binary(broken));
                EXPECT_EQ(file.stored_triangles, 24U);
                EXPECT_EQ(file.nonfinite_triangles, 1U);
            }
}

TEST(StlBinary, KeepsTheLargestAndSmallestFiniteNumbers) {
    Triangles extreme = many;
    extreme[3][1] = {std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest(),
                     std::numeric_limits<float>::denorm_min()};
    expect_clean(binary(extreme), extreme);
}

TEST(StlBinary, IgnoresNormalsAndAttributes) {
    std::string bytes = binary(many);
    for (std::size_t i = 0; i < many.size(); ++i) {
        for (std::size_t byte = 0; byte < 12; ++byte)
            bytes[84 + 50 * i + byte] = '\xFF'; // NaN
        bytes[84 + 50 * i + 48] = '\xFF';       // a colour
        bytes[84 + 50 * i + 49] = '\xFF';
    }
    expect_clean(bytes, many);
}

TEST(StlBinary, LeavesOutTheSameTrianglesWithAnyNumberOfThreads) {
    Triangles large = some_triangles(100'000);
    Triangles kept;
    for (std::size_t i = 0; i < large.size(); ++i)
        if (i % 977 == 5 || (i >= 40'000 && i < 61'000))
            large[i][i % 3].y = nan;
        else
            kept.push_back(large[i]);
    const std::string bytes = binary(large);
    for (const unsigned threads : {1U, 2U, 7U}) {
        const MeshFile file = read(bytes, {}, threads);
        EXPECT_EQ(triangles_of(file), kept);
        EXPECT_EQ(file.nonfinite_triangles, large.size() - kept.size());
        ASSERT_EQ(file.warnings.size(), 1U);
        EXPECT_NE(file.warnings[0].find("triangle 6 at byte 334"), std::string::npos) << file.warnings[0];
    }
}

TEST(StlBinary, CountsTheCopyOfWhatIsLeft) {
    Triangles broken = many;
    broken[3][1].y = nan;
    const std::uint64_t copy = binary(broken).size() + many.size() * sizeof(Triangle3f);
    EXPECT_EQ(read(binary(broken), {.max_memory = copy}).nonfinite_triangles, 1U);
    EXPECT_EQ(error_of(binary(broken), {.max_memory = copy - 1}, ErrorKind::limit),
              fmt::format("part.stl: takes more than the {} bytes of `max_memory`", copy - 1));
    expect_clean(binary(many), many);
}

TEST(StlBinary, RefusesAFileWithoutAFiniteTriangle) {
    Triangles broken = some_triangles(2);
    broken[0][0].x = nan;
    broken[1][2].z = infinity;
    EXPECT_EQ(error_of(binary(broken)),
              "part.stl: holds no usable triangle: each of the 2 has a corner that is NaN "
              "or infinite (the first is triangle 1 at byte 84)");
}

TEST(StlBinary, TakesTheTextOfTheHeaderForTheName) {
    EXPECT_EQ(read(binary(many, 24, "Exported from Blender-2.91.0")).name, "Exported from Blender-2.91.0");
    EXPECT_EQ(read(binary(many, 24, "  solid part  " + std::string(66, ' '))).name, "solid part");
    EXPECT_EQ(read(binary(many, 24, std::string("COLOR=\1\2\3\4,MATERIAL=", 20))).name, "COLOR=");
    EXPECT_EQ(read(binary(many, 24, "")).name, "");
    EXPECT_EQ(read(binary(many, 24, "St\xFC\x63k")).name, "St\\xfcck");
    EXPECT_EQ(read(binary(many, 24, std::string(80, 'x'))).name, std::string(80, 'x'));
}

TEST(StlBinary, KnowsTheBoxWhereverItsBoundsStand) {
    constexpr float huge = std::numeric_limits<float>::max();
    for (const std::size_t count : {std::size_t{1}, std::size_t{7}, std::size_t{40'001}}) {
        for (std::size_t corner = 0; corner < 9; ++corner) {
            for (const float bound : {huge, -huge, -0.0F}) {
                Triangles triangles(count, Triangle3f{Point3f{1, 2, 3}, Point3f{4, 5, 6}, Point3f{7, 8, 9}});
                Point3f& p = triangles[count * 2 / 3][corner / 3];
                (corner % 3 == 0 ? p.x : corner % 3 == 1 ? p.y : p.z) = bound;
                const std::string bytes = binary(triangles);
                const MeshFile file = read_mesh(std::as_bytes(std::span(bytes)), "box.stl");
                ASSERT_TRUE(soup_of(file).stored_box().has_value());
                EXPECT_EQ(*soup_of(file).stored_box(), bounding_box(TriangleSoup(triangles)))
                    << count << ", " << corner;
                EXPECT_FALSE(bound == 0 && std::signbit(soup_of(file).stored_box()->min.z));
            }
        }
    }
}

TEST(StlBinary, HasNoBoxOfCornersThatItDropped) {
    Triangles triangles = many;
    triangles[3][1].y = -infinity;
    triangles[5][2].z = nan;
    const std::string bytes = binary(triangles);
    const MeshFile file = read_mesh(std::as_bytes(std::span(bytes)), "dropped.stl");
    Triangles kept = many;
    kept.erase(kept.begin() + 5);
    kept.erase(kept.begin() + 3);
    EXPECT_EQ(bounding_box(soup_of(file)), bounding_box(TriangleSoup(kept)));
}

} // namespace
} // namespace lamella::stl_test::stl_binary_cases
