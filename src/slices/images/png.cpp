#include "slices/images/png.hpp"

#include "container/deflate.hpp"
#include "container/inflate.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
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
constexpr std::uint8_t from_palette = 3;
constexpr std::uint8_t colour_and_alpha = 6;

void append_header(std::uint32_t width, std::uint32_t height, unsigned bits, std::uint8_t colours,
                   ByteBuffer& out) {
    out.append(std::string_view("\x89PNG\r\n\x1a\n", 8));
    const std::array<char, 4> w = big_endian(width);
    const std::array<char, 4> h = big_endian(height);
    std::array<char, 13> header{};
    std::copy(w.begin(), w.end(), header.begin());
    std::copy(h.begin(), h.end(), header.begin() + 4);
    header[8] = static_cast<char>(bits);
    header[9] = static_cast<char>(colours); // the rest is 0: Deflate, the usual filters, not interlaced
    append_chunk("IHDR", {header.data(), header.size()}, out);
}

/// Appends the colours, of which the first is transparent.
void append_palette(std::span<const PartColour> palette, ByteBuffer& out) {
    std::string colours;
    for (const PartColour& colour : palette)
        for (const std::uint8_t part : {colour.red, colour.green, colour.blue})
            colours += static_cast<char>(part);
    append_chunk("PLTE", colours, out);
    append_chunk("tRNS", std::string_view("\0", 1), out);
}

/// Collects bytes as runs.
class ByteRuns {
  public:
    explicit ByteRuns(std::vector<PixelRun>& runs) : runs_(runs) { runs_.clear(); }

    void add(std::uint8_t value, std::uint32_t count) {
        if (count == 0)
            return;
        end_ += count;
        if (!runs_.empty() && runs_.back().value == value)
            runs_.back().end = end_;
        else
            runs_.push_back({end_, value});
    }

  private:
    std::vector<PixelRun>& runs_;
    std::uint32_t end_ = 0;
};

} // namespace

PngEncoder::PngEncoder(std::uint32_t width, std::uint32_t height, PngPixels pixels)
    : width_(width), height_(height), pixels_(std::move(pixels)),
      row_bytes_(static_cast<std::uint32_t>((std::uint64_t{width} * pixels_.bits + 7) / 8)) {
    assert(pixels_.palette.size() <= std::size_t{1} << pixels_.bits);
}

std::span<const PixelRun> PngEncoder::packed(std::span<const PixelRun> row) {
    const unsigned bits = pixels_.bits;
    if (bits == 8)
        return row;
    const std::uint32_t in_a_byte = 8 / bits;
    ByteRuns bytes(bytes_);
    unsigned byte = 0; // the first `pixels` of it are set
    std::uint32_t pixels = 0;
    std::uint32_t from = 0;
    for (const PixelRun& run : row) {
        const unsigned code = pixels_.palette.empty() ? run.value >> (8 - bits) : run.value;
        const unsigned full = code * (255U / ((1U << bits) - 1)); // as many times as fit into a byte
        for (std::uint32_t left = run.end - from; left > 0;) {
            if (pixels == 0 && left >= in_a_byte) {
                bytes.add(static_cast<std::uint8_t>(full), left / in_a_byte);
                left %= in_a_byte;
                continue;
            }
            byte |= code << (8 - bits * ++pixels);
            --left;
            if (pixels == in_a_byte) {
                bytes.add(static_cast<std::uint8_t>(byte), 1);
                byte = pixels = 0;
            }
        }
        from = run.end;
    }
    if (pixels > 0)
        bytes.add(static_cast<std::uint8_t>(byte), 1);
    return bytes_;
}

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
    assert(difference_count_ < row.size() + 1 && last->end == row_bytes_);
    return true;
}

void PngEncoder::add_row(std::span<const PixelRun> row) {
    const bool fewer = !above_.empty() && find_differences(row);
    deflater_.put(fewer ? more_than_above : as_it_is, 1);
    deflater_.put(fewer ? std::span<const PixelRun>(differences_).first(difference_count_) : row);
}

void PngEncoder::add(std::span<const PixelRun> pixels, std::uint32_t times) {
    assert(!pixels.empty() && pixels.back().end == width_ && times >= 1);
    const std::span<const PixelRun> row = packed(pixels);
    add_row(row);
    above_.assign(row.begin(), row.end());
    if (row.size() == 1 && row.front().value == 0) {
        deflater_.put(0, (std::uint64_t{row_bytes_} + 1) * (times - 1));
        return;
    }
    for (std::uint32_t i = 1; i < times; ++i) {
        deflater_.put(more_than_above, 1);
        deflater_.put(0, row_bytes_);
    }
}

void PngEncoder::finish(ByteBuffer& out) {
    append_header(width_, height_, pixels_.bits, pixels_.palette.empty() ? grey : from_palette, out);
    if (!pixels_.palette.empty())
        append_palette(pixels_.palette, out);
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
    append_header(image.width, image.height, 8, colour_and_alpha, out);
    append_chunk("IDAT", stream, out);
    append_chunk("IEND", {}, out);
}

} // namespace lamella
