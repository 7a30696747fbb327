#include "slices/images/png_reader.hpp"

#include "lamella/core/error.hpp"

#include "container/inflate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

namespace {

constexpr std::string_view png_signature("\x89PNG\r\n\x1a\n", 8);
constexpr std::size_t chunk_bytes = 12; ///< of a chunk without its content

enum class PngColour : unsigned { grey = 0, rgb = 2, palette = 3, grey_alpha = 4, rgb_alpha = 6 };

[[noreturn]] void refuse_png(const std::string& name, const std::string& found, const std::string& expected) {
    throw Error(ErrorKind::input, fmt::format("{}: found {}; {}", name, found, expected));
}

std::uint32_t big_endian_at(std::string_view bytes, std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i)
        number = number << 8U | static_cast<unsigned char>(bytes[at + i]);
    return number;
}

struct PngHead {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    unsigned bits = 0;
    PngColour colour = PngColour::grey;
    unsigned channels = 1;
    bool interlaced = false;

    [[nodiscard]] std::uint64_t row_bytes() const noexcept {
        return (std::uint64_t{width} * channels * bits + 7) / 8;
    }
    /// Returns the distance of a byte from the one to its left, for filters.
    [[nodiscard]] std::size_t step() const noexcept { return bits < 8 ? 1 : channels; }
};

PngHead head_of(std::string_view file, const std::string& name) {
    constexpr std::size_t head_end = 29;
    if (file.size() < head_end || !file.starts_with(png_signature) || file.substr(12, 4) != "IHDR")
        refuse_png(name, "no PNG file", "the images of layers are PNG files");
    PngHead head;
    head.width = big_endian_at(file, 16);
    head.height = big_endian_at(file, 20);
    head.bits = static_cast<unsigned char>(file[24]);
    head.colour = static_cast<PngColour>(static_cast<unsigned char>(file[25]));
    head.interlaced = file[28] != 0;
    switch (head.colour) {
    case PngColour::grey:
    case PngColour::palette:
        head.channels = 1;
        break;
    case PngColour::grey_alpha:
        head.channels = 2;
        break;
    case PngColour::rgb:
        head.channels = 3;
        break;
    case PngColour::rgb_alpha:
        head.channels = 4;
        break;
    default:
        refuse_png(name, fmt::format("colours of the kind {}", static_cast<unsigned>(head.colour)),
                   "a PNG file has one of the kinds 0, 2, 3, 4 and 6");
    }
    return head;
}

/// Throws unless images of this kind are read.
void check_kind(const PngHead& head, const std::string& name) {
    if (head.interlaced)
        refuse_png(name, "an interlaced PNG file", "only files that are not interlaced are read");
    const bool few = head.bits == 1 || head.bits == 2 || head.bits == 4;
    if (head.bits != 8 && !(few && head.channels == 1))
        refuse_png(name, fmt::format("{} bits for a colour", head.bits),
                   "8 are read, and 1, 2 or 4 of grey or of a palette");
}

/// The contents of the chunks of a file.
struct PngContent {
    std::string joined = {};      ///< the compressed pixels, if they are in several chunks
    std::string_view pixels = {}; ///< the compressed pixels
    std::string_view palette = {};
    std::string_view alphas = {}; ///< of the first colours of the palette
};

PngContent content_of(std::string_view file, const std::string& name) {
    PngContent content;
    std::size_t chunks = 0; // with pixels
    for (std::size_t at = png_signature.size();;) {
        if (file.size() - at < chunk_bytes)
            refuse_png(name, fmt::format("the end of the PNG file at byte {}", at), "it is truncated");
        const std::uint32_t size = big_endian_at(file, at);
        if (size > file.size() - at - chunk_bytes)
            refuse_png(name, fmt::format("a chunk of {} bytes at byte {}", size, at),
                       "the PNG file ends before that");
        const std::string_view kind = file.substr(at + 4, 4);
        const std::string_view body = file.substr(at + 8, size);
        if (crc32_of(file.substr(at + 4, std::size_t{4} + size)) != big_endian_at(file, at + 8 + size))
            refuse_png(name, fmt::format("a wrong checksum of the chunk at byte {}", at),
                       "the PNG file is damaged");
        if (kind == "PLTE")
            content.palette = body;
        if (kind == "tRNS")
            content.alphas = body;
        if (kind == "IDAT") {
            if (++chunks == 2)
                content.joined = content.pixels;
            if (chunks >= 2)
                content.joined += body;
            content.pixels = body;
        }
        if (kind == "IEND")
            break;
        at += chunk_bytes + size;
    }
    if (chunks >= 2)
        content.pixels = content.joined;
    return content;
}

