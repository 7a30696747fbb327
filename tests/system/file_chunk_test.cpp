#include "fixtures/expect_error.hpp"
#include "system/file_chunk.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

namespace lamella {
namespace {

TEST(FileChunk, IsWrittenAtItsPlaceWhateverOrderOthersAreWrittenIn) {
    const TemporaryFolder folder;
    const std::string path = folder.file("whole");
    std::ofstream(path, std::ios::binary) << "";
    FileChunk later(path, 5, "part");
    later.append("56");
    FileChunk first(path, 0, "part");
    first.append("01");
    later.append("");
    later.append("78");
    first.append("234");
    later.finish();
    first.finish();
    std::ifstream file(path, std::ios::binary);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "012345678");
}

TEST(FileChunk, OfAFileThatIsNotThereIsRefused) {
    const TemporaryFolder folder;
    const std::string path = folder.file("nowhere");
    test::expect_error(ErrorKind::output, {"part.cli"}, [&] { FileChunk(path, 0, "part.cli"); });
}

} // namespace
} // namespace lamella
