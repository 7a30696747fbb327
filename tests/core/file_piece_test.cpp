#include "core/file_piece.hpp"
#include "fixtures/expect_error.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

namespace lamella {
namespace {

TEST(FilePiece, IsWrittenAtItsPlaceWhateverOrderOthersAreWrittenIn) {
    const TemporaryFolder folder;
    const std::string path = folder.file("whole");
    std::ofstream(path, std::ios::binary) << "";
    FilePiece later(path, 5);
    later.append("56");
    FilePiece first(path, 0);
    first.append("01");
    later.append("");
    later.append("78");
    first.append("234");
    later.finish();
    first.finish();
    std::ifstream file(path, std::ios::binary);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "012345678");
}

TEST(FilePiece, OfAFileThatIsNotThereIsRefused) {
    const TemporaryFolder folder;
    const std::string path = folder.file("nowhere");
    test::expect_error(ErrorKind::output, {path.c_str()}, [&] { FilePiece(path, 0); });
}

} // namespace
} // namespace lamella
