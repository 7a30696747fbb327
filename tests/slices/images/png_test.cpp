#include "fixtures/layers.hpp"
#include "fixtures/png_file.hpp"
#include "fixtures/random.hpp"
#include "slices/images/png.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lamella {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;

std::string encoded(const Layer& layer, const PixelGrid& grid, const RasterOptions& options) {
    PngEncoder encoder(grid.width, grid.height);
    rasterise({&layer, 1}, grid, options,
              [&](std::span<const PixelRun> row, std::uint32_t times) { encoder.add(row, times); });
    ByteBuffer out;
    encoder.finish(out);
    return std::string(out.view());
}

Layer tangle(std::uint64_t seed, double size, std::int64_t points) {
    Random random(seed);
    std::vector<Contour> rings(static_cast<std::size_t>(random.integer(0, 5)));
    for (Contour& ring : rings)
        for (std::int64_t i = 0; i < points; ++i)
            ring.push_back({random.real(-0.2, 1.2) * size, random.real(-0.2, 1.2) * size});
    return layer_of(rings);
}

TEST(Png, IsReadByLibpngAsTheImageThatItIs) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        for (const unsigned antialias : {1U, 4U}) {
            const PixelGrid grid{.width = static_cast<std::uint32_t>(1 + 61 * seed % 700),
                                 .height = static_cast<std::uint32_t>(1 + 37 * seed % 400)};
            const Layer layer = tangle(seed, 300, 3 + static_cast<std::int64_t>(seed % 40));
            const PngFile file = read_png(encoded(layer, grid, {.antialias = antialias}));
            ASSERT_EQ(file.error, "");
            EXPECT_EQ(file.bits, 8);
            EXPECT_EQ(file.colour_type, 0);
            EXPECT_FALSE(file.interlaced);
            ASSERT_EQ(file.width, grid.width);
            ASSERT_EQ(file.height, grid.height);
            ASSERT_TRUE(file.values == paint({&layer, 1}, grid, {.antialias = antialias}).values)
                << "seed " << seed;
        }
    }
}

/// The pixels of a row of bytes.
std::vector<std::uint8_t> unpacked(const std::uint8_t* row, std::uint32_t width, unsigned bits) {
    std::vector<std::uint8_t> pixels;
    for (std::uint32_t i = 0; i < width; ++i)
        pixels.push_back(static_cast<std::uint8_t>(
            row[std::uint64_t{i} * bits / 8] >> (8 - bits - i * bits % 8) & ((1 << bits) - 1)));
    return pixels;
}

TEST(Png, PacksPixelsOfFewBits) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        Random random(seed);
        PngPixels kind{.bits = std::array{1U, 1U, 2U, 4U, 8U}[seed % 5]};
        if (seed % 5 > 0)
            kind.palette.resize(std::size_t{1} << kind.bits, {10, 20, 30});
        const auto width = static_cast<std::uint32_t>(random.integer(1, seed < 100 ? 20 : 300));
        PngEncoder encoder(width, 40, kind);
        std::vector<std::vector<std::uint8_t>> expected;
        while (expected.size() < 40) {
            std::vector<PixelRun> row;
            std::vector<std::uint8_t> pixels;
            for (std::uint32_t end = 0; end < width;) {
                end = std::min<std::uint32_t>(width, end + static_cast<std::uint32_t>(random.integer(1, 40)));
                const auto code = static_cast<std::uint8_t>(random.integer(0, (1 << kind.bits) - 1));
                if (!pixels.empty() && pixels.back() == code)
                    row.pop_back();
                row.push_back({end, kind.palette.empty() ? static_cast<std::uint8_t>(255 * code) : code});
                pixels.resize(end, code);
            }
            const auto times = static_cast<std::uint32_t>(random.integer(
                1, std::min<std::int64_t>(3, 40 - static_cast<std::int64_t>(expected.size()))));
            encoder.add(row, times);
            expected.insert(expected.end(), times, pixels);
        }
        ByteBuffer out;
        encoder.finish(out);
        const PngFile file = read_png(std::string(out.view()));
        ASSERT_EQ(file.error, "");
        EXPECT_EQ(file.bits, static_cast<int>(kind.bits));
        EXPECT_EQ(file.colour_type, kind.palette.empty() ? 0 : 3);
        const std::size_t row_bytes = file.values.size() / 40;
        for (std::size_t r = 0; r < 40; ++r)
            ASSERT_EQ(unpacked(file.values.data() + r * row_bytes, width, kind.bits), expected[r]) << seed;
    }
}

TEST(Png, HasNothingButHeaderPixelsAndEnd) {
    const std::string file = encoded(Layer{}, {.width = 4000, .height = 3000}, {});
    EXPECT_EQ(file.substr(0, 8), "\x89PNG\r\n\x1a\n");
    EXPECT_EQ(file.substr(12, 4), "IHDR");
    EXPECT_EQ(file.substr(37, 4), "IDAT");
    EXPECT_EQ(file.substr(file.size() - 8, 4), "IEND");
    const auto byte = [&](std::size_t i) {
        return static_cast<std::size_t>(static_cast<unsigned char>(file[i]));
    };
    EXPECT_EQ(file.size(), 8 + 25 + 12 + 12 + (byte(33) << 24 | byte(34) << 16 | byte(35) << 8 | byte(36)));
}

TEST(Png, OfABlankImageIsAsSmallAsDeflateAllows) {
    const std::string file = encoded(Layer{}, {.width = 4000, .height = 3000}, {});
    EXPECT_LT(file.size(), 4001 * 3000 / 1032 + 150U);
}

TEST(Png, MakesOneImageAfterTheOther) {
    PngEncoder encoder(10, 10);
    const std::vector<PixelRun> row{{3, 0}, {7, 255}, {10, 0}};
    ByteBuffer first;
    encoder.add(row, 10);
    encoder.finish(first);
    ByteBuffer second;
    encoder.add(row, 4);
    encoder.add(row, 6);
    encoder.finish(second);
    const PngFile image = read_png(std::string(second.view()));
    EXPECT_EQ(image.error, "");
    EXPECT_TRUE(image.values == read_png(std::string(first.view())).values);
}

} // namespace
} // namespace lamella
