#include "container/zip_reader.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace lamella::zip_reader_posix_cases {
namespace {

TEST(ZipReader, ReadsWhatPythonWrites) {
    const TemporaryFolder folder;
    const std::string path = (folder.path() / "x.zip").string();
    const std::string program = "import sys, zipfile\n"
                                "text = bytes(range(256)) * 4000\n"
                                "class Pipe:\n"
                                "    def __init__(self, file): self.file = file\n"
                                "    def write(self, b): return self.file.write(b)\n"
                                "    def flush(self): self.file.flush()\n"
                                "z = zipfile.ZipFile(Pipe(open(sys.argv[1], \"wb\")), \"w\")\n"
                                "z.writestr(\"folder/\", \"\")\n"
                                "for m in (0, 8):\n"
                                "    z.writestr(zipfile.ZipInfo(f\"method {m}\"), text, m)\n"
                                "with z.open(\"large\", \"w\", force_zip64=True) as f: f.write(text)\n"
                                "z.comment = b\"a comment\"\n"
                                "z.close()\n";
    ASSERT_EQ(std::system(fmt::format("python3 -c '{}' '{}'", program, path).c_str()), 0);
    const ZipReader zip(open_bytes(path), 0);
    EXPECT_EQ(zip.entries().size(), 3U) << "folders are none";
    std::string text;
    for (int i = 0; i < 4000 * 256; ++i)
        text += static_cast<char>(i);
    for (const char* name : {"method 0", "method 8", "large"}) {
        const ByteSource content = zip.read(*zip.find(name));
        EXPECT_EQ(std::string(reinterpret_cast<const char*>(content.bytes.data()), content.bytes.size()),
                  text)
            << name;
    }
    EXPECT_TRUE(zip.counted_warnings().empty());
}

} // namespace
} // namespace lamella::zip_reader_posix_cases
