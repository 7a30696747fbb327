#pragma once

// Compression of bytes that are given as runs of equal bytes.

#include "lamella/raster/image.hpp"

#include "container/byte_buffer.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace lamella {

/// Makes a zlib stream (RFC 1950) from runs. A run becomes a literal byte and copies at distance 1. Time and
/// memory do not depend on the length of runs, except those of the stream itself, which takes at least two
/// bits for 258 bytes.
///
/// An object makes one stream after the other. Equal bytes give equal streams, independent of their division
/// into calls.
class RunDeflater {
  public:
    /// Appends `count` bytes of one value.
    void put(std::uint8_t value, std::uint64_t count) {
        if (count == 0)
            return;
        for (std::uint64_t rest = count; rest > 0; rest -= std::min(rest, most_unreduced))
            add_to_checksum(value, std::min(rest, most_unreduced));
        if (value != value_) {
            end_run();
            value_ = value;
        }
        count_ += count;
    }

    /// Appends the pixels of a row, a byte each (see RowSink).
    void put(std::span<const PixelRun> row);

    /// Ends the stream and returns it. The view is valid until the next call.
    [[nodiscard]] std::string_view finish();

  private:
    /// A run should be small, because a block of an image has thousands of runs.
    struct Run {
        std::uint32_t count;
        std::uint8_t value;
    };

    /// The two sums of Adler-32. They are reduced at long intervals, before they can overflow.
    struct Checksum {
        std::uint64_t sum = 1;
        std::uint64_t sum_of_sums = 0;

        /// Adds n equal bytes v: the sum grows by n v, the sum of sums by n times the old sum and n (n + 1) /
        /// 2 times v.
        void add(std::uint8_t v, std::uint64_t n) noexcept {
            sum_of_sums += n * sum + n * (n + 1) / 2 * v;
            sum += n * v;
        }
    };
    void make_room_in_checksum(std::uint64_t n) noexcept {
        if (unreduced_ + n > most_unreduced)
            reduce_checksum();
        unreduced_ += n;
    }
    void add_to_checksum(std::uint8_t value, std::uint64_t n) noexcept {
        make_room_in_checksum(n);
        checksum_.add(value, n);
    }
    void reduce_checksum() noexcept;
    void end_run() {
        while (count_ > 0) {
            const std::uint64_t count = std::min(count_, longest_run);
            add_run({static_cast<std::uint32_t>(count), value_});
            count_ -= count;
        }
    }
    void add_run(const Run& run) {
        runs_[run_count_++] = run;
        if (run_count_ == most_runs)
            write_block(false);
    }
    void write_block(bool last);

    static constexpr std::uint64_t most_unreduced = 1 << 24;
    static constexpr std::size_t most_runs = 1 << 14; ///< of a block, so that its runs stay in the cache
    static constexpr std::uint64_t longest_run = std::uint64_t{1} << 31;

    std::vector<Run> runs_ = std::vector<Run>(most_runs);
    std::size_t run_count_ = 0;
    std::uint64_t count_ = 0; ///< of the run that is not yet in runs_
    std::uint8_t value_ = 0;
    Checksum checksum_;
    std::uint64_t unreduced_ = 0; ///< bytes added since checksum_ was reduced
    ByteBuffer stream_;
    std::uint64_t bits_ = 0; ///< not yet written
    unsigned bit_count_ = 0;
    bool begun_ = false;
};

} // namespace lamella
