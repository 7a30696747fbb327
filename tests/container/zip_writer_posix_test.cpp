#include "lamella/core/error.hpp"

#include "container/deflate.hpp"
#include "container/inflate.hpp"
#include "container/zip_samples.hpp"
#include "container/zip_writer.hpp"
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
