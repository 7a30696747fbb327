#include "output_checks.hpp"
#include "system/atomic_directory.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace lamella {
namespace {

namespace fs = std::filesystem;
using test::is_layer;
using test::Names;

TEST(AtomicDirectory, AppearsWholeAtTheEnd) {
    const TemporaryFolder folder;
    for (const char* name : {"out", "slashed/"}) {
        AtomicDirectory directory(folder.file(name), is_layer);
        directory.write("a.svg", "a");
        EXPECT_FALSE(fs::exists(folder.file(name)));
        directory.commit();
        EXPECT_EQ(file_bytes(fs::path(folder.file(name)) / "a.svg"), "a");
    }
    EXPECT_EQ(folder.entries(), (Names{"out", "slashed"}));
}

TEST(AtomicDirectory, LeavesNothingBehindWhenItIsNotEnded) {
    const TemporaryFolder folder;
    {
        AtomicDirectory directory(folder.file("out"), is_layer);
        directory.write("a.svg", "a");
    }
    EXPECT_EQ(folder.entries(), Names{});
}

TEST(AtomicDirectory, ReplacesAnEmptyFolderAndOneOfItsOwn) {
    const TemporaryFolder folder;
    fs::create_directory(folder.path() / "out");
    for (const char* name : {"first.svg", "second.svg"}) {
        AtomicDirectory directory(folder.file("out"), is_layer);
        directory.write(name, "x");
        directory.commit();
        EXPECT_EQ(std::distance(fs::directory_iterator(folder.path() / "out"), {}), 1);
        EXPECT_TRUE(fs::exists(folder.path() / "out" / name));
    }
    EXPECT_EQ(folder.entries(), Names{"out"});
}

TEST(AtomicDirectory, RefusesAFolderWithSomethingElseInIt) {
    const TemporaryFolder folder;
    fs::create_directory(folder.path() / "out");
    write_file(folder.path() / "out" / "thesis.txt", "years of work");
    EXPECT_NE(test::error_of_folder(folder.file("out")).find("thesis.txt"), std::string::npos);
    EXPECT_EQ(file_bytes(folder.path() / "out" / "thesis.txt"), "years of work");
}

TEST(AtomicDirectory, TakesWhatVanishesMeanwhileForNothing) {
    const TemporaryFolder folder;
    fs::create_directory(folder.path() / "out");
    for (int i = 0; i < 3; ++i)
        write_file(folder.path() / "out" / std::to_string(i), "a");
    AtomicDirectory directory(folder.file("out"), [](const fs::path& entry) {
        fs::remove(entry);
        return false;
    });
    directory.commit();
    EXPECT_EQ(folder.entries(), Names{"out"});
}

TEST(AtomicDirectory, LooksAgainBeforeItReplaces) {
    const TemporaryFolder folder;
    {
        AtomicDirectory directory(folder.file("out"), is_layer);
        fs::create_directory(folder.path() / "out");
        write_file(folder.path() / "out" / "thesis.txt", "put there meanwhile");
        EXPECT_THROW(directory.commit(), Error);
    }
    EXPECT_EQ(file_bytes(folder.path() / "out" / "thesis.txt"), "put there meanwhile");
    EXPECT_EQ(folder.entries(), Names{"out"});
}

TEST(AtomicDirectory, SaysWhatIsWrongWithThePlace) {
    const TemporaryFolder folder;
    write_file(folder.file("file"), "x");
    EXPECT_NE(test::error_of_folder(folder.file("file")).find("it is a file"), std::string::npos);
    EXPECT_NE(test::error_of_folder(folder.file("file/out")).find("is a file, not a folder"),
              std::string::npos);
    EXPECT_NE(test::error_of_folder(folder.file("no/out")).find("does not exist"), std::string::npos);
    EXPECT_NE(test::error_of_folder("").find("without a name"), std::string::npos);
}

} // namespace
} // namespace lamella
