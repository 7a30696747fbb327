#include "container/inflate.hpp"

#include "system/memory_size.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <memory>
#include <new>

namespace lamella {

std::uint32_t crc32_of(std::string_view bytes) noexcept {
    return libdeflate_crc32(0, bytes.data(), bytes.size());
}

std::uint32_t adler32_of(std::string_view bytes) noexcept {
    constexpr std::uint32_t of_nothing = 1;
    return libdeflate_adler32(of_nothing, bytes.data(), bytes.size());
}

std::uint64_t usual_most_unpacked(std::uint64_t compressed_bytes) {
    constexpr std::uint64_t least = std::uint64_t{64} << 20;
    constexpr std::uint64_t ratio = 64;
    return std::min(compressed_bytes > least / ratio ? ratio * compressed_bytes : least, usual_memory());
}

Inflated inflate(std::string_view compressed, std::span<std::byte> room) {
    const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> decompressor(
        libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
    if (!decompressor)
        throw std::bad_alloc();
    std::byte nowhere{}; // libdeflate needs a valid pointer, even if no byte is expected
    std::size_t read = 0;
    std::size_t written = 0;
    switch (libdeflate_deflate_decompress_ex(decompressor.get(), compressed.data(), compressed.size(),
                                             room.empty() ? &nowhere : room.data(), room.size(), &read,
                                             &written)) {
    case LIBDEFLATE_SUCCESS:
        if (read != compressed.size())
            return Inflated::broken;
        return written == room.size() ? Inflated::whole : Inflated::too_short;
    case LIBDEFLATE_INSUFFICIENT_SPACE:
        return Inflated::too_long;
    default:
        return Inflated::broken;
    }
}

} // namespace lamella
