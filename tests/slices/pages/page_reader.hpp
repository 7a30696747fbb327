#pragma once

// Reads pages as a browser's scripts do.

#include "lamella/core/point.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// The elements with data, as in the page.
struct ReadPage {
    std::map<std::string, std::string> json; ///< by the element's id
    std::vector<std::string> data;           ///< decompressed
    std::size_t scripts = 0;                 ///< elements of any kind that begin with <script
};

inline std::string base64_bytes(std::string_view text) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    unsigned count = 0;
    for (const char c : text) {
        const std::size_t digit = digits.find(c);
        if (digit == std::string_view::npos)
            break; // padding
        bits = bits << 6U | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes += static_cast<char>(bits >> count & 0xFFU);
        }
    }
    return bytes;
}

inline std::string raw_inflated(std::string_view packed) {
    z_stream stream{};
    EXPECT_EQ(inflateInit2(&stream, -15), Z_OK);
    std::string bytes;
    std::array<char, 4096> piece{};
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    int status = Z_OK;
    while (status == Z_OK) {
        stream.next_out = reinterpret_cast<Bytef*>(piece.data());
        stream.avail_out = static_cast<uInt>(piece.size());
        status = inflate(&stream, Z_NO_FLUSH);
        bytes.append(piece.data(), piece.size() - stream.avail_out);
    }
    EXPECT_EQ(status, Z_STREAM_END);
    EXPECT_EQ(stream.avail_in, 0U);
    inflateEnd(&stream);
    return bytes;
}

/// Divides a page by the HTML standard: an element ends at the first "</script".
inline ReadPage read_page(std::string_view html) {
    ReadPage page;
    constexpr std::string_view open = "<script";
    for (std::size_t at = html.find(open); at != std::string_view::npos; at = html.find(open, at)) {
        ++page.scripts;
        const std::size_t text = html.find('>', at) + 1;
        const std::string_view tag = html.substr(at, text - at);
        const std::size_t end = html.find("</script", text);
        const std::string_view content = html.substr(text, end - text);
        if (const std::size_t id = tag.find("id=\""); id != std::string_view::npos)
            page.json[std::string(tag.substr(id + 4, tag.find('"', id + 4) - id - 4))] = content;
        else if (tag.find("class=\"data\"") != std::string_view::npos)
            page.data.push_back(raw_inflated(base64_bytes(content)));
        at = end;
    }
    return page;
}

/// The numbers of one element of data.
class PageNumbers {
  public:
    explicit PageNumbers(std::string_view bytes) : bytes_(bytes) {}

    std::uint64_t next() {
        std::uint64_t value = 0;
        for (unsigned shift = 0;; shift += 7) {
            if (at_ >= bytes_.size()) {
                ADD_FAILURE() << "the data end too early";
                return 0;
            }
            const auto byte = static_cast<unsigned char>(bytes_[at_++]);
            value |= std::uint64_t{byte & 0x7FU} << shift;
            if (byte < 0x80)
                return value;
        }
    }
    std::int64_t next_signed() {
        const std::uint64_t value = next();
        return static_cast<std::int64_t>(value >> 1U) ^ -static_cast<std::int64_t>(value & 1U);
    }
    [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

  private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

struct PageContour {
    bool closed = true;
    std::vector<Point2> points;
};

struct PagePart {
    std::vector<PageContour> contours;
    std::vector<Point2> hatches;
};

struct PageLayer {
    std::vector<PagePart> parts;
    std::vector<Point2> crossings;
};

/// Returns the layer of one element of data, in mm.
inline PageLayer page_layer(std::string_view bytes, std::size_t parts, double step,
                            const std::array<double, 2>& origin) {
    PageNumbers numbers(bytes);
    struct Place {
        std::int64_t x = 0;
        std::int64_t y = 0;
    };
    const auto walk = [&](Place& at) -> Point2 {
        at.x += numbers.next_signed();
        at.y += numbers.next_signed();
        return {(static_cast<double>(at.x) + origin[0]) * step,
                (static_cast<double>(at.y) + origin[1]) * step};
    };
    PageLayer layer;
    for (std::size_t p = 0; p < parts; ++p) {
        PagePart part;
        const std::uint64_t rings = numbers.next();
        const std::uint64_t contours = rings + numbers.next();
        const std::uint64_t hatches = numbers.next();
        Place first;
        for (std::uint64_t c = 0; c < contours; ++c) {
            PageContour contour{.closed = c < rings, .points = {}};
            const std::uint64_t points = numbers.next();
            contour.points.push_back(walk(first));
            Place at = first;
            for (std::uint64_t i = 1; i < points; ++i)
                contour.points.push_back(walk(at));
            part.contours.push_back(contour);
        }
        Place at;
        for (std::uint64_t i = 0; i < 2 * hatches; ++i)
            part.hatches.push_back(walk(at));
        layer.parts.push_back(part);
    }
    Place at;
    for (std::uint64_t n = numbers.next(); n > 0; --n)
        layer.crossings.push_back(walk(at));
    EXPECT_TRUE(numbers.at_end());
    return layer;
}

} // namespace lamella
