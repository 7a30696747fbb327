#include "lamella/system/whole_file.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/rounds.hpp"
#include "output_checks.hpp"
#include "system/atomic_file.hpp"
#include "system/file_chunk.hpp"
#include "system/nameless_file.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace lamella {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::Names;
using test::output_error_of;

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

TEST(AtomicFile, WritesToMemoryWithoutAFile) {
    const TemporaryFolder folder;
    std::string memory = "before";
    const std::string large(3'000'000, 'x');
    AtomicFile file(folder.file("missing/a.cli"), Overwriting::yes, &memory);
    file.append("first ");
    file.append(large);
    const auto owner = std::make_shared<const std::string>(large);
    Completions after;
    file.append(*owner, owner, after);
    file.append("last");
    for (const auto& completion : after)
        completion();
    file.overwrite(0, "FIRST");
    EXPECT_EQ(file.bytes(), 10 + 2 * large.size());
    file.commit();
    EXPECT_TRUE(memory == "FIRST " + large + large + "last");
    EXPECT_THROW(file.append("more"), Error);
    EXPECT_EQ(folder.entries(), Names{});
}

TEST(AtomicFile, NamesTheErrorOfTheSystem) {
    const TemporaryFolder folder;
    try {
        const AtomicFile file(folder.file("missing/a.cli"));
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.system_error(), ENOENT) << error.what();
    }
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

/// Appends pieces of many sizes, with owners and without, and returns all bytes.
std::string append_pieces(AtomicFile& file, Completions& after) {
    std::string expected;
    for (int round = 0; round < 3; ++round)
        for (const std::size_t size : {1U, 4'095U, 4'096U, 262'143U, 7U, 262'144U, 900'000U, 0U, 20'000U}) {
            const auto piece =
                std::make_shared<const std::string>(size, static_cast<char>('a' + expected.size() % 26));
            expected += *piece;
            if (round == 1 && size % 2 == 0)
                file.append(*piece);
            else
                file.append(*piece, piece, after);
        }
    EXPECT_EQ(file.bytes(), expected.size());
    return expected;
}

TEST(AtomicFile, TakesBytesFromCompletionsInAnyOrder) {
    const TemporaryFolder folder;
    AtomicFile file(folder.file("a"));
    Completions after;
    const std::string expected = append_pieces(file, after);
    std::reverse(after.begin(), after.end());
    for (const auto& completion : after)
        completion();
    file.append("end");
    file.commit();
    EXPECT_TRUE(file_bytes(folder.file("a")) == expected + "end");
}

TEST(AtomicFile, TakesBytesFromCompletionsOnManyThreads) {
    const TemporaryFolder folder;
    AtomicFile file(folder.file("a"), Overwriting::yes);
    Completions after;
    const std::string expected = append_pieces(file, after);
    std::atomic<std::size_t> next{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            for (std::size_t i = 0; (i = next++) < after.size();)
                after[i]();
        });
    for (std::thread& thread : threads)
        thread.join();
    file.overwrite(0, "first");
    file.append("end");
    file.commit();
    EXPECT_TRUE(file_bytes(folder.file("a")) == "first" + expected.substr(5) + "end");
}

TEST(AtomicFile, IsNotEndedWhileBytesAreMissing) {
    const TemporaryFolder folder;
    for (const std::size_t size : {5'000U, 3'000'000U}) {
        AtomicFile file(folder.file("a"));
        Completions after;
        const auto piece = std::make_shared<const std::string>(size, 'x');
        file.append(*piece, piece, after);
        EXPECT_EQ(after.size(), 1U);
        test::error_of(ErrorKind::internal, [&] { file.commit(); });
    }
    EXPECT_EQ(folder.entries(), Names{});
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
