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
#include <fstream>
#include <functional>
#include <future>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {
namespace {

namespace fs = std::filesystem;

class ByteSourceTest : public testing::Test {
  protected:
    [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }

    /// Returns the path.
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name), std::ios::binary) << text;
        return path(name);
    }

  private:
    TemporaryFolder folder_;
};

std::string text_of(const ByteSource& source) {
    return {reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size()};
}

std::string error_of(const std::function<void()>& action) {
    return test::error_of(ErrorKind::input, action);
}

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

std::string some_text(std::size_t size) {
    std::string text(size, ' ');
    for (std::size_t i = 0; i < size; ++i)
        text[i] = static_cast<char>('a' + i * i % 23);
    return text;
}

TEST_F(ByteSourceTest, GivesTheBytesOfAFile) {
    const ByteSource source = open_bytes(write("part", "seven b"));
    EXPECT_EQ(text_of(source), "seven b");
    EXPECT_EQ(source.name, path("part"));
    // Read at once, and by several threads; in memory, and on disk.
    for (const std::size_t bytes : {1, 65'535, 65'536, 3'333'333})
        for (const std::uint64_t most : {bytes, bytes - 1}) {
            const std::string text = some_text(bytes);
            const ByteSource copy = open_bytes(write("part", text), {.threads = 3}, most);
            EXPECT_EQ(text_of(copy), text) << bytes;
            EXPECT_EQ(copy.size(), bytes);
            EXPECT_EQ(copy.on_disk, most < bytes);
            EXPECT_EQ(copy.bytes_in_memory(), most < bytes ? 0 : bytes);
        }
}

