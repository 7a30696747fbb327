#pragma once

// Compression of bytes that come as runs of equal ones.

#include "write/byte_buffer.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace lamella {

/// Makes a zlib stream (RFC 1950) of runs: each becomes its byte once and copies of the byte before it, in
/// Deflate's own codes. The time and the memory that it takes do not depend on how long runs are, but for the
/// stream itself, which takes two bits or more for 258 bytes.
///
/// One object makes one stream after the other. Equal bytes give equal streams, however they are divided.
class RunDeflater {
  public:
    /// Appends `count` bytes of one value.
    void put(std::uint8_t value, std::uint64_t count) {
        if (count == 0)
            return;
        add_to_checksum(value, count);
        if (value != run_.value || run_.count == 0) {
            end_run();
            run_.value = value;
        }
        run_.count += count;
    }

    /// Ends the stream. It lives until the next call.
    [[nodiscard]] std::string_view finish();

  private:
    struct Run {
        std::uint64_t count = 0;
        std::uint8_t value = 0;
    };

    void add_to_checksum(std::uint8_t value, std::uint64_t count) noexcept;
    void end_run() {
        if (run_.count == 0)
            return;
        runs_.push_back(run_);
        run_.count = 0;
        if (runs_.size() == most_runs)
            write_block(false);
    }
    void begin_stream();
    void write_block(bool last);

    static constexpr std::size_t most_runs = 1 << 15; ///< of a block: these stay in the cache

    std::vector<Run> runs_;
    Run run_;
    std::uint32_t sum_ = 1; ///< the two halves of Adler-32
    std::uint32_t sum_of_sums_ = 0;
    ByteBuffer stream_;
    std::uint64_t bits_ = 0; ///< not yet written
    unsigned bit_count_ = 0;
    bool begun_ = false;
};

} // namespace lamella
