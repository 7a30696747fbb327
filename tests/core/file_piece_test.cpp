#include "lamella/core/error.hpp"

#include "core/file_piece.hpp"
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
    try {
        FilePiece(folder.file("nowhere"), 0);
        FAIL() << "it was made";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::output);
        EXPECT_NE(std::string(error.what()).find(folder.file("nowhere")), std::string::npos);
    }
}

} // namespace
} // namespace lamella
