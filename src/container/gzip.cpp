#include "container/gzip.hpp"

#include "lamella/core/error.hpp"

#include "container/deflate.hpp"
#include "container/inflate.hpp"
#include "core/lower_case.hpp"
#include "system/growing_memory.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <string_view>

namespace lamella {

namespace {

/// zlib's state for members with header and checksum.
class Inflater {
  public:
    Inflater() {
        constexpr int gzip_window = 15 + 16;
        if (inflateInit2(&stream_, gzip_window) != Z_OK)
            throw std::bad_alloc();
    }
    ~Inflater() { inflateEnd(&stream_); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    struct Step {
        std::size_t taken; ///< compressed bytes consumed
        std::size_t made;  ///< bytes written
        int code;          ///< status returned by zlib
    };

    /// Decompresses as much as is available and fits. Both spans must be smaller than 4 GiB.
    [[nodiscard]] Step unpack(std::span<const std::byte> compressed, std::span<std::byte> room) {
        // zlib only reads from this pointer, but its type lacks const.
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(compressed.data()));
        stream_.avail_in = static_cast<uInt>(compressed.size());
        stream_.next_out = reinterpret_cast<Bytef*>(room.data());
        stream_.avail_out = static_cast<uInt>(room.size());
        const int code = inflate(&stream_, Z_NO_FLUSH);
        return {compressed.size() - stream_.avail_in, room.size() - stream_.avail_out, code};
    }

    /// Prepares for the next member.
    void start_again() {
        if (inflateReset(&stream_) != Z_OK)
            throw std::bad_alloc();
    }

    [[nodiscard]] const char* message() const {
        return stream_.msg == nullptr ? "no such data" : stream_.msg;
    }

  private:
    z_stream stream_{};
};

} // namespace

bool is_gzip(std::span<const std::byte> bytes) noexcept {
    return bytes.size() >= 3 && bytes[0] == std::byte{0x1f} && bytes[1] == std::byte{0x8b} &&
           bytes[2] == std::byte{8};
}

ByteSource unpacked(const ByteSource& source, std::uint64_t max_bytes, const Execution& execution) {
    if (!is_gzip(source.bytes))
        return source;
    // Small enough for zlib's counters and for prompt cancellation.
    constexpr std::size_t step = std::size_t{8} << 20;
    const std::uint64_t most = max_bytes != 0 ? max_bytes : usual_most_unpacked(source.bytes.size());
    Inflater inflater;
    const auto memory = std::make_shared<GrowingMemory>();
    std::size_t at = 0;
    const auto fail = [&](const std::string& what) {
        throw Error(ErrorKind::input, fmt::format("{}: byte {}: {}", source.name, at, what));
    };
    for (bool whole = false; !whole;) {
        if (execution.cancelled())
            throw Error(ErrorKind::cancelled, "cancelled");
        const std::span<std::byte> all_room = memory->room();
        const std::span<std::byte> room = all_room.first(std::min(step, all_room.size()));
        const auto [taken, made, code] =
            inflater.unpack(source.bytes.subspan(at, std::min(step, source.bytes.size() - at)), room);
        at += taken;
        memory->use(made);
        if (memory->size() > most)
            throw Error(
                ErrorKind::limit,
                max_bytes != 0
                    ? fmt::format("{}: unpacks to more than the {} bytes that `max_memory` leaves it",
                                  source.name, most)
                    : fmt::format(
                          "{}: unpacks to more than {} bytes, {} times its size; `max_memory` allows more",
                          source.name, most, most / source.bytes.size()));
        if (code == Z_STREAM_END) {
            const auto rest = source.bytes.subspan(at);
            // Some programs pad the last block with zeros.
            whole =
                std::all_of(rest.begin(), rest.end(), [](std::byte byte) { return byte == std::byte{0}; });
            if (!whole && !is_gzip(rest))
                fail("something else follows the gzip data, expected the end of the file");
            inflater.start_again();
        } else if (code == Z_MEM_ERROR) {
            throw std::bad_alloc();
        } else if (code == Z_BUF_ERROR || (code == Z_OK && at == source.bytes.size() && made < room.size())) {
            fail("the file ends within its gzip data; it is cut off");
        } else if (code != Z_OK) {
            fail(fmt::format("the gzip data are damaged ({}); fetch the file once more", inflater.message()));
        }
    }
    if (memory->size() == 0)
        fail("the gzip file is empty, expected a file with content");
    memory->trim();
    return {source.name, memory->bytes(), memory};
}

std::string first_inflated(std::string_view compressed, std::size_t most) {
    // libdeflate returns all bytes or none.
    z_stream stream{};
    constexpr int raw_window = -15;
    if (inflateInit2(&stream, raw_window) != Z_OK)
        throw std::bad_alloc();
    std::string bytes(most, '\0');
    stream.next_in =
        reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data())); // zlib only reads from it
    stream.avail_in =
        static_cast<uInt>(std::min<std::size_t>(compressed.size(), std::numeric_limits<uInt>::max()));
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_out = static_cast<uInt>(most);
    static_cast<void>(::inflate(&stream, Z_SYNC_FLUSH));
    bytes.resize(most - stream.avail_out);
    inflateEnd(&stream);
    return bytes;
}

bool has_gzip_extension(std::string_view path) noexcept {
    constexpr std::string_view extension = ".gz";
    return path.size() >= extension.size() &&
           begins_with_keyword(path.substr(path.size() - extension.size()), extension);
}

std::string gzip_member(std::string_view bytes) {
    if (bytes.empty())
        return {};
    // Deflate; no flags, no time, no level, and an unknown system, so that equal bytes give equal members.
    std::string member("\x1f\x8b\x08\x00\x00\x00\x00\x00\x00\xff", 10);
    member += deflated(bytes);
    for (const std::uint32_t value : {crc32_of(bytes), static_cast<std::uint32_t>(bytes.size())})
        for (const int shift : {0, 8, 16, 24})
            member += static_cast<char>(value >> shift & 0xff);
    return member;
}

} // namespace lamella
