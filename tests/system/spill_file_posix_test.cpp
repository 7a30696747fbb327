#include "lamella/core/error.hpp"

#include "fixtures/child_process.hpp"
#include "system/scratch_folder.hpp"
#include "system/spill_file.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <span>
#include <string>

namespace lamella::spill_file_posix_cases {
namespace {

std::span<const std::byte> bytes(const std::string& text) {
    return std::as_bytes(std::span(text));
}

TEST(SpillFile, HasNoName) {
    const TemporaryFolder folder;
    const test::ScratchFolder spill(folder.path().string());
    SpillFile file(4096);
    file.write(0, bytes("data"));
    EXPECT_TRUE(folder.entries().empty());
}

TEST(SpillFile, SaysThatItMayNotGrow) {
    const TemporaryFolder folder;
    const test::ScratchFolder spill(folder.path().string());
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
} // namespace lamella::spill_file_posix_cases
