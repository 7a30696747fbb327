#include "lamella/container/file_hash.hpp"
#include "lamella/core/error.hpp"

#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lamella {
namespace {

TEST(FileHash, IsThatOfTheBytesAlone) {
    const TemporaryFolder folder;
    // More than is hashed at once; not a multiple of anything.
    const std::string bytes(8'000'001, 'x');
    write_file(folder.file("a"), bytes);
    write_file(folder.file("b"), bytes);
    EXPECT_EQ(file_hash(folder.file("a")), file_hash(folder.file("b")));
    for (const std::size_t position : {std::size_t{0}, std::size_t{1} << 22, bytes.size() - 1}) {
        std::string other = bytes;
        other[position] = 'y';
        write_file(folder.file("c"), other);
        EXPECT_NE(file_hash(folder.file("a")), file_hash(folder.file("c"))) << position;
    }
    write_file(folder.file("c"), bytes + "x");
    EXPECT_NE(file_hash(folder.file("a")), file_hash(folder.file("c")));
}

TEST(FileHash, IsTheSameOnEveryMachine) {
    const TemporaryFolder folder;
    write_file(folder.file("a"), "Lamella");
    EXPECT_EQ(file_hash(folder.file("a")), 0x21d353e806bd57aaU); // as xxhsum -H3 has it
}

TEST(FileHash, NamesAFileThatIsNotThere) {
    EXPECT_THROW(static_cast<void>(file_hash("/nowhere/at/all")), Error);
}

} // namespace
} // namespace lamella
