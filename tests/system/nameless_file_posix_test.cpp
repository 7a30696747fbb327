#include "system/nameless_file.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdlib>
#include <string>

namespace lamella::nameless_file_posix_cases {
namespace {

TEST(NamelessFile, OfScratchIsForThisUserOnlyAndHasNoName) {
    const TemporaryFolder folder;
    const NativeFile file = create_scratch(folder.path().string());
    EXPECT_TRUE(folder.entries().empty());
    EXPECT_TRUE(create_nameless(folder.path().string()).is_open() || errno == EOPNOTSUPP);
    EXPECT_TRUE(folder.entries().empty());
    struct stat status {};
    ASSERT_EQ(::fstat(static_cast<int>(file.handle()), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST(NamelessFile, IsOnADiskWhereTheEnvironmentWantsNothing) {
    const char* const before = std::getenv("TMPDIR");
    const std::string kept = before == nullptr ? "" : before;
    ::setenv("TMPDIR", "", 1);
    EXPECT_TRUE(scratch_folder() == "/var/tmp" || scratch_folder() == "/tmp");
    if (before == nullptr)
        ::unsetenv("TMPDIR");
    else
        ::setenv("TMPDIR", kept.c_str(), 1);
}

} // namespace
} // namespace lamella::nameless_file_posix_cases
