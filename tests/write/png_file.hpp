#pragma once

// PNG files as read by an independent reader, libpng.

#include <png.h>

#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace lamella {

struct PngFile {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    int bits = 0;
    int colour_type = 0; ///< 0 is grey
    bool interlaced = false;
    std::vector<std::uint8_t> values;
    std::string error; ///< warnings, too
};

namespace detail {

struct PngSource {
    const std::string* bytes;
    std::size_t at = 0;
    std::string error = {};
};

inline void png_source_read(png_structp png, png_bytep out, png_size_t size) {
    auto* source = static_cast<PngSource*>(png_get_io_ptr(png));
    if (source->bytes->size() - source->at < size)
        png_error(png, "the file ends early");
    std::memcpy(out, source->bytes->data() + source->at, size);
    source->at += size;
}

inline void png_source_warn(png_structp png, png_const_charp text) {
    static_cast<PngSource*>(png_get_error_ptr(png))->error += text;
}

[[noreturn]] inline void png_source_fail(png_structp png, png_const_charp text) {
    png_source_warn(png, text);
    png_longjmp(png, 1);
}

} // namespace detail

inline PngFile read_png(const std::string& bytes) {
    PngFile file;
    detail::PngSource source{&bytes};
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, detail::png_source_fail,
                                             detail::png_source_warn);
    png_infop info = png_create_info_struct(png);
    if (setjmp(png_jmpbuf(png)) == 0) {
        png_set_read_fn(png, &source, detail::png_source_read);
        png_read_info(png, info);
        file.width = png_get_image_width(png, info);
        file.height = png_get_image_height(png, info);
        file.bits = png_get_bit_depth(png, info);
        file.colour_type = png_get_color_type(png, info);
        file.interlaced = png_get_interlace_type(png, info) != PNG_INTERLACE_NONE;
        const std::size_t row_bytes = png_get_rowbytes(png, info);
        file.values.resize(row_bytes * file.height);
        for (std::uint32_t r = 0; r < file.height; ++r)
            png_read_row(png, file.values.data() + r * row_bytes, nullptr);
        png_read_end(png, nullptr);
        if (source.at != bytes.size())
            source.error += "bytes after the end";
    }
    png_destroy_read_struct(&png, &info, nullptr);
    file.error = source.error;
    return file;
}

} // namespace lamella
