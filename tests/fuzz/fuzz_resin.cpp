// Any bytes as the images of a file for resin printers, behind its checksums and its large head. The first
// byte chooses the format, unless the target is for one of them. The rest is the code of the only layer; of
// PNG files, the rows before compression; of archives, their texts. The result is an error, or sound layers.

#include "archive.hpp"
#include "promises.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace {

using namespace lamella;
using fuzz::require;

constexpr std::uint32_t width = 11;
constexpr std::uint32_t height = 7;

std::string number(std::uint64_t value, int bytes, bool big) {
    std::string text;
    for (int i = 0; i < bytes; ++i)
        text += static_cast<char>(value >> (8 * (big ? bytes - 1 - i : i)));
    return text;
}

std::string single(float value, bool big) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return number(bits, 4, big);
}

std::string goo(std::string_view chunks) {
    std::string file(195477, '\0');
    const auto put = [&](std::size_t at, const std::string& bytes) {
        file.replace(at, bytes.size(), bytes);
    };
    put(0, std::string("V3.0\7\0\0\0DLP\0", 12));
    put(195310, number(1, 4, true) + number(width, 2, true) + number(height, 2, true));
    put(195470, number(195477, 4, true));
    unsigned sum = 0;
    for (const char chunk : chunks)
        sum += static_cast<unsigned char>(chunk);
    file += std::string(6, '\0') + single(0.05F, true) + std::string(54, '\0') + "\r\n";
    file += number(chunks.size() + 2, 4, true) + "\x55" + std::string(chunks);
    return file + static_cast<char>(~sum) + "\r\n" + std::string("\0\0\0\7\0\0\0DLP\0", 11);
}

std::string chitubox(std::uint32_t magic, std::uint32_t version, std::uint32_t sets, std::string_view code) {
    std::string file = number(magic, 4, false) + number(version, 4, false) + std::string(24, '\0');
    file += single(0.05F, false) + std::string(16, '\0') + number(width, 4, false) + number(height, 4, false);
    file += number(0, 4, false) + number(112, 4, false) + number(1, 4, false) + std::string(20, '\0');
    file += number(sets, 4, false) + std::string(16, '\0');
    for (std::uint32_t set = 0; set < sets; ++set)
        file += single(0.05F, false) + std::string(8, '\0') + number(112 + 36 * sets, 4, false) +
                number(code.size(), 4, false) + std::string(16, '\0');
    return file + std::string(code);
}

std::string anycubic(std::string_view code) {
    std::string file = std::string("ANYCUBIC\0\0\0\0", 12) + number(515, 4, false) + number(5, 4, false);
    file += number(48, 4, false) + std::string(12, '\0') + number(144, 4, false) + std::string(8, '\0');
    file += std::string("HEADER\0\0\0\0\0\0", 12) + number(80, 4, false) + single(50, false);
    file +=
        std::string(40, '\0') + number(width, 4, false) + number(height, 4, false) + std::string(28, '\0');
    file += std::string("LAYERDEF\0\0\0\0", 12) + number(36, 4, false) + number(1, 4, false);
    file += number(196, 4, false) + number(code.size(), 4, false) + std::string(12, '\0');
    return file + single(0.05F, false) + std::string(8, '\0') + std::string(code);
}

std::string chunk(const std::string& name, const std::string& content) {
    return number(content.size(), 4, true) + name + content + number(fuzz::checksum(name + content), 4, true);
}

/// A PNG file of the kind in the first byte, with these rows.
std::string png(std::string_view bytes) {
    constexpr char kinds[][2] = {{8, 0}, {1, 0}, {2, 0}, {4, 0}, {8, 2}, {8, 3}, {8, 4}, {8, 6}};
    const char* const kind = kinds[bytes.empty() ? 0 : static_cast<unsigned char>(bytes[0]) % 8];
    bytes.remove_prefix(bytes.empty() ? 0 : 1);
    std::string stream(compressBound(static_cast<uLong>(bytes.size())), '\0');
    uLongf size = stream.size();
    compress(reinterpret_cast<Bytef*>(stream.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
             static_cast<uLong>(bytes.size()));
    stream.resize(size);
    return "\x89PNG\r\n\x1a\n" +
           chunk("IHDR", number(width, 4, true) + number(height, 4, true) + std::string(kind, 2) +
                             std::string(3, '\0')) +
           chunk("PLTE", "\1\2\3\xff\xff\xff") + chunk("IDAT", stream) + chunk("IEND", "");
}

std::string archive(std::string_view name, std::string_view text, std::string_view image,
                    std::string_view rows) {
    fuzz::Archive zip;
    zip.add(name, text);
    zip.add(image, png(rows));
    return zip.take();
}

/// The text of an archive and the rows of its image, with a NUL between them.
std::string archive(std::string_view name, std::string_view image, std::string_view bytes) {
    const std::size_t end = std::min(bytes.find('\0'), bytes.size());
    return archive(name, bytes.substr(0, end), image, bytes.substr(std::min(end + 1, bytes.size())));
}

std::string file_of(unsigned format, std::string_view bytes) {
    switch (format % 9) {
    case 0:
        return goo(bytes);
    case 1:
        return chitubox(0x12FD0086, 3, 1, bytes);
    case 2:
        return chitubox(0x12FD0019, 2, 1, bytes);
    case 3:
        return chitubox(0x12FD0019, 2, 4, bytes);
    case 4:
        return anycubic(bytes);
    case 5:
        return archive("run.gcode",
                       ";layerHeight:0.05\n;resolutionX:11\n;resolutionY:7\n;machineX:11\n;machineY:7\n",
                       "1.png", bytes);
    case 6:
        return archive("run.gcode", "1.png", bytes);
    case 7:
        return archive("plate.json", "1.png", bytes);
    default:
        return archive("config.ini", "00000.png", bytes);
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0)
        return 0;
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
#ifdef LAMELLA_FUZZ_FORMAT
    const unsigned format = LAMELLA_FUZZ_FORMAT;
#else
    const unsigned format = data[0];
#endif
    const std::string file = file_of(format, bytes.substr(1));
    try {
        const LayerFile layers =
            read_layers(std::as_bytes(std::span(file)), "fuzz", {.max_memory = 100'000'000}, {.threads = 1});
        for (std::size_t i = 0; i < layers.planes.size(); ++i) {
            const Plane plane = layers.plane(i);
            require(plane.image && !plane.image->runs.empty());
            require(plane.image->runs.back().end == plane.image->pixels());
        }
        fuzz::require_sound(layers);
    } catch (const Error& error) {
        require(error.kind() == ErrorKind::input || error.kind() == ErrorKind::limit);
    }
    return 0;
}