/// Decompresses the pixels into this room.
void unpack_pixels(std::string_view stream, std::span<std::byte> room, const std::string& name) {
    constexpr std::size_t around = 6; // two bytes of zlib before the stream, and its checksum
    const bool zlib = stream.size() > around && (static_cast<unsigned char>(stream[0]) & 0xfU) == 8 &&
                      (static_cast<unsigned char>(stream[1]) & 0x20U) == 0;
    if (!zlib)
        refuse_png(name, "no compressed pixels", "a zlib stream holds them");
    switch (inflate(stream.substr(2, stream.size() - around), room)) {
    case Inflated::whole:
        break;
    case Inflated::too_short:
        refuse_png(name, "fewer pixels than its header has", "the PNG file is damaged");
    case Inflated::too_long:
        refuse_png(name, "more pixels than its header has", "the PNG file is damaged");
    case Inflated::broken:
        refuse_png(name, "compressed pixels that are damaged", "they must be a Deflate stream");
    }
    const std::string_view bytes(reinterpret_cast<const char*>(room.data()), room.size()); // NOLINT
    if (adler32_of(bytes) != big_endian_at(stream, stream.size() - 4))
        refuse_png(name, "a wrong checksum of the pixels", "the PNG file is damaged");
}

unsigned nearest_of(unsigned left, unsigned up, unsigned corner) {
    const int estimate = static_cast<int>(left) + static_cast<int>(up) - static_cast<int>(corner);
    const int to_left = std::abs(estimate - static_cast<int>(left));
    const int to_up = std::abs(estimate - static_cast<int>(up));
    const int to_corner = std::abs(estimate - static_cast<int>(corner));
    return to_left <= to_up && to_left <= to_corner ? left : to_up <= to_corner ? up : corner;
}

/// Undoes the filter of a row, whose first byte is at `step`: those before are 0.
void undo_filter(unsigned filter, std::uint8_t* row, const std::uint8_t* above, std::size_t size,
                 std::size_t step) {
    const auto add = [](std::uint8_t& byte, unsigned more) {
        byte = static_cast<std::uint8_t>(byte + more);
    };
    const auto left = [&](std::size_t i) -> unsigned {
        return i < step ? 0 : row[i - step];
    };
    const auto corner = [&](std::size_t i) -> unsigned {
        return i < step ? 0 : above[i - step];
    };
    switch (filter) {
    case 1:
        for (std::size_t i = step; i < size; ++i)
            add(row[i], row[i - step]);
        break;
    case 2:
        for (std::size_t i = 0; i < size; ++i)
            add(row[i], above[i]);
        break;
    case 3:
        for (std::size_t i = 0; i < size; ++i)
            add(row[i], (left(i) + above[i]) / 2);
        break;
    case 4:
        for (std::size_t i = 0; i < size; ++i)
            add(row[i], nearest_of(left(i), above[i], corner(i)));
        break;
    default:
        break;
    }
}

/// Adds a row of bytes, each of which is a pixel.
void add_bytes(const std::uint8_t* row, std::size_t size, RunBuilder& image) {
    for (std::size_t i = 0; i < size;) {
        const std::uint8_t value = row[i];
        const std::uint64_t eight = 0x0101010101010101U * value;
        std::size_t end = i + 1;
        for (std::uint64_t next = 0; end + sizeof next <= size; end += sizeof next) {
            std::memcpy(&next, row + end, sizeof next);
            if (next != eight)
                break;
        }
        while (end < size && row[end] == value)
            ++end;
        image.add(value, end - i);
        i = end;
    }
}

/// Adds rows of pixels of one kind to an image.
class PngRows {
  public:
    PngRows(const PngHead& head, std::string_view palette, std::string_view alphas)
        : head_(head), pixels_(head.width) {
        for (std::size_t i = 0; i + 2 < palette.size() && i / 3 < greys_.size(); i += 3)
            greys_[i / 3] =
                std::max({static_cast<std::uint8_t>(palette[i]), static_cast<std::uint8_t>(palette[i + 1]),
                          static_cast<std::uint8_t>(palette[i + 2])});
        if (head.colour == PngColour::palette && !alphas.empty()) {
            greys_.fill(255);
            std::copy_n(alphas.begin(), std::min(alphas.size(), greys_.size()), greys_.begin());
        }
        if (head.colour == PngColour::grey)
            for (unsigned v = 0; v < 1U << std::min(head.bits, 8U); ++v)
                greys_[v] = static_cast<std::uint8_t>(v * 255 / ((1U << head.bits) - 1));
    }

