#include "slices/images/png.hpp"

#include "container/deflate.hpp"
#include "container/inflate.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

namespace {

// Filter byte before each row. The bytes of the row are the pixels themselves, or their differences from the
// pixels above.
constexpr std::uint8_t as_it_is = 0;
constexpr std::uint8_t more_than_above = 2;

std::array<char, 4> big_endian(std::uint32_t n) {
    return {static_cast<char>(n >> 24 & 0xff), static_cast<char>(n >> 16 & 0xff),
            static_cast<char>(n >> 8 & 0xff), static_cast<char>(n & 0xff)};
}

void append(std::uint32_t n, ByteBuffer& out) {
    const std::array<char, 4> bytes = big_endian(n);
    out.append({bytes.data(), bytes.size()});
}

void append_chunk(std::string_view name, std::string_view content, ByteBuffer& out) {
    append(static_cast<std::uint32_t>(content.size()), out);
    const std::size_t begin = out.view().size();
    out.append(name);
    out.append(content);
    append(crc32_of(out.view().substr(begin)), out);
}

constexpr std::uint8_t grey = 0;
constexpr std::uint8_t colour_and_alpha = 6;

void append_header(std::uint32_t width, std::uint32_t height, std::uint8_t colours, ByteBuffer& out) {
    out.append(std::string_view("\x89PNG\r\n\x1a\n", 8));
    const std::array<char, 4> w = big_endian(width);
    const std::array<char, 4> h = big_endian(height);
    std::array<char, 13> header{};
    std::copy(w.begin(), w.end(), header.begin());
    std::copy(h.begin(), h.end(), header.begin() + 4);
    header[8] = 8;                          // bits
    header[9] = static_cast<char>(colours); // the rest is 0: Deflate, the usual filters, not interlaced
    append_chunk("IHDR", {header.data(), header.size()}, out);
}

} // namespace

bool PngEncoder::find_differences(std::span<const PixelRun> row) {
    if (differences_.size() < row.size())
        differences_.resize(row.size());
    PixelRun* last = differences_.data();
    const PixelRun* const too_many = last + row.size() - 1;
    const PixelRun* here = row.data();
    const PixelRun* up = above_.data();
    *last = {0, static_cast<std::uint8_t>(here->value - up->value)};
    std::uint8_t value = last->value;
    for (const PixelRun* const end = here + row.size(); here < end;) {
        const auto difference = static_cast<std::uint8_t>(here->value - up->value);
        const std::uint32_t both = std::min(here->end, up->end);
        last += difference == value ? 0 : 1;
        if (last == too_many)
            return false;
        value = difference;
        *last = {both, difference};
        here += here->end == both ? 1 : 0;
        up += up->end == both ? 1 : 0;
    }
    difference_count_ = static_cast<std::size_t>(last + 1 - differences_.data());
    assert(difference_count_ < row.size() + 1 && last->end == width_);
    return true;
}

void PngEncoder::add_row(std::span<const PixelRun> row) {
    const bool fewer = !above_.empty() && find_differences(row);
    deflater_.put(fewer ? more_than_above : as_it_is, 1);
    deflater_.put(fewer ? std::span<const PixelRun>(differences_).first(difference_count_) : row);
}

void PngEncoder::add(std::span<const PixelRun> row, std::uint32_t times) {
    assert(!row.empty() && row.back().end == width_ && times >= 1);
    add_row(row);
    above_.assign(row.begin(), row.end());
    if (row.size() == 1 && row.front().value == 0) {
        deflater_.put(0, (std::uint64_t{width_} + 1) * (times - 1));
        return;
    }
    for (std::uint32_t i = 1; i < times; ++i) {
        deflater_.put(more_than_above, 1);
        deflater_.put(0, width_);
    }
}

void PngEncoder::finish(ByteBuffer& out) {
    append_header(width_, height_, grey, out);
    append_chunk("IDAT", deflater_.finish(), out);
    append_chunk("IEND", {}, out);
    above_.clear();
}

void append_png(const ColourImage& image, ByteBuffer& out) {
    const std::size_t row_size = std::size_t{4} * image.width;
    std::string rows((row_size + 1) * image.height, '\0');
    const std::vector<std::uint8_t> none(row_size);
    const std::uint8_t* above = none.data();
    for (std::size_t row = 0; row < image.height; ++row) {
        const std::uint8_t* const here = image.values.data() + row * row_size;
        char* const to = rows.data() + row * (row_size + 1);
        to[0] = static_cast<char>(more_than_above);
        for (std::size_t i = 0; i < row_size; ++i)
            to[i + 1] = static_cast<char>(here[i] - above[i]);
        above = here;
    }
    std::string stream("\x78\x01", 2); // Deflate, window of 32 KB, the fastest kind
    stream += deflated(rows);
    const std::array<char, 4> checksum = big_endian(adler32_of(rows));
    stream.append(checksum.data(), checksum.size());
    append_header(image.width, image.height, colour_and_alpha, out);
    append_chunk("IDAT", stream, out);
    append_chunk("IEND", {}, out);
}

} // namespace lamella
