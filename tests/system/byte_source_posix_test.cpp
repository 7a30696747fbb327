#include "byte_source_files.hpp"
#include "fixtures/child_process.hpp"
#include "fixtures/expect_error.hpp"
#include "system/byte_source.hpp"
#include "temporary_folder.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <future>
#include <iterator>
#include <span>
#include <string>
#include <vector>

namespace lamella::byte_source_posix_cases {
namespace {

namespace fs = std::filesystem;

using ByteSourcePosixTest = test::ByteSourceFiles;
using test::input_error_of;
using test::some_text;
using test::text_of;

/// Standard input comes from `descriptor` while this lives.
class RedirectedInput {
  public:
    explicit RedirectedInput(int descriptor) : saved_(dup(STDIN_FILENO)) { dup2(descriptor, STDIN_FILENO); }
    ~RedirectedInput() {
        dup2(saved_, STDIN_FILENO);
        close(saved_);
    }
    RedirectedInput(const RedirectedInput&) = delete;
    RedirectedInput& operator=(const RedirectedInput&) = delete;

  private:
    int saved_;
};

bool always(std::span<const std::byte>, std::uint64_t) {
    return true;
}

constexpr std::uint64_t all_memory = ~std::uint64_t{0};

std::ptrdiff_t open_descriptors() {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
}

TEST_F(ByteSourcePosixTest, KeepsAFileThatIsReadInWindowsOpenAsLongAsItsBytesLive) {
    const std::string file = write("part", some_text(100'000));
    const auto before = open_descriptors();
    {
        const ByteSource source = open_bytes(file, {}, all_memory, always);
        input_error_of([&] { (void)open_bytes(path("")); });
        EXPECT_EQ(open_descriptors(), before + 1);
    }
    EXPECT_EQ(open_descriptors(), before);
}

TEST_F(ByteSourcePosixTest, KeepsNoFileOpenThatIsCopied) {
    const std::string file = write("part", some_text(100'000));
    const auto before = open_descriptors();
    const std::vector<ByteSource> sources{open_bytes(file), open_bytes(file, {}, 1'000)};
    EXPECT_EQ(open_descriptors(), before);
}

TEST_F(ByteSourcePosixTest, LeavesDescriptorsToOthersWhereManyAreOpen) {
    const std::string text = some_text(100'000);
    const std::string file = write("part", text);
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
    rlimit few = before;
    few.rlim_cur = 40;
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
    std::vector<ByteSource> sources;
    for (int i = 0; i < 100; ++i)
        sources.push_back(open_bytes(file, {}, i % 2 == 0 ? 0 : all_memory, always));
    for (const ByteSource& source : sources) {
        std::string copy(99'000, ' ');
        copy_out(source, 1'000, std::as_writable_bytes(std::span(copy)));
        EXPECT_EQ(copy, text.substr(1'000));
    }
    EXPECT_FALSE(sources.back().file);
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
}

TEST_F(ByteSourcePosixTest, ReadsAPipeToItsEnd) {
    // More than a pipe holds, more than the first buffer, and not a multiple of anything.
    const std::string sent = some_text(3'333'333);
    ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
    const auto writer = std::async(std::launch::async, [&] { write("pipe", sent); });
    const ByteSource source = open_bytes(path("pipe"));
    EXPECT_EQ(text_of(source), sent);
}

TEST_F(ByteSourcePosixTest, ReadsStandardInputFromAPipe) {
    const std::string sent = some_text(200'000);
    std::array<int, 2> ends{};
    ASSERT_EQ(pipe(ends.data()), 0);
    const auto writer = std::async(std::launch::async, [&] {
        std::size_t done = 0;
        while (done < sent.size()) {
            const ssize_t wrote = ::write(ends[1], sent.data() + done, sent.size() - done);
            if (wrote <= 0)
                break;
            done += static_cast<std::size_t>(wrote);
        }
        close(ends[1]);
    });
    const RedirectedInput input(ends[0]);
    close(ends[0]);
    const ByteSource source = open_bytes("-");
    EXPECT_EQ(text_of(source), sent);
    EXPECT_EQ(source.name, "standard input");
}

TEST_F(ByteSourcePosixTest, ReadsOnlyWhatIsLeftOfAHalfReadStandardInput) {
    const int file = open(write("part", "head tail").c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_GE(file, 0);
    const RedirectedInput input(file);
    EXPECT_EQ(text_of(open_bytes("-")), "head tail");
    ASSERT_EQ(lseek(file, 5, SEEK_SET), 5);
    EXPECT_EQ(text_of(open_bytes("-")), "tail");
    close(file);
}

TEST_F(ByteSourcePosixTest, ReadsFilesThatClaimToHaveNoBytes) {
    EXPECT_FALSE(open_bytes("/proc/self/status").bytes.empty());
}

TEST_F(ByteSourcePosixTest, StopsWaitingForAPipeWhenAsked) {
    ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
    CancelFlag stop;
    const auto stopper = std::async(std::launch::async, [&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        stop.request();
    });
    test::error_of(ErrorKind::cancelled, [&] { (void)open_bytes(path("pipe"), {.cancel = &stop}); });
}

TEST_F(ByteSourcePosixTest, RefusesADevice) {
    EXPECT_EQ(input_error_of([&] { (void)open_bytes("/dev/zero"); }),
              "/dev/zero: is a device, expected a file or a pipe");
}

TEST_F(ByteSourcePosixTest, NamesAFileThatMayNotBeRead) {
    const std::string file = write("secret", "x");
    fs::permissions(file, fs::perms::none);
    const int code = exit_code_of_child([&] {
        const bool as_told = give_up_capabilities() && input_error_of([&] { (void)open_bytes(file); }) ==
                                                           file + ": no permission to read this file";
        _exit(as_told ? 0 : 1);
    });
    EXPECT_EQ(code, 0);
}

} // namespace
} // namespace lamella::byte_source_posix_cases