    void add(const std::uint8_t* row, RunBuilder& image) {
        const bool as_they_are = head_.bits == 8 && (head_.colour == PngColour::grey ||
                                                     (head_.channels == 3 && image.width() != head_.width));
        if (as_they_are) {
            add_bytes(row, static_cast<std::size_t>(head_.row_bytes()), image);
            return;
        }
        for (std::size_t i = 0; i < head_.width; ++i)
            pixels_[i] = head_.channels == 1 ? greys_[sample(row, i)] : grey_of(row + i * head_.channels);
        add_bytes(pixels_.data(), pixels_.size(), image);
    }

  private:
    [[nodiscard]] unsigned sample(const std::uint8_t* row, std::size_t i) const {
        const std::size_t bit = i * head_.bits;
        return static_cast<unsigned>(row[bit / 8]) >> (8 - head_.bits - bit % 8) & ((1U << head_.bits) - 1);
    }
    [[nodiscard]] std::uint8_t grey_of(const std::uint8_t* pixel) const {
        const unsigned value =
            head_.channels >= 3 ? std::max({pixel[0], pixel[1], pixel[2]}) : unsigned{pixel[0]};
        const bool alpha = head_.channels == 2 || head_.channels == 4;
        return static_cast<std::uint8_t>(alpha ? value * pixel[head_.channels - 1] / 255 : value);
    }

    PngHead head_;
    std::vector<std::uint8_t> pixels_;
    std::array<std::uint8_t, 256> greys_{};
};

/// Memory that counts until it is freed.
class CountedBytes {
  public:
    CountedBytes(std::uint64_t size, ReadLimits& limits, const std::string& name)
        : size_(size), limits_(limits) {
        limits.add_bytes(size, name);
        bytes_.reset(new std::byte[static_cast<std::size_t>(size)]); // NOLINT: not to be filled twice
    }
    CountedBytes(const CountedBytes&) = delete;
    CountedBytes& operator=(const CountedBytes&) = delete;
    ~CountedBytes() { limits_.give_back(0, size_); }
    [[nodiscard]] std::span<std::byte> span() { return {bytes_.get(), static_cast<std::size_t>(size_)}; }

  private:
    std::uint64_t size_;
    ReadLimits& limits_;
    std::unique_ptr<std::byte[]> bytes_; // NOLINT(modernize-avoid-c-arrays)
};

} // namespace

AlongXY<std::uint32_t> png_size(std::string_view file, const std::string& name) {
    const PngHead head = head_of(file, name);
    return {head.width, head.height};
}

void decode_png(std::string_view file, const std::string& name, RunBuilder& image, ReadLimits& limits) {
    const PngHead head = head_of(file, name);
    check_kind(head, name);
    const bool thirds = head.colour == PngColour::rgb && std::uint64_t{head.width} * 3 == image.width();
    if ((head.width != image.width() && !thirds) || head.height != image.height())
        refuse_png(name, fmt::format("an image of {} x {} pixels", head.width, head.height),
                   fmt::format("the display has {} x {}", image.width(), image.height()));
    const PngContent content = content_of(file, name);
    const std::uint64_t row_bytes = head.row_bytes();
    const std::uint64_t size = (row_bytes + 1) * head.height;
    if (size / most_inflation > content.pixels.size())
        refuse_png(name, fmt::format("{} bytes of compressed pixels", content.pixels.size()),
                   fmt::format("an image of {} x {} pixels takes more", head.width, head.height));
    CountedBytes unpacked(size, limits, name);
    unpack_pixels(content.pixels, unpacked.span(), name);
    const std::vector<std::uint8_t> none(static_cast<std::size_t>(row_bytes));
    auto* row = reinterpret_cast<std::uint8_t*>(unpacked.span().data()); // NOLINT
    const std::uint8_t* above = none.data();
    PngRows rows(head, content.palette, content.alphas);
    for (std::uint32_t r = 0; r < head.height; ++r) {
        constexpr unsigned last_filter = 4;
        if (*row > last_filter)
            refuse_png(name, fmt::format("the filter {} in row {}", *row, r), "0 to 4 are possible");
        undo_filter(*row, row + 1, above, static_cast<std::size_t>(row_bytes), head.step());
        rows.add(row + 1, image);
        above = row + 1;
        row += row_bytes + 1;
    }
}

} // namespace lamella
