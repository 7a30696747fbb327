#include "container/deflate.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <new>

namespace lamella {

namespace {

// zlib's counters have 32 bits.
constexpr std::size_t most_at_once = std::size_t{1} << 30;

const Bytef* input(std::string_view bytes) {
    return reinterpret_cast<const Bytef*>(bytes.data());
}

} // namespace

struct Deflater::State {
    z_stream stream{};
};

std::uint32_t crc32_joined(std::uint32_t first, std::uint32_t second, std::uint64_t second_size) noexcept {
    return static_cast<std::uint32_t>(crc32_combine(first, second, static_cast<z_off_t>(second_size)));
}

Deflater::Deflater() : state_(std::make_unique<State>()) {
    constexpr int raw_with_full_window = -15;
    constexpr int most_memory = 9;
    if (deflateInit2(&state_->stream, Z_BEST_SPEED, Z_DEFLATED, raw_with_full_window, most_memory,
                     Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::bad_alloc();
}

Deflater::~Deflater() {
    deflateEnd(&state_->stream);
}

void Deflater::append_chunk(std::string_view bytes, std::string& out) {
    z_stream& stream = state_->stream;
    for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), most_at_once))) {
        const std::string_view part = bytes.substr(0, most_at_once);
        deflateReset(&stream);
        // zlib only reads the input, but takes a pointer to mutable bytes.
        stream.next_in = const_cast<Bytef*>(input(part));
        stream.avail_in = static_cast<uInt>(part.size());
        const std::size_t begin = out.size();
        // deflateBound includes the end of a stream, but not the few bytes of a flush.
        constexpr std::size_t most_of_flush = 16;
        out.resize(begin + deflateBound(&stream, static_cast<uLong>(part.size())) + most_of_flush);
        stream.next_out = reinterpret_cast<Bytef*>(out.data() + begin);
        stream.avail_out =
            static_cast<uInt>(std::min<std::size_t>(out.size() - begin, std::numeric_limits<uInt>::max()));
        deflate(&stream, Z_SYNC_FLUSH);
        out.resize(reinterpret_cast<char*>(stream.next_out) - out.data());
    }
}

std::string deflated(std::string_view bytes) {
    std::string stream;
    // zlib would initialise several hundred kilobytes, and cannot shorten an input of so few bytes.
    constexpr std::size_t few = 64;
    if (bytes.size() <= few) {
        constexpr char last_and_stored = 1;
        const auto size = static_cast<char>(bytes.size());
        for (const char c : {last_and_stored, size, '\0', static_cast<char>(~size), '\xff'})
            stream += c;
        return stream.append(bytes);
    }
    Deflater().append_chunk(bytes, stream);
    stream += deflate_end;
    return stream;
}

} // namespace lamella
