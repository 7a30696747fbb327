// Which form a file has, whatever it claims.

#include "lamella/inputs/read_file.hpp"

#include "fixtures/stl_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <future>

namespace lamella::stl_test::stl_cases {
namespace {

const Triangles one = some_triangles(1);
const Triangles two = some_triangles(2);
const Triangles many = some_triangles(24);

TEST(Stl, ReadsBothFormsAndNamesThem) {
    EXPECT_EQ(read(binary(many)).format, "stl-binary");
    EXPECT_EQ(read(solid(many)).format, "stl-ascii");
}

TEST(Stl, GivesTheSameCornersFromBothForms) {
    // Numbers that no short decimal represents: both forms round them once, to single precision.
    Triangles odd = many;
    for (std::size_t i = 0; i < odd.size(); ++i)
        odd[i][i % 3] = {1.0F / 3 * static_cast<float>(i), 1e-30F / 7, -123456.789F};
    EXPECT_EQ(triangles_of(read(solid(odd))), triangles_of(read(binary(odd))));
    EXPECT_EQ(triangles_of(read(solid(odd))), odd);
}

TEST(Stl, BelievesTheSizeBeforeTheWordSolid) {
    for (const char* header : {"solid part", "solid\nfacet normal 0 0 1 outer loop", "  SOLID facet"}) {
        const MeshFile file = read(binary(many, 24, header));
        EXPECT_EQ(file.format, "stl-binary") << header;
        EXPECT_EQ(triangles_of(file), many) << header;
        EXPECT_TRUE(file.warnings.empty()) << header;
    }
}

TEST(Stl, TakesABinaryFileThatBeginsWithSolidAndHasAWrongCountForBinary) {
    const MeshFile file = read(binary(many, 0, "solid part"));
    EXPECT_EQ(file.format, "stl-binary");
    EXPECT_EQ(triangles_of(file), many);
}

TEST(Stl, ReadsTinyBinaryFiles) {
    expect_clean(binary(one), one);
    expect_clean(binary(two), two);
}

TEST(Stl, LooksForSolidAfterAByteOrderMarkAndBlanks) {
    expect_clean("\xEF\xBB\xBF" + solid(many), many);
    expect_clean("\xEF\xBB\xBF \r\n\t" + solid(many), many);
    expect_clean(" \n\f\v" + solid(one), one);
}

TEST(Stl, NamesTheFormatOfAForeignFile) {
    const std::string tail(200, '\1');
    const auto says = [&](const std::string& begin, const std::string& part) {
        const std::string error = error_of(begin + tail);
        EXPECT_NE(error.find(part), std::string::npos) << error;
        EXPECT_TRUE(error.starts_with("part.stl: ")) << error;
        error_of(begin); // as short as that, too
    };
    says("\x1F\x8B\x08", "gzip");
    says("PK\x03\x04", "zip archive");
    says("<!DOCTYPE html><html>", "web page");
    says("\n <HTML>", "web page");
    says("<?xml version=\"1.0\"?>", "XML");
    says("version https://git-lfs.github.com/spec/v1\n", "git lfs pull");
    says(std::string("\xFF\xFEs\0o\0l\0", 8), "UTF-16");
    says("\x89PNG\r\n\x1A\n", "an image");
    says("\xFF\xD8\xFF\xE0", "an image");
    says("%PDF-1.7", "PDF");
    says("\x7F"
         "ELF\2",
         "a program");
    says("\xFD"
         "7zXZ",
         "decompress it first");
    says("EOS 1993 SLI FILE   ", "export CLI instead");
    says("ISO-10303-21;\nHEADER;\n", "surfaces without triangles");
    says("\xD0\xCF\x11\xE0\xA1\xB1", "surfaces without triangles");
    says("glTF\2", "save it as STL, 3MF, OBJ or PLY");
}

TEST(Stl, NamesATarArchiveOfAnyKind) {
    for (const char* magic : {"", "ustar"}) {
        std::string header(512, '\0');
        header.replace(0, 8, "part.stl");
        header.replace(100, 23, "0000644\0000000000\0000000", 23);
        header.replace(257, std::string(magic).size(), magic);
        unsigned sum = 8 * ' ';
        for (const char c : header)
            sum += static_cast<unsigned char>(c);
        header.replace(148, 7, fmt::format("{:06o}", sum) + std::string(1, '\0'));
        EXPECT_EQ(error_of(header + binary(many) + std::string(1024, '\0')),
                  "part.stl: is a tar archive, no mesh file; unpack it, and take the mesh that is in it");
    }
}

TEST(Stl, RefusesABinaryFileThatATransferInTextModeHasDamaged) {
    const std::size_t n = 2000;
    Triangles triangles = some_triangles(n);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            triangles[i][k] = {static_cast<float>(std::sin(static_cast<double>(3 * i + k)) * 20),
                               static_cast<float>(std::cos(static_cast<double>(5 * i + k)) * 20),
                               static_cast<float>(i) * 0.01F + 1};
    const std::string bytes = binary(triangles);
    ASSERT_EQ(triangles_of(read(bytes)).size(), n);
    std::string as_utf8;
    for (const char c : bytes)
        as_utf8 += static_cast<unsigned char>(c) < 0x80 ? std::string(1, c) : "\xEF\xBF\xBD";
    std::string without_one = bytes;
    without_one.erase(60'000, 1);
    for (const std::string& damaged :
         {replaced(bytes, "\n", "\r\n"), replaced(replaced(bytes, "\r", ""), "\n", "\r\n"), as_utf8,
          without_one}) {
        ASSERT_NE(damaged.size(), bytes.size());
        EXPECT_NE(
            error_of(damaged).find("part.stl: is a binary STL file that was damaged, as by a transfer or a "
                                   "checkout in text mode"),
            std::string::npos);
    }
    // What is cut off or has more behind it is read as far as it goes.
    EXPECT_EQ(triangles_of(read(bytes.substr(0, 60'001))).size(), (60'001 - 84) / 50);
    EXPECT_EQ(triangles_of(read(bytes + "1234567")).size(), n);
}

TEST(Stl, ReadsABinaryFileWhoseHeaderLooksForeign) {
    expect_clean(binary(many, 24, "\x89PNG"), many);
    expect_clean(binary(many, 24, "PK\x03\x04"), many);
    expect_clean(binary(many, 24, "<html>"), many);
}

TEST(Stl, NeverTakesTextForBinaryTriangles) {
    const std::string points = "# a point cloud\n" + replaced(std::string(300, 'x'), "x", "1 2 3\n");
    EXPECT_EQ(error_of(points),
              "part.stl: line 1: is a text, but no mesh file: found '# a point cloud', expected 'solid' of "
              "an ASCII STL file, or the beginning of another mesh format");
    EXPECT_EQ(error_of("\n\n  ply\nformat ascii 1.0\n"),
              "part.stl: line 3: is a text, but no mesh file: found 'ply', expected 'solid' of an ASCII STL "
              "file, or the beginning of another mesh format");
    EXPECT_EQ(error_of("solidpart\n" + facet(one[0])),
              "part.stl: line 1: is a text, but no mesh file: found 'solidpart', expected 'solid' of an "
              "ASCII STL file, or the beginning of another mesh format");
    EXPECT_EQ(error_of(" \n "), "part.stl: line 2: is a text, but no mesh file: found '', expected 'solid' "
                                "of an ASCII STL file, or the beginning of another mesh format");
}

TEST(Stl, RefusesWhatIsTooShortToBeAnything) {
    EXPECT_EQ(
        error_of(binary(one).substr(0, 83)),
        "part.stl: is not an STL file, or cut off: found 83 bytes, expected at least 84 (binary) or the word "
        "'solid' (ASCII)");
    EXPECT_EQ(error_of(""), "part.stl: is empty, expected a file with content");
    EXPECT_NE(error_of("s").find("expected 'solid'"), std::string::npos);
}

TEST(Stl, StopsAtMoreTrianglesThanAllowed) {
    for (const std::string& bytes : {binary(many), solid(many)}) {
        EXPECT_EQ(read(bytes, {.max_triangles = many.size()}).stored_triangles, many.size());
        EXPECT_NE(
            error_of(bytes, {.max_triangles = many.size() - 1}, ErrorKind::limit).find("`max_triangles`"),
            std::string::npos);
    }
}

TEST(Stl, SaysWhichFileCannotBeOpened) {
    EXPECT_THROW((void)read_mesh("/nowhere/part.stl"), Error);
    try {
        (void)read_mesh("/nowhere/part.stl");
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_STREQ(error.what(), "/nowhere/part.stl: there is no such file");
    }
}

/// A file of its own for each test, gone afterwards.
class StlOnDisk : public testing::Test {
  protected:
    void SetUp() override {
        const int descriptor = mkstemp(path_.data());
        ASSERT_GE(descriptor, 0);
        close(descriptor);
    }
    void TearDown() override { unlink(path_.c_str()); }

    void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }
    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    std::string path_ = testing::TempDir() + "/lamella-stl-XXXXXX";
};

TEST_F(StlOnDisk, NeedsABinaryFileNoLongerOnceItIsRead) {
    write(binary(many));
    const MeshFile file = read_mesh(path());
    write("");
    EXPECT_EQ(triangles_of(file), many);
}

TEST_F(StlOnDisk, ViewsACopyOfABinaryFileOnDiskWhereMemoryIsShort) {
    const Triangles more = some_triangles(2'000); // small files are read at once
    write(binary(more));
    const MeshFile file = read_mesh(path(), {.max_memory = 100});
    EXPECT_EQ(file.path, path());
    EXPECT_EQ(soup_of(file).stride(), 50U);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(soup_of(file).data()) % 4096, 96U)
        << "84 + 12 bytes into a page";
    EXPECT_EQ(triangles_of(file), more);
}

TEST_F(StlOnDisk, KeepsTheTrianglesOfADeletedFile) {
    write(binary(many));
    const TriangleSoup mesh = *read_mesh(path()).mesh().soup();
    std::filesystem::remove(path());
    EXPECT_EQ(mesh.stored(23), many[23]);
}

TEST_F(StlOnDisk, CountsInSixtyFourBitsBeyondFourGigabytes) {
    // Two triangles and a hole of five gigabytes behind them, of which nothing is read.
    write(binary(two));
    constexpr std::uint64_t size = std::uint64_t{5} << 30;
    std::error_code failed;
    std::filesystem::resize_file(path(), size, failed);
    if (failed)
        GTEST_SKIP() << "no sparse files here";
    const MeshFile file = read_mesh(path());
    EXPECT_EQ(triangles_of(file), two);
    ASSERT_EQ(file.warnings.size(), 1U);
    EXPECT_EQ(
        file.warnings[0],
        fmt::format("byte 184: left out {} bytes that follow the 2 triangles of the count", size - 184));
}

TEST(Stl, ReportsProgressInBytesUpToTheEnd) {
    for (const std::string& bytes : {binary(some_triangles(100'000)), solid(some_triangles(30'000))})
        for (const unsigned threads : {1U, 2U, 7U}) {
            std::vector<Progress> reports;
            Execution execution{.threads = threads};
            execution.progress = [&](const Progress& progress) {
                reports.push_back(progress);
            };
            (void)read_mesh(std::as_bytes(std::span(bytes)), "part.stl", {}, execution);
            ASSERT_GE(reports.size(), 3U);
            EXPECT_EQ(reports.front().done, 0U);
            EXPECT_EQ(reports.back().done, bytes.size());
            for (std::size_t i = 0; i < reports.size(); ++i) {
                EXPECT_EQ(reports[i].stage, Stage::read);
                EXPECT_EQ(reports[i].total, bytes.size());
                EXPECT_LE(reports[i == 0 ? 0 : i - 1].done, reports[i].done);
            }
        }
}

TEST(Stl, StopsWhenAsked) {
    for (const std::string& bytes : {binary(many), solid(many)}) {
        CancelFlag stop;
        stop.request();
        test::error_of(ErrorKind::cancelled, [&] {
            (void)read_mesh(std::as_bytes(std::span(bytes)), "part.stl", {}, {.cancel = &stop});
        });
    }
}

TEST(Stl, InBigEndianOrderIsNamedAsSuch) {
    std::string bytes = binary(some_triangles(12));
    const auto reverse = [&](std::size_t at, std::size_t size) {
        std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                     bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
    };
    reverse(80, 4);
    for (std::size_t record = 84; record < bytes.size(); record += 50)
        for (std::size_t k = 0; k < 12; ++k)
            reverse(record + 4 * k, 4);
    EXPECT_NE(
        error_of(bytes).find("part.stl: is a binary STL file in big-endian byte order: its count reads 12"),
        std::string::npos)
        << error_of(bytes);
    // With a count that fits by chance, its numbers show it.
    reverse(80, 4);
    EXPECT_NE(error_of(bytes).find("below 1e-20 or above 1e20"), std::string::npos) << error_of(bytes);
}

TEST(Stl, WithNothingButZerosAtItsEndIsIncomplete) {
    const std::string whole = binary(some_triangles(12));
    for (const std::size_t kept : {0U, 1U, 7U, 11U}) {
        std::string bytes = whole;
        std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(84 + 50 * kept), bytes.end(), '\0');
        if (kept == 0) {
            EXPECT_NE(error_of(bytes).find("holds nothing but zeros from byte 84 on"), std::string::npos);
            continue;
        }
        const MeshFile file = read(bytes);
        EXPECT_EQ(file.stored_triangles, 12U);
        ASSERT_EQ(file.warnings.size(), 1U);
        EXPECT_EQ(
            file.warnings[0],
            fmt::format("the last {} of 12 triangles are nothing but zeros from byte {} on: the file was not "
                        "written or transferred completely; get it again",
                        12 - kept, 84 + 50 * kept));
        error_of(bytes, {.strict = true}, ErrorKind::defect);
    }
    EXPECT_NE(error_of(std::string(1000, '\0')).find("holds nothing but zeros"), std::string::npos);
}

} // namespace
} // namespace lamella::stl_test::stl_cases
