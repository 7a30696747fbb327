#include "fixtures/child_process.hpp"
#include "fixtures/expect_error.hpp"
#include "system/spill_file.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <span>
#include <string>

namespace lamella {
namespace {

/// TMPDIR is this folder for a while.
class SpillFolder {
  public:
    explicit SpillFolder(const std::string& path) {
        if (const char* before = std::getenv("TMPDIR"))
            before_ = before;
        setenv("TMPDIR", path.c_str(), 1);
    }
    ~SpillFolder() {
        if (before_.empty())
            unsetenv("TMPDIR");
        else
            setenv("TMPDIR", before_.c_str(), 1);
    }
    SpillFolder(const SpillFolder&) = delete;
    SpillFolder& operator=(const SpillFolder&) = delete;

  private:
    std::string before_;
};

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
    const SpillFolder spill(folder.path());
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

TEST(SpillFile, HasNoName) {
    const TemporaryFolder folder;
    const SpillFolder spill(folder.path());
    SpillFile file(4096);
    file.write(0, bytes("data"));
    EXPECT_TRUE(folder.entries().empty());
}

TEST(SpillFile, NamesAFolderThatIsNotThere) {
    const SpillFolder spill("/nowhere/at/all");
    const std::string text = test::error_of(ErrorKind::output, [] { const SpillFile file(4096); });
    EXPECT_TRUE(text.starts_with("/nowhere/at/all: ")) << text;
}

TEST(SpillFile, SaysBeforeTheWorkThatThereIsNoRoom) {
    const TemporaryFolder folder;
    const SpillFolder spill(folder.path());
    const std::string position = folder.path().string() + ": ";
    // More than any disk has.
    test::expect_error(ErrorKind::output, {position.c_str(), "36028797.0 GB", "TMPDIR"},
                       [] { const SpillFile file(std::uint64_t{1} << 55); });
}

TEST(SpillFile, SaysThatItMayNotGrow) {
    const TemporaryFolder folder;
    const SpillFolder spill(folder.path());
    // In a process of its own: the limit cannot be raised again.
    const int code = exit_code_of_child([] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{65'536, 65'536};
        setrlimit(RLIMIT_FSIZE, &limit);
        try {
            SpillFile file;
            file.write(0, bytes(std::string(100'000, 'x')));
        } catch (const Error& error) {
            _exit(std::string(error.what()).find("ulimit -f") != std::string::npos ? 7 : 8);
        }
        _exit(9);
    });
    EXPECT_EQ(code, 7);
}

} // namespace
} // namespace lamella
