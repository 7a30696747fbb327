#include "lamella/system/whole_file.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/rounds.hpp"
#include "system/atomic_file.hpp"
#include "system/file_chunk.hpp"
#include "system/nameless_file.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace lamella {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

std::string output_error_of(const std::function<void()>& action) {
    return test::error_of(ErrorKind::output, action);
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(AtomicFile, GetsItsNameOnlyWhenItIsComplete) {
    const TemporaryFolder folder;
    {
        AtomicFile file(folder.file("a.cli"));
        file.append("first ");
        file.append("second");
        EXPECT_FALSE(fs::exists(folder.file("a.cli")));
        EXPECT_EQ(file.bytes(), 12U);
        file.commit();
    }
    EXPECT_EQ(file_bytes(folder.file("a.cli")), "first second");
    EXPECT_EQ(folder.entries(), Names{"a.cli"});
}

TEST(AtomicFile, LeavesNothingBehindWhenItIsNotEnded) {
    const TemporaryFolder folder;
    {
        AtomicFile file(folder.file("a.cli"));
        file.append(std::string(3'000'000, 'x'));
        EXPECT_LE(folder.entries().size(), 1U); // a temporary name, where there has to be one
    }
    EXPECT_EQ(folder.entries(), Names{});
    {
        AtomicFile file(folder.file("a.cli"));
        file.append(std::string(3'000'000, 'x'));
        const std::string shared = file.share();
        ASSERT_EQ(folder.entries().size(), 1U);
        EXPECT_EQ(shared, folder.file(folder.entries().front()));
    }
    EXPECT_EQ(folder.entries(), Names{});
}

TEST(AtomicFile, TakesBytesFromOthersOnceItIsShared) {
    const TemporaryFolder folder;
    AtomicFile file(folder.file("a.cli"));
    FileChunk chunk(file.share(), 0, "a.cli");
    chunk.append("theirs");
    chunk.finish();
    EXPECT_EQ(file.share(), folder.file(folder.entries().at(0)));
    file.commit();
    EXPECT_EQ(file_bytes(folder.file("a.cli")), "theirs");
    EXPECT_EQ(folder.entries(), Names{"a.cli"});
}

TEST(AtomicFile, KeepsTheOldFileWhenTheNewOneIsNotEnded) {
    const TemporaryFolder folder;
    write_file(folder.file("a.cli"), "old");
    {
        AtomicFile file(folder.file("a.cli"));
        file.append("new");
    }
    EXPECT_EQ(file_bytes(folder.file("a.cli")), "old");
    EXPECT_EQ(folder.entries(), Names{"a.cli"});
}

void write_and_overwrite(const std::string& path) {
    AtomicFile file(path, Overwriting::yes);
    file.append("0123456789");
    file.append(std::string(1'000'000, 'x'));
    file.overwrite(2, "ab");
    file.append("end");
    file.overwrite(1'000'009, "yz");
    EXPECT_EQ(file.bytes(), 1'000'013U);
    file.commit();
}

TEST(AtomicFile, PutsOtherBytesInThePlaceOfSome) {
    const TemporaryFolder folder;
    write_and_overwrite(folder.file("a"));
    const std::string bytes = file_bytes(folder.file("a"));
    EXPECT_EQ(bytes, "01ab456789" + std::string(999'999, 'x') + "yznd");
    EXPECT_EQ(folder.entries(), Names{"a"});
}

TEST(AtomicFile, KeepsTheOrderOfPiecesOfAllSizes) {
    const TemporaryFolder folder;
    std::string expected;
    AtomicFile file(folder.file("a"));
    for (const std::size_t size : {1U, 262'143U, 1U, 0U, 262'144U, 7U, 262'145U, 1'000'000U, 3U}) {
        const std::string chunk(size, static_cast<char>('a' + expected.size() % 26));
        expected += chunk;
        file.append(chunk);
    }
    EXPECT_EQ(file.bytes(), expected.size());
    file.commit();
    EXPECT_TRUE(file_bytes(folder.file("a")) == expected);
}

TEST(AtomicFile, SaysWhatIsWrongWithThePlace) {
    const TemporaryFolder folder;
    const auto error = [](const std::string& path) {
        return output_error_of([&] { AtomicFile file(path); });
    };

    EXPECT_TRUE(contains(error(folder.path().string()), "it is a folder"));
    EXPECT_TRUE(contains(error(folder.path().string() + "/"), "it is a folder"));
    EXPECT_TRUE(contains(error(""), "without a name"));

    const std::string missing = error(folder.file("no/such/a.cli"));
    EXPECT_TRUE(contains(missing, "'" + folder.file("no/such/a.cli") + "'")) << missing;
    EXPECT_TRUE(contains(missing, "'" + folder.file("no") + "' does not exist")) << missing;

    write_file(folder.file("file"), "");
    const std::string below_file = error(folder.file("file/a.cli"));
    EXPECT_TRUE(contains(below_file, "'" + folder.file("file") + "' is a file")) << below_file;

    EXPECT_TRUE(contains(error(folder.file(std::string(300, 'n'))), "name is too long"));
}

TEST(AtomicFile, CanBeAskedForAPlaceThatItLeavesAlone) {
    const TemporaryFolder folder;
    write_file(folder.file("old"), "old");
    check_writable(folder.file("old"));
    check_writable(folder.file("new"));
    check_writable("-");
    EXPECT_TRUE(contains(output_error_of([&] { check_writable(folder.file("no/a")); }), "does not exist"));
    EXPECT_TRUE(contains(output_error_of([&] { check_writable(folder.path().string()); }), "it is a folder"));
    EXPECT_EQ(folder.entries(), Names{"old"});
    EXPECT_EQ(file_bytes(folder.file("old")), "old");
}

TEST(AtomicFile, TakesNamesAsLongAsTheFileSystemDoes) {
    const TemporaryFolder folder;
    const std::string name(255, 'n');
    write_whole_file(folder.file(name), "x");
    EXPECT_EQ(folder.entries(), Names{name});
}

TEST(AtomicFile, LetsTwoWritersOfOneNameFinishOneAfterTheOther) {
    const TemporaryFolder folder;
    AtomicFile first(folder.file("a"));
    AtomicFile second(folder.file("a"));
    first.append("first");
    second.append("second");
    second.commit();
    first.commit();
    EXPECT_EQ(file_bytes(folder.file("a")), "first");
    EXPECT_EQ(folder.entries(), Names{"a"});
}

} // namespace
} // namespace lamella
