#include "system/nameless_file.hpp"
#include "system/scratch_folder.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace lamella::nameless_file_cases {
namespace {

TEST(NamelessFile, HasNoNameUntilItGetsOne) {
    const TemporaryFolder folder;
    NativeFile file = create_nameless(folder.path().string());
    if (!file.is_open() && errno == EOPNOTSUPP)
        GTEST_SKIP() << "this file system has no files without a name";
    ASSERT_TRUE(file.is_open());
    EXPECT_TRUE(write_all(file, "bytes"));
    EXPECT_LE(folder.entries().size(), 1U) << "a hidden name, where there has to be one";
    write_file(folder.file("taken"), "old");
    EXPECT_FALSE(name_file(file, folder.file("taken").c_str()));
    EXPECT_EQ(errno, EEXIST);
    EXPECT_TRUE(name_file(file, folder.file("new").c_str()));
    file.close();
    EXPECT_EQ(file_bytes(folder.file("new")), "bytes");
    EXPECT_EQ(file_bytes(folder.file("taken")), "old");
}

TEST(NamelessFile, OfScratchLeavesNothing) {
    const TemporaryFolder folder;
    NativeFile file = create_scratch(folder.path().string());
    ASSERT_TRUE(file.is_open());
    EXPECT_LE(folder.entries().size(), 1U) << "a hidden name, where there has to be one";
    EXPECT_TRUE(write_all(file, "bytes"));
    std::array<std::byte, 6> read{};
    EXPECT_EQ(read_at(file, 0, read), 5);
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(read.data()), 5), "bytes");
    file.close();
    EXPECT_TRUE(folder.entries().empty());
    EXPECT_FALSE(create_scratch(folder.file("absent")).is_open());
    EXPECT_EQ(errno, ENOENT);
}

TEST(NamelessFile, TakesTheFirstFreeHiddenName) {
    const TemporaryFolder folder;
    const std::string target = folder.file("part.cli");
    std::vector<std::string> tried;
    const auto take_third = [&](const char* name) {
        tried.emplace_back(name);
        errno = tried.size() == 1 ? EEXIST : EINTR;
        return tried.size() == 3;
    };
    const std::string name = take_free_name(target, "me", take_third);
    EXPECT_EQ(tried,
              (std::vector<std::string>{folder.file(".part.cli.me-0.tmp"), folder.file(".part.cli.me-1.tmp"),
                                        folder.file(".part.cli.me-1.tmp")}));
    EXPECT_EQ(name, tried.back());
    const auto refuse = [](const char*) {
        errno = EACCES;
        return false;
    };
    EXPECT_EQ(take_free_name(target, "me", refuse), "");
    const std::string longest(255, 'x');
    EXPECT_LE(take_free_name(folder.file(longest), this_process(), [](const char*) { return true; }).size(),
              folder.file("").size() + 255);
}

TEST(NamelessFile, IsWhereTheEnvironmentWants) {
    const TemporaryFolder folder;
    {
        const test::ScratchFolder wanted(folder.path().string());
        EXPECT_EQ(scratch_folder(), folder.path().string());
    }
    EXPECT_NE(scratch_folder(), folder.path().string());
    EXPECT_TRUE(std::filesystem::is_directory(scratch_folder()));
}

} // namespace
} // namespace lamella::nameless_file_cases
