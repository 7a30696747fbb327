#include "fixtures/child_process.hpp"
#include "output_checks.hpp"
#include "system/atomic_directory.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace lamella::atomic_directory_posix_cases {
namespace {

namespace fs = std::filesystem;
using test::is_layer;
using test::Names;

TEST(AtomicDirectory, IsRemovedFromOutsideWhenTheProcessHasToEndAtOnce) {
    const TemporaryFolder folder;
    const int code = exit_code_of_child([&] {
        AtomicDirectory done(folder.file("done"), is_layer);
        done.commit();
        AtomicDirectory directory(folder.file("out"), is_layer);
        for (int i = 0; i < 1000; ++i) // more than one reading of a folder gives
            directory.write(std::to_string(i) + ".svg", "a");
        remove_unfinished();
        try {
            directory.commit();
        } catch (const Error& error) {
            _exit(error.kind() == ErrorKind::cancelled ? 0 : 1); // before any destructor
        }
        _exit(2);
    });
    EXPECT_EQ(code, 0);
    EXPECT_EQ(folder.entries(), Names{"done"});
}

TEST(AtomicDirectory, RemovesWhatAProcessThatIsDeadLeftForTheSameName) {
    const TemporaryFolder folder;
    const int code = exit_code_of_child([&] {
        AtomicDirectory left(folder.file("out"), is_layer);
        left.write("a.svg", "a");
        const AtomicDirectory another(folder.file("another"), is_layer);
        _exit(0); // before any destructor
    });
    ASSERT_EQ(code, 0);
    ASSERT_EQ(folder.entries().size(), 2U);
    {
        const AtomicDirectory directory(folder.file("out"), is_layer);
        EXPECT_EQ(folder.entries().size(), 2U) << "its own, and that of another name";
        EXPECT_TRUE(fs::is_empty(folder.path() / folder.entries().back()));
    }
    EXPECT_EQ(folder.entries().size(), 1U);
    EXPECT_TRUE(folder.entries().front().starts_with(".another."));
}

TEST(AtomicDirectory, LeavesAFolderAloneInWhichSomebodyPutSomethingElse) {
    const TemporaryFolder folder;
    const int code = exit_code_of_child([&] {
        AtomicDirectory left(folder.file("out"), is_layer);
        left.write("a.svg", "a");
        _exit(0); // before any destructor
    });
    ASSERT_EQ(code, 0);
    const fs::path left = folder.path() / folder.entries().front();
    fs::copy_file(left / "a.svg", left / "notes.txt");
    {
        AtomicDirectory directory(folder.file("out"), is_layer);
        directory.commit();
    }
    EXPECT_TRUE(fs::exists(left / "notes.txt") && fs::exists(left / "a.svg"));
    EXPECT_TRUE(fs::exists(folder.path() / "out"));
}

TEST(AtomicDirectory, LeavesWhatIsNotItsOwnKindOfLeftoverAlone) {
    const TemporaryFolder folder;
    AtomicDirectory living(folder.file("out"), is_layer);
    living.write("a.svg", "a");
    const std::string name = folder.entries().front();
    // Of another machine, or of this one before it was started again.
    const std::string of_another_machine = ".out.00000000-0.tmp";
    fs::create_directory(folder.path() / of_another_machine);
    // A file or a link of the name that would be taken next.
    const std::string next = name.substr(0, name.size() - std::string("0.tmp").size()) + "1.tmp";
    fs::create_symlink(of_another_machine, folder.path() / next);
    {
        const AtomicDirectory second(folder.file("out"), is_layer);
        EXPECT_EQ(folder.entries().size(), 4U);
    }
    EXPECT_EQ(folder.entries().size(), 3U);
    living.commit();
    EXPECT_EQ(folder.entries().size(), 3U);
    EXPECT_EQ(file_bytes(folder.path() / "out" / "a.svg"), "a");
}

TEST(AtomicDirectory, KeepsThePermissionsOfTheFolderThatItReplaces) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "out";
    fs::create_directory(path);
    for (const fs::perms permissions :
         {fs::perms::owner_all, fs::perms::owner_read | fs::perms::owner_exec}) {
        fs::permissions(path, permissions);
        for (int round = 0; round < 2; ++round) { // empty, and not
            AtomicDirectory files(path.string(), is_layer);
            files.write("a.svg", "a");
            files.commit();
            EXPECT_EQ(fs::status(path).permissions(), permissions);
        }
    }
    EXPECT_EQ(folder.entries(), Names{"out"}); // also where the old one was not to be written to
    fs::permissions(path, fs::perms::owner_all);
}

TEST(AtomicDirectory, RefusesAMountPoint) {
    EXPECT_NE(test::error_of_folder("/proc").find(
                  "'/proc': it is a mount point, which nothing can replace; choose a folder in "
                  "it, such as '/proc/layers'"),
              std::string::npos);
}

TEST(AtomicDirectory, KeepsASymbolicLinkToAFolder) {
    const TemporaryFolder folder;
    fs::create_directory(folder.path() / "real");
    fs::create_directory_symlink("real", folder.path() / "link");
    AtomicDirectory directory(folder.file("link"), is_layer);
    directory.write("a.svg", "a");
    directory.commit();
    EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
    EXPECT_TRUE(fs::exists(folder.path() / "real" / "a.svg"));
}

} // namespace
} // namespace lamella::atomic_directory_posix_cases
