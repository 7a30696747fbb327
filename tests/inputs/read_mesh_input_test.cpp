// A file read batch by batch says the same as one read whole.

#include "lamella/inputs/read_file.hpp"

#include "fixtures/mutations.hpp"
#include "fixtures/rounds.hpp"
#include "fixtures/stl_text.hpp"
#include "inputs/streamed_mesh.hpp"
#include "parts/shapes.hpp"
#include "temporary_folder.hpp"

#include <limits>
#include <map>
#include <mutex>
#include <random>
#include <stdexcept>
#include <thread>

namespace lamella::stl_test {
namespace {

std::string error_text(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

/// Read whole and streamed: the same triangles, counts, warnings and errors.
void expect_agreement(const std::string& bytes) {
    const TemporaryFolder folder;
    const std::string path = folder.file("part.stl");
    write_file(path, bytes);
    const MeshInput input(path);
    for (const bool strict : {false, true}) {
        MeshFile whole;
        Triangles expected;
        const std::string error = error_text([&] {
            whole = input.read({.strict = strict});
            expected = triangles_of(whole);
        });
        for (const unsigned threads : {1U, 2U, 7U}) {
            Streamed streamed;
            EXPECT_EQ(error_text([&] { streamed = stream(input, {.strict = strict}, threads); }), error);
            if (error != "no error")
                continue;
            EXPECT_EQ(streamed.triangles, expected);
            EXPECT_EQ(streamed.file.path, whole.path);
            EXPECT_EQ(streamed.file.format, whole.format);
            EXPECT_EQ(streamed.file.name, whole.name);
            EXPECT_EQ(streamed.file.stored_triangles, whole.stored_triangles);
            EXPECT_EQ(streamed.file.nonfinite_triangles, whole.nonfinite_triangles);
            EXPECT_EQ(streamed.file.warnings, whole.warnings);
            ASSERT_EQ(streamed.file.objects.size(), 1U);
            EXPECT_TRUE(streamed.file.objects.front().mesh.empty());
        }
    }
}

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

TEST(MeshInput, StreamsWhatItReads) {
    const Triangles many = some_triangles(test::slowed ? 40'000 : 100'000); // more than one batch
    expect_agreement(binary(some_triangles(1)));
    expect_agreement(binary(many));
    expect_agreement(solid(some_triangles(1)));
    expect_agreement(solid(many) + solid(some_triangles(3)));
}

TEST(MeshInput, StreamsOddFilesWithTheSameWarnings) {
    Triangles many = some_triangles(80'000);
    expect_agreement(binary(many, 0));
    expect_agreement(binary(many, 90'000));
    expect_agreement(binary(many, 70'000) + "tail");
    expect_agreement(binary(many).substr(0, 3'000'000));
    expect_agreement(solid(many).substr(0, 5'000'000));
    expect_agreement(solid(many) + "what is this?");
    many[0][1].x = many[40'000][2].z = many[79'999][0].y = nan;
    expect_agreement(binary(many));
    for (std::size_t i = 32'768; i < 65'536; ++i)
        many[i][0].x = nan; // of one batch, all
    expect_agreement(binary(many));
    expect_agreement(solid(many));
}

TEST(MeshInput, RefusesWhatReadingRefuses) {
    Triangles none = some_triangles(9);
    for (Triangle3f& t : none)
        t[0].x = nan;
    expect_agreement(binary(none));
    expect_agreement(binary({}));
    expect_agreement("solid empty\nendsolid empty\n");
    expect_agreement(replaced(solid(some_triangles(9)), "vertex 3", "vertex three"));
    expect_agreement("this is no mesh\n");
    expect_agreement("short");
}

TEST(MeshInput, StreamsDamagedFilesAsItReadsThem) {
    std::mt19937 random(7);
    for (int i = 0; i < 60; ++i) {
        std::string bytes = i % 2 == 0 ? binary(some_triangles(40)) : solid(some_triangles(40));
        test::mutate(bytes, random, {"facet", "solid x\n", "nan", "endsolid"});
        const TemporaryFolder folder;
        write_file(folder.file("part.stl"), bytes);
        const MeshInput input(folder.file("part.stl"));
        bool can_stream = false;
        if (error_text([&] { can_stream = input.can_stream(); }) == "no error" && can_stream)
            expect_agreement(bytes);
    }
}

TEST(MeshInput, SharesOfABinaryFileAreTheWhole) {
    const Triangles many = some_triangles(70'001);
    const TemporaryFolder folder;
    write_file(folder.file("part.stl"), binary(many));
    const MeshInput input(folder.file("part.stl"));
    ASSERT_EQ(input.records(), many.size());
    Triangles found;
    for (std::uint64_t begin = 0; begin < many.size();) {
        const std::uint64_t end = std::min<std::uint64_t>(many.size(), begin + 1 + begin);
        const Triangles share = stream(input, {}, 2, RecordRange{begin, end}).triangles;
        EXPECT_EQ(share.size(), end - begin);
        found.insert(found.end(), share.begin(), share.end());
        begin = end;
    }
    EXPECT_EQ(found, many);
    EXPECT_TRUE(stream(input, {}, 1, RecordRange{5, 5}).triangles.empty());
    EXPECT_THROW(static_cast<void>(stream(input, {}, 1, RecordRange{5, 70'002})), Error);
}

TEST(MeshInput, CountsWhatIsUnusableInAShareAndWhatIsStoredInTheWhole) {
    const TemporaryFolder folder;
    Triangles many = some_triangles(20);
    many[2][0].x = many[12][0].x = many[13][0].x = nan;
    write_file(folder.file("part.stl"), binary(many));
    const MeshInput input(folder.file("part.stl"));
    const MeshFile file = stream(input, {.max_triangles = 20}, 1, RecordRange{10, 15}).file;
    EXPECT_EQ(file.stored_triangles, 20U);
    EXPECT_EQ(file.nonfinite_triangles, 2U);
    EXPECT_EQ(file.first_nonfinite, 12U);
    EXPECT_TRUE(file.warnings.empty()) << "left to whoever knows all shares";
    EXPECT_EQ(stream(input, {}, 1, RecordRange{12, 14}).file.nonfinite_triangles, 2U) << "all of it";
    EXPECT_NE(error_text([&] {
                  stream(input, {.max_triangles = 19}, 1, RecordRange{10, 15});
              }).find("`max_triangles`"),
              std::string::npos);
}

TEST(MeshInput, SaysWhatCannotBeShared) {
    const TemporaryFolder folder;
    write_file(folder.file("part.stl"), solid(some_triangles(5)));
    write_file(folder.file("part.off"), "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const MeshInput ascii(folder.file("part.stl"));
    EXPECT_FALSE(ascii.records());
    EXPECT_NE(error_text([&] { stream(ascii, {}, 1, RecordRange{0, 2}); }).find("ASCII"), std::string::npos);
    const MeshInput off(folder.file("part.off"));
    EXPECT_FALSE(off.can_stream());
    EXPECT_FALSE(off.records());
    EXPECT_THROW(stream(off), Error);
    EXPECT_EQ(off.read().format, "off");
}

TEST(MeshInput, KeepsTheLimitOfTriangles) {
    const TemporaryFolder folder;
    for (const std::string& bytes : {binary(some_triangles(50'000)), solid(some_triangles(50'000))}) {
        write_file(folder.file("part.stl"), bytes);
        const MeshInput input(folder.file("part.stl"));
        EXPECT_EQ(stream(input, {.max_triangles = 50'000}).triangles.size(), 50'000U);
        EXPECT_NE(error_text([&] { stream(input, {.max_triangles = 49'999}); }).find("`max_triangles`"),
                  std::string::npos);
    }
}

TEST(MeshInput, GivesOnWhatTheSinkThrows) {
    const TemporaryFolder folder;
    for (const std::string& bytes : {binary(some_triangles(100'000)), solid(some_triangles(100'000))}) {
        write_file(folder.file("part.stl"), bytes);
        const MeshInput input(folder.file("part.stl"));
        const TriangleSink sink = [](const TriangleSoup&, std::uint64_t) {
            throw std::runtime_error("enough");
        };
        EXPECT_THROW(input.stream(sink, {}, {.threads = 2}), std::runtime_error);
    }
}

} // namespace
} // namespace lamella::stl_test
