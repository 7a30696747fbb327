#include "byte_source_files.hpp"
#include "system/byte_source.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>

namespace lamella {
namespace {

namespace fs = std::filesystem;

using ByteSourceTest = test::ByteSourceFiles;
using test::input_error_of;
using test::some_text;
using test::text_of;

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

TEST_F(ByteSourceTest, ReportsBothSizesOfAFileThatWasCutOffWhileItWasRead) {
    const std::string file = write("part", some_text(3'000'000));
    const ByteSource source = open_bytes(file, {}, all_memory, always);
    fs::resize_file(file, 4'000);
    const std::string expected =
        file + ": was cut off while it was read: it had 3000000 bytes, and ends after 4000 now";
    std::string copy(9'000, ' ');
    EXPECT_EQ(input_error_of([&] { copy_out(source, 1'000, std::as_writable_bytes(std::span(copy))); }),
              expected);
    for (const std::uint64_t most : {all_memory, std::uint64_t{1'000}}) // whichever thread finds it out
        EXPECT_EQ(input_error_of([&] { (void)whole(source, {.threads = 4}, most); }), expected);
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

TEST_F(ByteSourceTest, NamesWhatIsWrongWithAPath) {
    EXPECT_EQ(input_error_of([&] { (void)open_bytes(path("none")); }),
              path("none") + ": there is no such file");
    EXPECT_EQ(input_error_of([&] { (void)open_bytes(write("file", "x") + "/part"); }),
              path("file/part") + ": there is no such file");
    EXPECT_EQ(input_error_of([&] { (void)open_bytes(path("")); }),
              path("") + ": is a folder, expected a file");
    EXPECT_EQ(input_error_of([&] { (void)open_bytes(write("empty", "")); }),
              path("empty") + ": is empty, expected a file with content");
    EXPECT_EQ(input_error_of([&] { (void)copy_bytes({}, "memory"); }),
              "memory: is empty, expected a file with content");
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
