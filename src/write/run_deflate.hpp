#pragma once

// Compression of bytes that come as runs of equal ones.

#include "write/byte_buffer.hpp"

#include <algorithm>
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
        for (std::uint64_t rest = count; rest > 0; rest -= std::min(rest, most_unreduced))
            add_to_checksum(value, std::min(rest, most_unreduced));
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

    // Adler-32 of n equal bytes v: the sum grows by n v, the sum of sums by n times the old sum and
    // n (n + 1) / 2 times v. Both are reduced now and then only, long before they overflow.
    void add_to_checksum(std::uint8_t value, std::uint64_t n) noexcept {
        if (unreduced_ + n > most_unreduced)
            reduce_checksum();
        unreduced_ += n;
        sum_of_sums_ += n * sum_ + n * (n + 1) / 2 * value;
        sum_ += n * value;
    }
    void reduce_checksum() noexcept;
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

    static constexpr std::uint64_t most_unreduced = 1 << 24;
    static constexpr std::size_t most_runs = 1 << 15; ///< of a block: these stay in the cache

    std::vector<Run> runs_;
    Run run_;
    std::uint64_t sum_ = 1; ///< the two halves of Adler-32, before they are reduced
    std::uint64_t sum_of_sums_ = 0;
    std::uint64_t unreduced_ = 0; ///< bytes that were added since
    ByteBuffer stream_;
    std::uint64_t bits_ = 0; ///< not yet written
    unsigned bit_count_ = 0;
    bool begun_ = false;
};

} // namespace lamella
