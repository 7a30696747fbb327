#include "lamella/raster/image.hpp"
#include "lamella/slices/layer_file.hpp"

#include "container/inflate.hpp"
#include "fixtures/expect_error.hpp"
#include "slices/images/png.hpp"
#include "slices/images/png_reader.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::png_reader_cases {
namespace {

std::string four(std::uint32_t n) {
    return {static_cast<char>(n >> 24), static_cast<char>(n >> 16), static_cast<char>(n >> 8),
            static_cast<char>(n)};
}

std::string chunk(const std::string& name, const std::string& content) {
    return four(static_cast<std::uint32_t>(content.size())) + name + content + four(crc32_of(name + content));
}

struct PngParts {
    std::uint32_t width = 4;
    std::uint32_t height = 2;
    int bits = 8;
    int colour = 0;
    int interlace = 0;
    std::string rows = std::string("\0abcd\0efgh", 10); ///< with their filters
    std::size_t pieces = 1;                             ///< chunks of pixels
    std::string palette = {};
    std::string alphas = {};
};

std::string png_of(const PngParts& parts) {
    std::string stream(compressBound(static_cast<uLong>(parts.rows.size())), '\0');
    uLongf size = stream.size();
    compress(reinterpret_cast<Bytef*>(stream.data()), &size,
             reinterpret_cast<const Bytef*>(parts.rows.data()), static_cast<uLong>(parts.rows.size()));
    stream.resize(size);
    std::string file = "\x89PNG\r\n\x1a\n" +
                       chunk("IHDR", four(parts.width) + four(parts.height) + static_cast<char>(parts.bits) +
                                         static_cast<char>(parts.colour) + std::string(2, '\0') +
                                         static_cast<char>(parts.interlace));
    if (!parts.palette.empty())
        file += chunk("PLTE", parts.palette);
    if (!parts.alphas.empty())
        file += chunk("tRNS", parts.alphas);
    for (std::size_t i = 0; i < parts.pieces; ++i) {
        const std::size_t from = i * stream.size() / parts.pieces;
        file += chunk("IDAT", stream.substr(from, (i + 1) * stream.size() / parts.pieces - from));
    }
    return file + chunk("IEND", "");
}

std::vector<int> pixels_of(std::string_view file, std::uint32_t width = 4, std::uint32_t height = 2) {
    ReadLimits limits(ByteSource{}, LayerReadOptions{.max_memory = 1 << 20});
    RunBuilder image(width, height, limits);
    decode_png(file, "image", image, limits);
    EXPECT_EQ(image.left(), 0U);
    std::vector<int> values;
    std::uint64_t from = 0;
    for (const ImageRun& run : image.take().runs) {
        values.insert(values.end(), run.end - from, run.value);
        from = run.end;
    }
    return values;
}

void expect_refused(const PngParts& parts, const std::string& text) {
    test::expect_error(ErrorKind::input, {text.c_str()},
                       [&] { static_cast<void>(pixels_of(png_of(parts))); });
}

using Values = std::vector<int>;

TEST(PngReader, ReadsGreysAndColours) {
    EXPECT_EQ(pixels_of(png_of({})), (Values{'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'}));
    EXPECT_EQ(pixels_of(png_of({.pieces = 3})), (Values{'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'}));
    EXPECT_EQ(pixels_of(png_of({.bits = 1, .rows = {"\0\xA0\0\x70", 4}})),
              (Values{255, 0, 255, 0, 0, 255, 255, 255}));
    EXPECT_EQ(pixels_of(png_of({.bits = 2, .rows = {"\0\x1B\0\xE4", 4}})),
              (Values{0, 85, 170, 255, 255, 170, 85, 0}));
    EXPECT_EQ(pixels_of(png_of({.bits = 4, .rows = {"\0\x0F\x12\0\0\0", 6}})),
              (Values{0, 255, 17, 34, 0, 0, 0, 0}));
    const std::string rgb("\0\1\1\1\2\2\2\3\3\3\4\4\4\0\5\5\5\6\6\6\7\7\7\xff\xfe\xff", 26);
    EXPECT_EQ(pixels_of(png_of({.colour = 2, .rows = rgb})), (Values{1, 2, 3, 4, 5, 6, 7, 255}));
    EXPECT_EQ(
        pixels_of(png_of({.width = 2, .height = 1, .colour = 4, .rows = {"\0\xff\xff\xff\0", 5}}), 2, 1),
        (Values{255, 0}));
    EXPECT_EQ(
        pixels_of(png_of({.width = 1, .height = 1, .colour = 6, .rows = {"\0\x0a\x0a\x0a\xff", 5}}), 1, 1),
        (Values{10}));
    EXPECT_EQ(pixels_of(png_of({.height = 1,
                                .bits = 1,
                                .colour = 3,
                                .rows = {"\0\x50", 2},
                                .palette = {"\0\0\0\x80\x80\x80", 6}}),
                        4, 1),
              (Values{0, 128, 0, 128}));
    EXPECT_EQ(pixels_of(png_of({.width = 2, .height = 1, .colour = 2, .rows = {"\0\1\2\3\4\5\6", 7}}), 6, 1),
              (Values{1, 2, 3, 4, 5, 6}))
        << "three pixels in one";
}

TEST(PngReader, ReadsAllColoursOfPartsAsMaterial) {
    EXPECT_EQ(pixels_of(png_of({.height = 1,
                                .bits = 2,
                                .colour = 3,
                                .rows = {"\0\x1B", 2},
                                .palette = {"\0\0\0\0\0\0\1\2\3\xff\xff\xff", 12},
                                .alphas = {"\0", 1}}),
                        4, 1),
              (Values{0, 255, 255, 255}));
}

TEST(PngReader, UndoesFilters) {
    // Each row is 10 20 30 40, stored as is, as difference to the left, above, to the mean, and to the
    // nearest.
    const std::string rows = std::string("\0\x0a\x14\x1e\x28", 5) + "\1\x0a\x0a\x0a\x0a" +
                             std::string("\2\0\0\0\0", 5) + "\3\5\5\5\5" + std::string("\4\0\0\0\0", 5);
    Values expected;
    for (int row = 0; row < 5; ++row)
        for (const int value : {10, 20, 30, 40})
            expected.push_back(value);
    EXPECT_EQ(pixels_of(png_of({.height = 5, .rows = rows}), 4, 5), expected);
}

TEST(PngReader, ReadsWhatTheEncoderWrites) {
    std::mt19937_64 random(8);
    constexpr std::uint32_t width = 61;
    constexpr std::uint32_t height = 40;
    for (int round = 0; round < 50; ++round) {
        PngEncoder encoder(width, height);
        Values expected;
        std::vector<PixelRun> row;
        for (std::uint32_t r = 0; r < height; ++r) {
            if (r == 0 || random() % 2 == 0) {
                row.clear();
                for (std::uint32_t at = 0; at < width;) {
                    at = std::min<std::uint32_t>(width, at + 1 + static_cast<std::uint32_t>(random() % 30));
                    const auto value = static_cast<std::uint8_t>(random() % 4 == 0 ? random() : 0);
                    if (!row.empty() && row.back().value == value)
                        row.back().end = at;
                    else
                        row.push_back({at, value});
                }
            }
            encoder.add(row, 1);
            for (const PixelRun& run : row)
                expected.resize(std::size_t{r} * width + run.end, run.value);
        }
        ByteBuffer file;
        encoder.finish(file);
        EXPECT_EQ(pixels_of(file.view(), width, height), expected);
        EXPECT_EQ(png_size(file.view(), "image").x, width);
    }
}

TEST(PngReader, RefusesWhatItCannotRead) {
    expect_refused({.interlace = 1},
                   "image: found an interlaced PNG file; only files that are not interlaced");
    expect_refused({.bits = 16}, "image: found 16 bits for a colour");
    expect_refused({.colour = 5}, "image: found colours of the kind 5");
    expect_refused({.width = 5}, "image: found an image of 5 x 2 pixels; the display has 4 x 2");
    expect_refused({.rows = std::string("\0abcd\0efg", 9)}, "found fewer pixels than its header has");
    expect_refused({.rows = std::string("\0abcd\0efghi", 11)}, "found more pixels than its header has");
    expect_refused({.rows = std::string("\0abcd\7efgh", 10)}, "found the filter 7 in row 1");
    const std::string sound = png_of({});
    for (std::size_t size = 0; size < sound.size(); ++size)
        test::expect_error(ErrorKind::input, {"image"},
                           [&] { static_cast<void>(pixels_of(std::string_view(sound).substr(0, size))); });
    for (std::size_t at = 0; at < sound.size(); ++at) {
        std::string changed = sound;
        changed[at] = static_cast<char>(changed[at] ^ 4);
        test::expect_error(ErrorKind::input, {"image"}, [&] { static_cast<void>(pixels_of(changed)); });
    }
}

TEST(PngReader, CountsMemoryBeforeItIsAllocated) {
    const std::string rows(std::size_t{1001} * 1000, '\0');
    const std::string file = png_of({.width = 1000, .height = 1000, .rows = rows});
    ReadLimits limits(ByteSource{}, LayerReadOptions{.max_memory = 900'000});
    RunBuilder image(1000, 1000, limits);
    test::expect_error(ErrorKind::limit, {}, [&] { decode_png(file, "image", image, limits); });
    test::expect_error(
        ErrorKind::input, {"bytes of compressed pixels; an image of 60000 x 60000 pixels takes more"},
        [&] { static_cast<void>(pixels_of(png_of({.width = 60000, .height = 60000}), 60000, 60000)); });
}

} // namespace
} // namespace lamella::png_reader_cases
