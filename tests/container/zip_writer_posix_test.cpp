#include "lamella/core/error.hpp"

#include "container/deflate.hpp"
#include "container/inflate.hpp"
#include "container/zip_samples.hpp"
#include "container/zip_writer.hpp"
#include "fixtures/skip_if_slowed.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

namespace lamella::zip_writer_posix_cases {
namespace {

using zip_test::python;
using zip_test::write_sample;

// Checks every CRC, then prints name, size and method of each entry.
const std::string list = R"(
import sys, zipfile
z = zipfile.ZipFile(sys.argv[1])
print(z.testzip())
for i in z.infolist():
    print(i.filename, i.file_size, i.compress_type, i.date_time, i.extract_version)
)";

std::string described(const std::string& path) {
    return python(list, path);
}

std::string line(const std::string& name, std::uint64_t size, int method, int version = 20) {
    return name + ' ' + std::to_string(size) + ' ' + std::to_string(method) + " (1980, 1, 1, 0, 0, 0) " +
           std::to_string(version) + '\n';
}

TEST(ZipWriter, IsReadByAnotherProgram) {
    const TemporaryFolder folder;
    write_sample(folder.file("a.zip"));
    EXPECT_EQ(described(folder.file("a.zip")), "None\n" + line("plain", 7, 0) + line("folder/empty", 0, 0) +
                                                   line("d\xc3\xa9j\xc3\xa0", 10'000, 8) +
                                                   line("none", 0, 8) + line("stream", 45'000, 8) +
                                                   line("stored stream", 13, 0) + line("empty stream", 0, 8));
    EXPECT_EQ(
        python("import sys, zipfile; z = zipfile.ZipFile(sys.argv[1]); print(z.read(\"stored stream\"), "
               "z.read(\"stream\")[-9001:-8999])",
               folder.file("a.zip")),
        "b'in two pieces' b'ij'\n");
}

TEST(ZipWriter, TheHeaderOfAnEntryMayBeKnownAtItsEnd) {
    const TemporaryFolder folder;
    ZipWriter zip(folder.file("a.zip"), Overwriting::yes);
    zip.begin("headed", ZipMethod::stored, 4);
    zip.append_stored(" and content");
    zip.end("head");
    zip.add("after", "");
    zip.finish();
    EXPECT_EQ(described(folder.file("a.zip")), "None\n" + line("headed", 16, 0) + line("after", 0, 0));
    EXPECT_EQ(file_bytes(folder.file("a.zip")).substr(56, 16), "head and content");
}

TEST(ZipWriter, StoredEntriesCanBeReadFromFrontToBack) {
    const TemporaryFolder folder;
    ZipWriter zip(folder.file("a.zip"), Overwriting::yes);
    for (const std::string name : {"one", "two"}) {
        zip.begin(name, ZipMethod::stored);
        zip.append_stored("the content of ");
        zip.append_stored(name);
        zip.end();
    }
    zip.finish();
    EXPECT_EQ(python(R"(
import struct, sys
file = open(sys.argv[1], "rb")
while file.read(4) == b"PK\3\4":
    version, flags, method, time, date, crc, packed, size, name, extra = struct.unpack("<5H3I2H", file.read(26))
    print(file.read(name), version, flags, len(file.read(extra)), file.read(packed))
)",
                     folder.file("a.zip")),
              "b'one' 20 0 20 b'the content of one'\nb'two' 20 0 20 b'the content of two'\n");
}

TEST(ZipWriter, AnEmptyArchiveIsOne) {
    const TemporaryFolder folder;
    ZipWriter zip(folder.file("a.zip"));
    zip.finish();
    EXPECT_EQ(zip.bytes(), 22U);
    EXPECT_EQ(described(folder.file("a.zip")), "None\n");
}

TEST(ZipWriter, CountsMoreEntriesThanTheOldDirectoryCan) {
    const TemporaryFolder folder;
    ZipWriter zip(folder.file("a.zip"));
    for (int i = 0; i < 70'000; ++i)
        zip.add(std::to_string(i), "");
    zip.finish();
    EXPECT_EQ(python("import sys, zipfile; print(len(zipfile.ZipFile(sys.argv[1]).infolist()))",
                     folder.file("a.zip")),
              "70000\n");
}

// A piece that stands for more than it is: five times 1 GiB of zeros, one megabyte each.
TEST(ZipWriter, EntriesBeyond4GiBAreWrittenInTheLargeForm) {
    LAMELLA_SKIP_IF_SLOWED();
    const TemporaryFolder folder;
    const std::string zeros(std::size_t{1} << 26, '\0');
    std::string stream;
    Deflater().append_chunk(zeros, stream);
    const ZipChunk chunk{stream, zeros.size(), crc32_of(zeros)};
    ZipWriter zip(folder.file("a.zip"));
    zip.begin("zeros", ZipMethod::deflated);
    for (int i = 0; i < 65; ++i)
        zip.append(chunk);
    zip.end();
    zip.add("after", "content");
    zip.finish();
    EXPECT_EQ(python("import sys, zipfile; z = zipfile.ZipFile(sys.argv[1]); "
                     "print([i.file_size for i in z.infolist()], z.read(\"after\"))",
                     folder.file("a.zip")),
              "[4362076160, 7] b'content'\n");
}

TEST(ZipWriter, EqualContentsGiveEqualBytesAlsoThroughAPipe) {
    const TemporaryFolder folder;
    write_sample(folder.file("a.zip"));
    ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
    std::string piped;
    std::thread reader([&] { piped = file_bytes(folder.file("pipe")); });
    write_sample(folder.file("pipe"));
    reader.join();
    EXPECT_EQ(piped, file_bytes(folder.file("a.zip")));
}

// Bytes that pass through a pipe and lie in a file with holes.
TEST(ZipWriter, ArchivesBeyond4GiBAreWrittenInTheLargeForm) {
    LAMELLA_SKIP_IF_SLOWED();
    const TemporaryFolder folder;
    ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
    std::thread reader([&] {
        std::FILE* const in = std::fopen(folder.file("pipe").c_str(), "rb");
        std::FILE* const out = std::fopen(folder.file("a.zip").c_str(), "wb");
        ASSERT_TRUE(in != nullptr && out != nullptr);
        std::string part(std::size_t{1} << 16, '\0');
        const std::string hole = part;
        while (const std::size_t size = std::fread(part.data(), 1, part.size(), in)) {
            if (part == hole)
                ASSERT_EQ(std::fseek(out, static_cast<long>(size), SEEK_CUR), 0);
            else
                ASSERT_EQ(std::fwrite(part.data(), 1, size, out), size);
        }
        std::fclose(out);
        std::fclose(in);
    });
    const std::string zeros(std::size_t{1} << 26, '\0');
    const ZipChunk chunk{zeros, zeros.size(), crc32_of(zeros)};
    {
        ZipWriter zip(folder.file("pipe"));
        zip.begin("zeros", ZipMethod::deflated); // as if they were: nobody unpacks it
        for (int i = 0; i < 65; ++i)
            zip.append(chunk);
        zip.end();
        zip.add("after", "content");
        zip.finish();
    }
    reader.join();
    EXPECT_EQ(
        python("import sys, zipfile; z = zipfile.ZipFile(sys.argv[1]); "
               "print([(i.file_size, i.header_offset > 1 << 32) for i in z.infolist()], z.read(\"after\"))",
               folder.file("a.zip")),
        "[(4362076160, False), (7, True)] b'content'\n");
    struct stat status {};
    ASSERT_EQ(stat(folder.file("a.zip").c_str(), &status), 0);
    EXPECT_LT(status.st_blocks * 512, 1 << 26);
}

} // namespace
} // namespace lamella::zip_writer_posix_cases
