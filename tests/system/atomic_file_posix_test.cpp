#include "lamella/system/whole_file.hpp"

#include "fixtures/child_process.hpp"
#include "fixtures/rounds.hpp"
#include "output_checks.hpp"
#include "system/atomic_file.hpp"
#include "system/nameless_file.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

namespace lamella::atomic_file_posix_cases {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::Names;
using test::output_error_of;

TEST(AtomicFile, IsNotSharedWhereItIsWrittenInPlace) {
    EXPECT_EQ(AtomicFile("/dev/null").share(), "");
}

TEST(AtomicFile, PutsOtherBytesInThePlaceOfSomeAlsoInAPipe) {
    const auto write_and_overwrite = [](const std::string& path) {
        AtomicFile file(path, Overwriting::yes);
        file.append("0123456789");
        file.append(std::string(1'000'000, 'x'));
        file.overwrite(2, "ab");
        file.commit();
    };
    const TemporaryFolder folder;
    ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
    std::string piped;
    std::thread reader([&] { piped = file_bytes(folder.file("pipe")); });
    write_and_overwrite(folder.file("pipe"));
    reader.join();
    EXPECT_EQ(piped, "01ab456789" + std::string(1'000'000, 'x'));
    EXPECT_NE(output_error_of([&] { write_and_overwrite("/dev/full"); }).find("disk is full"),
              std::string::npos);
    EXPECT_EQ(folder.entries(), Names{"pipe"});
}

TEST(AtomicFile, NamesTheFolderThatADanglingLinkLacks) {
    const TemporaryFolder folder;
    fs::create_symlink("no/such/place", folder.path() / "dangling");
    const std::string text = output_error_of([&] { AtomicFile file(folder.file("dangling")); });
    EXPECT_TRUE(contains(text, "no' does not exist")) << text;
}

TEST(AtomicFile, CanBeAskedForAPipeAndADeviceThatItLeavesAlone) {
    const TemporaryFolder folder;
    ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
    check_writable(folder.file("pipe")); // does not wait for a reader
    check_writable("/dev/full");
    EXPECT_EQ(folder.entries(), Names{"pipe"});
}

TEST(AtomicFile, LeavesNothingBehindWhenTheProcessIsKilled) {
    const TemporaryFolder folder;
    if (!create_nameless(folder.path().string()).is_open())
        GTEST_SKIP() << "the file system of temporary files has none without a name";
    write_file(folder.file("a.cli"), "old");
    const pid_t child = fork();
    if (child == 0) {
        AtomicFile file(folder.file("a.cli"));
        file.append(std::string(3'000'000, 'x'));
        kill(getpid(), SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(folder.entries(), Names{"a.cli"});
    EXPECT_EQ(file_bytes(folder.file("a.cli")), "old");
}

TEST(AtomicFile, IsRemovedFromOutsideWhenTheProcessHasToEndAtOnce) {
    const TemporaryFolder folder;
    const int code = exit_code_of_child([&] {
        AtomicFile done(folder.file("done"));
        done.append("done");
        done.commit();
        std::vector<std::unique_ptr<AtomicFile>> files;
        for (int i = 0; i < 20; ++i) {
            files.push_back(std::make_unique<AtomicFile>(folder.file(std::to_string(i))));
            files.back()->append(std::string(300'000, 'x'));
            if (i % 2 == 0)
                static_cast<void>(files.back()->share());
            if (i % 3 == 0)
                files.pop_back(); // its place in the list is used again
        }
        remove_unfinished();
        remove_unfinished();
        try {
            AtomicFile late(folder.file("late"));
            late.commit();
        } catch (const Error& error) {
            _exit(error.kind() == ErrorKind::cancelled ? 0 : 1); // before any destructor
        }
        _exit(2);
    });
    EXPECT_EQ(code, 0);
    EXPECT_EQ(folder.entries(), Names{"done"});
}

TEST(AtomicFile, LeavesNoTemporaryNameWheneverTheProcessEnds) {
    const TemporaryFolder folder;
    for (int round = 0; round < test::rounds_within_reason(100); ++round) {
        const int code = exit_code_of_child([&] {
            std::vector<std::thread> writers;
            for (int i = 0; i < 4; ++i)
                writers.emplace_back([&, i] {
                    try {
                        for (;;)
                            AtomicFile(folder.file(std::to_string(i))).commit();
                    } catch (const Error&) {
                        std::this_thread::sleep_for(
                            std::chrono::hours(1)); // whoever ends the process is faster
                    }
                });
            std::this_thread::sleep_for(std::chrono::microseconds(500 + 37 * round * test::slowness));
            remove_unfinished();
            _exit(0);
        });
        EXPECT_EQ(code, 0);
        for (const std::string& name : folder.entries())
            EXPECT_FALSE(name.ends_with(".tmp")) << name << " in round " << round;
    }
}

TEST(AtomicFile, GivesANewFileThePermissionsOfTheUmaskAndKeepsThoseOfAReplacedOne) {
    const TemporaryFolder folder;
    const mode_t before = umask(027);
    write_whole_file(folder.file("new"), "x");
    umask(before);
    struct stat status {};
    ASSERT_EQ(stat(folder.file("new").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0640U);
    ASSERT_EQ(chmod(folder.file("new").c_str(), 0600), 0);
    write_whole_file(folder.file("new"), "y");
    ASSERT_EQ(stat(folder.file("new").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0600U);
    EXPECT_EQ(file_bytes(folder.file("new")), "y");
}

TEST(AtomicFile, WritesThroughASymbolicLinkAndKeepsTheLink) {
    const TemporaryFolder folder;
    fs::create_directory(folder.path() / "real");
    write_file(folder.path() / "real" / "target", "old");
    fs::create_symlink("real/target", folder.path() / "link");
    fs::create_symlink("link", folder.path() / "link2");
    write_whole_file(folder.file("link2"), "new");
    EXPECT_EQ(file_bytes(folder.path() / "real" / "target"), "new");
    EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
    EXPECT_TRUE(fs::is_symlink(folder.path() / "link2"));
    // One that dangles makes its target.
    fs::create_symlink("real/other", folder.path() / "dangling");
    write_whole_file(folder.file("dangling"), "made");
    EXPECT_EQ(file_bytes(folder.path() / "real" / "other"), "made");
    fs::create_symlink("circle", folder.path() / "circle");
    EXPECT_TRUE(contains(output_error_of([&] { AtomicFile(folder.file("circle")); }), "circle"));
}

TEST(AtomicFile, FollowsNoLinkThatAnotherUserPlanted) {
    if (geteuid() != 0)
        GTEST_SKIP() << "only root makes links of other users";
    constexpr uid_t other = 12345;
    const TemporaryFolder folder;
    const fs::path shared = folder.path() / "shared";
    fs::create_directory(shared);
    write_file(folder.path() / "target", "old");
    fs::create_directory(folder.path() / "elsewhere");
    fs::create_symlink("../target", shared / "link");
    fs::create_symlink("../elsewhere", shared / "sub");
    const auto own = [&](uid_t of_folder, uid_t of_links, mode_t mode) {
        ASSERT_EQ(chown(shared.c_str(), of_folder, 0), 0);
        ASSERT_EQ(chmod(shared.c_str(), mode), 0);
        for (const char* name : {"link", "sub"})
            ASSERT_EQ(lchown((shared / name).c_str(), of_links, 0), 0);
    };
    for (const mode_t mode : {01777U, 0777U, 0775U}) {
        own(0, other, mode);
        for (const char* name : {"link", "sub/new", "sub/../link"})
            EXPECT_TRUE(contains(output_error_of([&] { write_whole_file((shared / name).string(), "new"); }),
                                 "a link that another user made"))
                << name;
        EXPECT_EQ(file_bytes(folder.path() / "target"), "old");
        EXPECT_TRUE(fs::is_empty(folder.path() / "elsewhere"));
    }
    // Own links, those of the owner of the folder, and those in folders of one user alone are followed.
    for (const auto& [of_folder, of_links, mode] : {std::tuple(other, uid_t{0}, mode_t{0777}),
                                                    {other, other, mode_t{0777}},
                                                    {uid_t{0}, other, mode_t{0755}}}) {
        own(of_folder, of_links, mode);
        write_whole_file((shared / "link").string(), "new");
        EXPECT_EQ(file_bytes(folder.path() / "target"), "new");
        write_whole_file((folder.path() / "target").string(), "old");
    }
}

TEST(AtomicFile, WritesSpecialFilesInPlace) {
    write_whole_file("/dev/null", "gone");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));

    const TemporaryFolder folder;
    const std::string fifo = folder.file("fifo");
    ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
    std::string received;
    std::thread reader([&] { received = file_bytes(fifo); });
    write_whole_file(fifo, std::string(200'000, 'f'));
    reader.join();
    EXPECT_EQ(received.size(), 200'000U);
    EXPECT_TRUE(fs::is_fifo(fifo));
}

TEST(AtomicFile, ReportsAFullDisk) {
    const auto fill = [] {
        write_whole_file("/dev/full", std::string(1000, 'x'));
    };
    EXPECT_TRUE(contains(output_error_of(fill), "the disk is full"));
    AtomicFile file("/dev/full");
    const std::string big(1'000'000, 'x');
    EXPECT_TRUE(contains(output_error_of([&] { file.append(big); }), "the disk is full"));
    EXPECT_THROW(file.append("more"), Error);
    EXPECT_THROW(file.commit(), Error);
}

// Runs `action` in a child process, where limits can be set that must not stay; true when it returned true.
bool true_in_child(const std::function<bool()>& action) {
    const int code = exit_code_of_child([&] {
        bool ok = false;
        try {
            ok = action();
        } catch (...) {
        }
        _exit(ok ? 0 : 1);
    });
    return code == 0;
}

TEST(AtomicFile, LeavesNoFileWhenTheDiskFillsUpHalfWay) {
    const TemporaryFolder folder;
    write_file(folder.file("a.cli"), "old");
    EXPECT_TRUE(true_in_child([&] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{.rlim_cur = 600'000, .rlim_max = 600'000};
        setrlimit(RLIMIT_FSIZE, &limit);
        AtomicFile file(folder.file("a.cli"));
        try {
            for (int i = 0; i < 100; ++i)
                file.append(std::string(10'000, 'x'));
        } catch (const Error& error) {
            return error.kind() == ErrorKind::output && contains(error.what(), "larger than") &&
                   folder.entries() == Names{"a.cli"};
        }
        return false;
    }));
    EXPECT_EQ(file_bytes(folder.file("a.cli")), "old");
    EXPECT_EQ(folder.entries(), Names{"a.cli"});
}

TEST(AtomicFile, LeavesNoFileWhenTheDiskFillsUpInACompletion) {
    const TemporaryFolder folder;
    write_file(folder.file("a.cli"), "old");
    EXPECT_TRUE(true_in_child([&] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{.rlim_cur = 600'000, .rlim_max = 600'000};
        setrlimit(RLIMIT_FSIZE, &limit);
        AtomicFile file(folder.file("a.cli"));
        Completions after;
        for (int i = 0; i < 100; ++i) {
            const auto piece = std::make_shared<const std::string>(10'000, 'x');
            file.append(*piece, piece, after);
        }
        const std::string error = output_error_of([&] {
            for (const auto& completion : after)
                completion();
        });
        const std::string later = output_error_of([&] { file.append("more"); });
        return contains(error, "larger than") && later == error &&
               output_error_of([&] { file.commit(); }) == error;
    }));
    EXPECT_EQ(file_bytes(folder.file("a.cli")), "old");
    EXPECT_EQ(folder.entries(), Names{"a.cli"});
}

TEST(AtomicFile, WritesStandardOutput) {
    const TemporaryFolder folder;
    EXPECT_TRUE(true_in_child([&] {
        if (std::freopen(folder.file("out").c_str(), "wb", stdout) == nullptr)
            return false;
        write_whole_file("-", "to standard output");
        return write(STDOUT_FILENO, "!", 1) == 1; // it was not closed
    }));
    EXPECT_EQ(file_bytes(folder.file("out")), "to standard output!");
}

TEST(AtomicFile, DoesNotReplaceTheFileBehindDevStdout) {
    const TemporaryFolder folder;
    EXPECT_TRUE(true_in_child([&] {
        if (std::freopen(folder.file("out").c_str(), "wb", stdout) == nullptr)
            return false;
        write_whole_file("/dev/stdout", "redirected");
        return true;
    }));
    EXPECT_EQ(file_bytes(folder.file("out")), "redirected");
    EXPECT_EQ(folder.entries(), Names{"out"});
}

TEST(AtomicFile, NamesTheFolderOfTemporaryFilesWhereItTakesNone) {
    EXPECT_TRUE(true_in_child([] {
        setenv("TMPDIR", "/nonexist", 1);
        const std::string text = output_error_of([] { AtomicFile file("/dev/null", Overwriting::yes); });
        return contains(text, "'/nonexist'") && contains(text, "TMPDIR");
    }));
}

TEST(AtomicFile, DoesNotWriteWhereItMayNot) {
    const TemporaryFolder folder;
    const fs::path locked = folder.path() / "locked";
    fs::create_directory(locked);
    fs::permissions(locked, fs::perms(0555));
    write_file(folder.file("protected"), "old");
    fs::permissions(folder.file("protected"), fs::perms(0444));
    EXPECT_TRUE(true_in_child([&] {
        if (!give_up_capabilities())
            return false;
        const std::string in_locked = output_error_of([&] { AtomicFile file((locked / "a").string()); });
        const std::string on_file = output_error_of([&] { AtomicFile file(folder.file("protected")); });
        return contains(in_locked, "no permission in the folder") && contains(on_file, "write-protected");
    }));
    EXPECT_EQ(folder.entries(), (Names{"locked", "protected"}));
}

} // namespace
} // namespace lamella::atomic_file_posix_cases
