#include "fixtures/expect_error.hpp"
#include "system/scratch_folder.hpp"
#include "system/spill_file.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <span>
#include <string>

namespace lamella {
namespace {

std::span<const std::byte> bytes(const std::string& text) {
    return std::as_bytes(std::span(text));
}

std::string read(const SpillFile& file, std::uint64_t position, std::size_t size) {
    std::string text(size, '\0');
    file.read(position, std::as_writable_bytes(std::span(text)));
    return text;
}

TEST(SpillFile, GivesBackWhatWasWrittenAnywhere) {
    const TemporaryFolder folder;
    const test::ScratchFolder spill(folder.path().string());
    for (const std::uint64_t size : {0, 1'000'000}) {
        SpillFile file(size);
        file.write(999'995, bytes("right"));
        file.write(0, bytes("left"));
        EXPECT_EQ(read(file, 0, 4), "left");
        EXPECT_EQ(read(file, 999'995, 5), "right");
        file.forget(0, 8192);
        EXPECT_EQ(read(file, 999'995, 5), "right");
    }
}

TEST(SpillFile, NamesAFolderThatIsNotThere) {
    const TemporaryFolder folder;
    const test::ScratchFolder spill(folder.file("nowhere"));
    const std::string text = test::error_of(ErrorKind::output, [] { const SpillFile file(4096); });
    EXPECT_TRUE(text.starts_with(folder.file("nowhere") + ": ")) << text;
}

TEST(SpillFile, SaysBeforeTheWorkThatThereIsNoRoom) {
    const TemporaryFolder folder;
    const test::ScratchFolder spill(folder.path().string());
    const std::string position = folder.path().string() + ": ";
    // More than any disk has.
    test::expect_error(
        ErrorKind::output,
        {position.c_str(), "36028797.0 GB", "the disk has ", " free", scratch_variable().data()},
        [] { const SpillFile file(std::uint64_t{1} << 55); });
}

} // namespace
} // namespace lamella