TEST_F(ByteSourceTest, KeepsTheBytesOfADeletedFileAsLongAsACopyLives) {
    for (const std::size_t bytes : {10, 100'000}) {
        const std::string text = some_text(bytes);
        ByteSource copy;
        {
            const ByteSource source = open_bytes(write("part", text));
            copy = source;
        }
        fs::remove(path("part"));
        EXPECT_EQ(text_of(copy), text);
        const std::weak_ptr<const void> watch = copy.owner;
        copy = {};
        EXPECT_TRUE(watch.expired());
    }
}

bool always(std::span<const std::byte>, std::uint64_t) {
    return true;
}

constexpr std::uint64_t all_memory = ~std::uint64_t{0};

std::ptrdiff_t open_descriptors() {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
}

TEST_F(ByteSourceTest, ReadsAFileInWindowsWhereThatIsAskedFor) {
    const std::string text = some_text(100'000);
    const std::string file = write("part", text);
    const auto begins_so = [](std::span<const std::byte> beginning, std::uint64_t size) {
        return size == 100'000 && beginning.size() >= 84 && beginning[0] == std::byte{'a'};
    };
    const ByteSource source = open_bytes(file, {}, 0, begins_so);
    ASSERT_TRUE(source.file);
    EXPECT_EQ(source.size(), text.size());
    EXPECT_FALSE(source.on_disk);
    std::string copy(99'000, ' ');
    copy_out(source, 1'000, std::as_writable_bytes(std::span(copy)));
    EXPECT_EQ(copy, text.substr(1'000));
    EXPECT_EQ(text_of(whole(source, {}, all_memory)), text);
    EXPECT_FALSE(open_bytes(write("part", "b" + text), {}, all_memory, begins_so).file);
}

TEST_F(ByteSourceTest, KeepsAFileThatIsReadInWindowsOpenAsLongAsItsBytesLive) {
    const std::string file = write("part", some_text(100'000));
    const auto before = open_descriptors();
    {
        const ByteSource source = open_bytes(file, {}, all_memory, always);
        error_of([&] { (void)open_bytes(path("")); });
        EXPECT_EQ(open_descriptors(), before + 1);
    }
    EXPECT_EQ(open_descriptors(), before);
}

TEST_F(ByteSourceTest, KeepsNoFileOpenThatIsCopied) {
    const std::string file = write("part", some_text(100'000));
    const auto before = open_descriptors();
    const std::vector<ByteSource> sources{open_bytes(file), open_bytes(file, {}, 1'000)};
    EXPECT_EQ(open_descriptors(), before);
}

TEST_F(ByteSourceTest, LeavesDescriptorsToOthersWhereManyAreOpen) {
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

TEST_F(ByteSourceTest, ReportsBothSizesOfAFileThatWasCutOffWhileItWasRead) {
    const std::string file = write("part", some_text(3'000'000));
    const ByteSource source = open_bytes(file, {}, all_memory, always);
    fs::resize_file(file, 4'000);
    const std::string expected =
        file + ": was cut off while it was read: it had 3000000 bytes, and ends after 4000 now";
    std::string copy(9'000, ' ');
    EXPECT_EQ(error_of([&] { copy_out(source, 1'000, std::as_writable_bytes(std::span(copy))); }), expected);
    for (const std::uint64_t most : {all_memory, std::uint64_t{1'000}}) // whichever thread finds it out
        EXPECT_EQ(error_of([&] { (void)whole(source, {.threads = 4}, most); }), expected);
}

TEST_F(ByteSourceTest, GivesTheBytesOfAFileThatWasCutOffOrOverwrittenSince) {
    const std::string text = some_text(100'000);
    for (const std::uint64_t most : {all_memory, std::uint64_t{1'000}}) {
        const std::string file = write("part", text);
        const ByteSource source = open_bytes(file, {}, most);
        fs::resize_file(file, 10);
        EXPECT_EQ(text_of(source), text);
        write("part", std::string(100'000, 'x'));
        EXPECT_EQ(text_of(source), text);
    }
}

TEST_F(ByteSourceTest, TakesOfAFileThatGrowsWhatItHadWhenItWasOpened) {
    const std::string text = some_text(100'000);
    const std::string file = write("part", text);
    const ByteSource source = open_bytes(file, {}, all_memory, always);
    std::ofstream(file, std::ios::app) << "more";
    EXPECT_EQ(text_of(whole(source, {}, all_memory)), text);
}

TEST_F(ByteSourceTest, CopiesBytesThatAreInMemoryAlready) {
    const ByteSource source = copy_bytes(std::as_bytes(std::span("seven b", 7)), "text");
    std::string copy(3, ' ');
    copy_out(source, 2, std::as_writable_bytes(std::span(copy)));
    EXPECT_EQ(copy, "ven");
}

TEST_F(ByteSourceTest, OpensFilesBeyondFourGigabytes) {
    constexpr std::uint64_t size = (std::uint64_t{5} << 30) + 3;
    const std::string file = write("huge", "first");
    std::error_code failed;
    fs::resize_file(file, size, failed);
    if (failed)
        GTEST_SKIP() << "no sparse files here: " << failed.message();
    {
        std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
        out.seekp(static_cast<std::streamoff>(size - 4));
        out << "last";
    }
    const ByteSource source = open_bytes(file, {}, 0, always);
    ASSERT_EQ(source.size(), size);
    std::string end(5, ' ');
    copy_out(source, 0, std::as_writable_bytes(std::span(end)));
    EXPECT_EQ(end, "first");
    copy_out(source, size - 5, std::as_writable_bytes(std::span(end)));
    EXPECT_EQ(end, std::string_view("\0last", 5));
}

TEST_F(ByteSourceTest, ReadsAPipeToItsEnd) {
    // More than a pipe holds, more than the first buffer, and not a multiple of anything.
    const std::string sent = some_text(3'333'333);
    ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
    const auto writer = std::async(std::launch::async, [&] { write("pipe", sent); });
    const ByteSource source = open_bytes(path("pipe"));
    EXPECT_EQ(text_of(source), sent);
}

TEST_F(ByteSourceTest, ReadsStandardInputFromAPipe) {
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

TEST_F(ByteSourceTest, ReadsOnlyWhatIsLeftOfAHalfReadStandardInput) {
    const int file = open(write("part", "head tail").c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_GE(file, 0);
    const RedirectedInput input(file);
    EXPECT_EQ(text_of(open_bytes("-")), "head tail");
    ASSERT_EQ(lseek(file, 5, SEEK_SET), 5);
    EXPECT_EQ(text_of(open_bytes("-")), "tail");
    close(file);
}

TEST_F(ByteSourceTest, ReadsFilesThatClaimToHaveNoBytes) {
    EXPECT_FALSE(open_bytes("/proc/self/status").bytes.empty());
}

TEST_F(ByteSourceTest, StopsWaitingForAPipeWhenAsked) {
    ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
    CancelFlag stop;
    const auto stopper = std::async(std::launch::async, [&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        stop.request();
    });
    test::error_of(ErrorKind::cancelled, [&] { (void)open_bytes(path("pipe"), {.cancel = &stop}); });
}

TEST_F(ByteSourceTest, NamesWhatIsWrongWithAPath) {
    EXPECT_EQ(error_of([&] { (void)open_bytes(path("none")); }), path("none") + ": there is no such file");
    EXPECT_EQ(error_of([&] { (void)open_bytes(write("file", "x") + "/part"); }),
              path("file/part") + ": there is no such file");
    EXPECT_EQ(error_of([&] { (void)open_bytes(path("")); }), path("") + ": is a folder, expected a file");
    EXPECT_EQ(error_of([&] { (void)open_bytes(write("empty", "")); }),
              path("empty") + ": is empty, expected a file with content");
    EXPECT_EQ(error_of([&] { (void)open_bytes("/dev/zero"); }),
              "/dev/zero: is a device, expected a file or a pipe");
    EXPECT_EQ(error_of([&] { (void)copy_bytes({}, "memory"); }),
              "memory: is empty, expected a file with content");
}

TEST_F(ByteSourceTest, NamesAFileThatMayNotBeRead) {
    const std::string file = write("secret", "x");
    fs::permissions(file, fs::perms::none);
    const int code = exit_code_of_child([&] {
        const bool as_told = give_up_capabilities() && error_of([&] { (void)open_bytes(file); }) ==
                                                           file + ": no permission to read this file";
        _exit(as_told ? 0 : 1);
    });
    EXPECT_EQ(code, 0);
}

TEST_F(ByteSourceTest, CopiesMemory) {
    std::string text = "mine";
    const ByteSource source = copy_bytes(std::as_bytes(std::span(text)), "memory");
    text = "gone";
    EXPECT_EQ(text_of(source), "mine");
    EXPECT_EQ(source.name, "memory");
}

} // namespace
} // namespace lamella
