#include "slices/images/preview.hpp"

#include <cstddef>

namespace lamella {

namespace {

/// Returns a colour of a pixel before black, with this number of bits.
unsigned before_black(const std::uint8_t* pixel, std::size_t colour, unsigned bits) {
    return unsigned{pixel[colour]} * pixel[3] / 255 >> (8 - bits);
}

} // namespace

std::string preview_565(const ColourImage& whole, std::uint32_t width, std::uint32_t height,
                        ByteOrder order) {
    const ColourImage image = fitted(whole, width, height);
    BinaryFields pixels(order);
    for (std::size_t i = 0; i < image.values.size(); i += 4) {
        const std::uint8_t* const pixel = &image.values[i];
        pixels.u16(before_black(pixel, 0, 5) << 11U | before_black(pixel, 1, 6) << 5U |
                   before_black(pixel, 2, 5));
    }
    return std::string(pixels.view());
}

std::string preview_runs(const ColourImage& whole, std::uint32_t width, std::uint32_t height) {
    constexpr std::size_t longest = 4095;
    constexpr unsigned run_flag = 0x20;
    const ColourImage image = fitted(whole, width, height);
    BinaryFields words(ByteOrder::little);
    unsigned colour = 0;
    std::size_t count = 0;
    const auto put = [&] {
        if (count == 1)
            words.u16(colour);
        if (count > 1)
            words.u16(colour | run_flag).u16(0x3000 | (count - 1));
        count = 0;
    };
    for (std::size_t i = 0; i < image.values.size(); i += 4) {
        const std::uint8_t* const pixel = &image.values[i];
        const unsigned next =
            before_black(pixel, 0, 5) << 11U | before_black(pixel, 1, 5) << 6U | before_black(pixel, 2, 5);
        if (next != colour || count == longest)
            put();
        colour = next;
        ++count;
    }
    put();
    return std::string(words.view());
}

} // namespace lamella
