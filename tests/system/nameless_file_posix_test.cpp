#include "fixtures/environment.hpp"
#include "system/nameless_file.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>

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
    const test::EnvironmentVariable variable("TMPDIR", "", scratch_folder());
    EXPECT_TRUE(scratch_folder() == "/var/tmp" || scratch_folder() == "/tmp");
}

} // namespace
} // namespace lamella::nameless_file_posix_cases
