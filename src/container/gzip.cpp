#include "container/gzip.hpp"

#include "lamella/core/error.hpp"

#include "container/growing_memory.hpp"
#include "container/inflate.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <memory>
#include <new>

namespace lamella {

namespace {

/// zlib's state, for members with head and checksum.
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

    z_stream& operator*() { return stream_; }
    z_stream* operator->() { return &stream_; }

  private:
    z_stream stream_{};
};

} // namespace

bool is_gzip(std::span<const std::byte> bytes) noexcept {
    return bytes.size() >= 3 && bytes[0] == std::byte{0x1f} && bytes[1] == std::byte{0x8b} &&
           bytes[2] == std::byte{8};
}

ByteSource unpack_gzip(const ByteSource& packed, std::uint64_t max_bytes, const std::stop_token& cancel) {
    // Small enough for zlib's counters, and for a look at `cancel` now and then.
    constexpr std::size_t step = std::size_t{8} << 20;
    const std::uint64_t most = max_bytes != 0 ? max_bytes : usual_most_unpacked(packed.bytes.size());
    Inflater inflater;
    const auto unpacked = std::make_shared<GrowingMemory>();
    std::size_t at = 0;
    const auto fail = [&](const std::string& what) {
        throw Error(ErrorKind::input, fmt::format("{}: byte {}: {}", packed.name, at, what));
    };
    for (bool whole = false; !whole;) {
        if (cancel.stop_requested())
            throw Error(ErrorKind::cancelled, "cancelled");
        const std::size_t given = std::min(step, packed.bytes.size() - at);
        const std::span<std::byte> room = unpacked->room();
        const std::size_t offered = std::min(step, room.size());
        // zlib reads from this pointer only; its type is older than const.
        inflater->next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(packed.bytes.data() + at));
        inflater->avail_in = static_cast<uInt>(given);
        inflater->next_out = reinterpret_cast<Bytef*>(room.data());
        inflater->avail_out = static_cast<uInt>(offered);
        const int code = inflate(&*inflater, Z_NO_FLUSH);
        at += given - inflater->avail_in;
        unpacked->use(offered - inflater->avail_out);
        if (unpacked->size() > most)
            throw Error(
                ErrorKind::limit,
                max_bytes != 0
                    ? fmt::format("{}: unpacks to more than the {} bytes of --max-memory", packed.name, most)
                    : fmt::format(
                          "{}: unpacks to more than {} bytes, {} times its size; --max-memory allows more",
                          packed.name, most, most / packed.bytes.size()));
        if (code == Z_STREAM_END) {
            const auto rest = packed.bytes.subspan(at);
            // Some programs fill up the last block with zeros.
            whole = std::ranges::all_of(rest, [](std::byte byte) { return byte == std::byte{0}; });
            if (!whole && !is_gzip(rest))
                fail("something else follows what is packed with gzip, expected the end of the file");
            if (!whole && inflateReset(&*inflater) != Z_OK)
                throw std::bad_alloc();
        } else if (code == Z_MEM_ERROR) {
            throw std::bad_alloc();
        } else if (code == Z_BUF_ERROR ||
                   (code == Z_OK && at == packed.bytes.size() && inflater->avail_out != 0)) {
            fail("the file ends before what is packed with gzip in it; it is cut off");
        } else if (code != Z_OK) {
            fail(fmt::format("what is packed with gzip is broken ({}); fetch the file once more",
                             inflater->msg == nullptr ? "no such data" : inflater->msg));
        }
    }
    if (unpacked->size() == 0)
        fail("nothing is packed in it, expected a file with content");
    unpacked->trim();
    return {packed.name, unpacked->bytes(), unpacked};
}

} // namespace lamella
