#include "slices/images/run_deflate.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <span>

namespace lamella {

namespace {

// Names and numbers follow RFC 1951.

constexpr std::size_t literals = 256;
constexpr std::size_t end_of_block = 256;
constexpr std::size_t symbols = 286;
constexpr unsigned longest_code = 15;
constexpr unsigned longest_code_of_lengths = 7;
constexpr std::uint64_t longest_copy = 258;
constexpr std::uint64_t shortest_copy = 3;
constexpr std::size_t longest_copy_symbol = 285;

struct CopyCode {
    std::uint16_t symbol = 0;
    std::uint8_t extra = 0; ///< number of following bits
    std::uint8_t bits = 0;
};

/// Codes by length of a copy. Eight lengths have a symbol of their own. For longer copies, four symbols each
/// represent twice as many lengths as the four symbols before.
constexpr std::array<CopyCode, longest_copy + 1> copy_codes = [] {
    std::array<CopyCode, longest_copy + 1> codes{};
    for (unsigned length = shortest_copy; length < longest_copy; ++length) {
        const auto n = static_cast<unsigned>(length - shortest_copy);
        const unsigned extra = n < 8 ? 0 : static_cast<unsigned>(std::bit_width(n)) - 3;
        codes[length] = {static_cast<std::uint16_t>(257 + 4 * extra + (n >> extra)),
                         static_cast<std::uint8_t>(extra),
                         static_cast<std::uint8_t>(n & ((1U << extra) - 1))};
    }
    codes[longest_copy] = {longest_copy_symbol, 0, 0};
    return codes;
}();

/// A run as symbols: literals, then copies of full length, then a copy of length `rest` if that is not 0. All
/// copies have distance 1.
struct Parts {
    std::uint64_t literals;
    std::uint64_t full;
    std::uint64_t rest;
};

Parts parts_of(std::uint64_t count) noexcept {
    if (count <= shortest_copy)
        return {count, 0, 0};
    const std::uint64_t full = (count - 1) / longest_copy;
    const std::uint64_t rest = (count - 1) % longest_copy;
    return rest < shortest_copy ? Parts{1 + rest, full, 0} : Parts{1, full, rest};
}

/// Runs of at most this length are a few literals, or one literal and one copy. Most runs are this short.
constexpr std::uint64_t longest_short_run = longest_copy + 1;

struct Code {
    std::uint16_t bits = 0; ///< first bit lowest
    std::uint8_t length = 0;
};

/// Returns Huffman codes of at most `longest` bits for these frequencies. Symbols with frequency 0 get no
/// code.
template <std::size_t n>
std::array<Code, n> huffman_codes(const std::array<std::uint64_t, n>& frequencies, unsigned longest) {
    std::array<std::uint16_t, n> order; // symbols that occur, rarest first
    std::size_t used = 0;
    for (std::size_t i = 0; i < n; ++i)
        if (frequencies[i] > 0)
            order[used++] = static_cast<std::uint16_t>(i);
    const std::span<std::uint16_t> leaves(order.data(), used);
    std::stable_sort(leaves.begin(), leaves.end(),
                     [&](auto a, auto b) { return frequencies[a] < frequencies[b]; });

    // Joins the two rarest nodes until a single node remains. Inner nodes are created in ascending order of
    // weight, so two queues suffice.
    std::array<std::uint64_t, 2 * n> weight{};
    std::array<std::uint16_t, 2 * n> parent{};
    for (std::size_t i = 0; i < used; ++i)
        weight[i] = frequencies[leaves[i]];
    std::size_t leaf = 0;
    std::size_t inner = used;
    std::size_t nodes = used;
    const auto rarest = [&] {
        return leaf < used && (inner == nodes || weight[leaf] <= weight[inner]) ? leaf++ : inner++;
    };
    for (; nodes + 1 < 2 * used; ++nodes) {
        const std::size_t a = rarest();
        const std::size_t b = rarest();
        weight[nodes] = weight[a] + weight[b];
        parent[a] = parent[b] = static_cast<std::uint16_t>(nodes);
    }

    // Counts the codes of each length, then enforces the limit. A code that is too long moves up beside a
    // shorter code, which becomes longer by one bit.
    std::array<std::uint16_t, 2 * n> depth{};
    std::array<std::uint32_t, longest_code + 2> of_length{};
    for (std::size_t i = nodes - 1; i-- > 0;) {
        depth[i] = static_cast<std::uint16_t>(depth[parent[i]] + 1);
        if (i < used)
            ++of_length[std::min<unsigned>(depth[i], longest)];
    }
    std::uint64_t taken = 0;
    for (unsigned length = 1; length <= longest; ++length)
        taken += std::uint64_t{of_length[length]} << (longest - length);
    for (; taken > std::uint64_t{1} << longest; --taken) {
        unsigned shorter = longest - 1;
        while (of_length[shorter] == 0)
            --shorter;
        --of_length[shorter];
        of_length[shorter + 1] += 2;
        --of_length[longest];
    }

    std::array<Code, n> codes{};
    std::size_t next = 0;
    for (unsigned length = longest; length > 0; --length)
        for (std::uint32_t i = 0; i < of_length[length]; ++i)
            codes[leaves[next++]].length = static_cast<std::uint8_t>(length);
    unsigned value = 0;
    for (unsigned length = 1; length <= longest; ++length, value <<= 1)
        for (Code& code : codes)
            if (code.length == length) {
                for (unsigned bit = 0; bit < length; ++bit)
                    code.bits =
                        static_cast<std::uint16_t>(code.bits | ((value >> bit & 1) << (length - 1 - bit)));
                ++value;
            }
    return codes;
}

static_assert(std::endian::native == std::endian::little, "the lowest bits are those of the first byte");

/// Writes bits to memory that must be large enough, with some bytes to spare.
class BitWriter {
  public:
    BitWriter(char* out, std::uint64_t bits, unsigned count) : out_(out), bits_(bits), count_(count) {}

    /// Writes up to 56 bits. Eight bytes are always written, and the next call overwrites those that are not
    /// complete. This avoids a branch that a processor could mispredict.
    void put(std::uint64_t bits, unsigned count) {
        bits_ |= bits << count_;
        count_ += count;
        std::memcpy(out_, &bits_, sizeof bits_);
        out_ += count_ / 8;
        bits_ >>= count_ / 8 * 8;
        count_ %= 8;
    }
    void put(const Code& code) { put(code.bits, code.length); }
    /// Writes the same bits (at most 16) this many times.
    void put_repeated(std::uint64_t bits, unsigned count, std::uint64_t times) {
        std::uint64_t pattern = bits;
        std::uint64_t repeated = 1;
        for (; (repeated + 1) * count <= 32; ++repeated)
            pattern |= bits << repeated * count;
        for (; times >= repeated; times -= repeated)
            put(pattern, static_cast<unsigned>(repeated) * count);
        for (; times > 0; --times)
            put(bits, count);
    }

    [[nodiscard]] char* out() const noexcept { return out_; }
    [[nodiscard]] std::uint64_t bits() const noexcept { return bits_; }
    [[nodiscard]] unsigned count() const noexcept { return count_; }

  private:
    char* out_;
    std::uint64_t bits_;
    unsigned count_;
};

/// A symbol of the list of code lengths in the header of a block. It is a length from 0 to 15, or 18 for a
/// number of zeros that `bits` specifies.
struct LengthSymbol {
    std::uint8_t symbol;
    std::uint8_t bits;
};
constexpr std::size_t length_symbols = 19;
constexpr unsigned zeros_symbol = 18; // of 11 to 138 zeros, in 7 bits
constexpr std::array<std::uint8_t, length_symbols> order_of_lengths{16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                                    11, 4,  12, 3, 13, 2, 14, 1, 15};

std::vector<LengthSymbol> length_symbols_of(std::span<const std::uint8_t> lengths) {
    std::vector<LengthSymbol> result;
    for (std::size_t i = 0; i < lengths.size();) {
        std::size_t zeros = 0;
        while (i + zeros < lengths.size() && zeros < 138 && lengths[i + zeros] == 0)
            ++zeros;
        if (zeros >= 11) {
            result.push_back({zeros_symbol, static_cast<std::uint8_t>(zeros - 11)});
            i += zeros;
        } else {
            result.push_back({lengths[i], 0});
            ++i;
        }
    }
    return result;
}

void put_lengths(const std::array<Code, symbols>& codes, BitWriter& out) {
    std::size_t used = symbols;
    while (codes[used - 1].length == 0)
        --used;
    std::array<std::uint8_t, symbols + 1> lengths{};
    for (std::size_t i = 0; i < used; ++i)
        lengths[i] = codes[i].length;
    lengths[used] = 1; // the only distance
    const std::vector<LengthSymbol> coded = length_symbols_of(std::span(lengths).first(used + 1));
    std::array<std::uint64_t, length_symbols> frequencies{};
    for (const LengthSymbol& length : coded)
        ++frequencies[length.symbol];
    const auto length_codes = huffman_codes(frequencies, longest_code_of_lengths);

    out.put(used - 257, 5);
    out.put(0, 5); // one distance
    std::size_t shown = length_symbols;
    while (shown > 4 && length_codes[order_of_lengths[shown - 1]].length == 0)
        --shown;
    out.put(shown - 4, 4);
    for (std::size_t i = 0; i < shown; ++i)
        out.put(length_codes[order_of_lengths[i]].length, 3);
    for (const LengthSymbol& length : coded) {
        out.put(length_codes[length.symbol]);
        if (length.symbol == zeros_symbol)
            out.put(length.bits, 7);
    }
}

// Upper bound: 3 + 14 bits, 19 lengths, 287 lengths of at most 7 + 7 bits, and the spare bytes of a
// BitWriter.
constexpr std::size_t most_header_bytes = 600;

/// Bits after the first literal of a short run: a copy, if the run is long enough for one.
struct CopyBits {
    std::uint32_t bits = 0;
    std::uint32_t count = 0;
};

std::array<CopyBits, longest_short_run + 1> copies_of(const std::array<Code, symbols>& codes) {
    std::array<CopyBits, longest_short_run + 1> copies{};
    for (std::size_t n = shortest_copy + 1; n <= longest_short_run; ++n) {
        const CopyCode& copy = copy_codes[n - 1];
        const Code& code = codes[copy.symbol];
        // The last bit is the code 0 of distance 1.
        copies[n] = {static_cast<std::uint32_t>(code.bits | copy.bits << code.length),
                     code.length + copy.extra + 1U};
    }
    return copies;
}

void put_long_run(const Parts& parts, const Code& literal, const std::array<Code, symbols>& codes,
                  BitWriter& out) {
    for (std::uint64_t i = 0; i < parts.literals; ++i)
        out.put(literal);
    const Code& code = codes[longest_copy_symbol];
    out.put_repeated(code.bits, code.length + 1U, parts.full);
    if (parts.rest > 0) {
        const CopyCode& copy = copy_codes[parts.rest];
        out.put(codes[copy.symbol]);
        out.put(copy.bits, copy.extra + 1U); // and the bit 0 for distance 1
    }
}

} // namespace

void RunDeflater::reduce_checksum() noexcept {
    constexpr std::uint64_t prime = 65521;
    checksum_.sum %= prime;
    checksum_.sum_of_sums %= prime;
    unreduced_ = 0;
}

void RunDeflater::put(std::span<const PixelRun> row) {
    static_assert(most_pixels < most_unreduced);
    if (row.size() < 3) {
        std::uint32_t from = 0;
        for (const PixelRun& run : row) {
            put(run.value, run.end - from);
            from = run.end;
        }
        return;
    }
    // All runs except the first and the last one are complete, and no count here is near the largest one.
    // State that changes with each run is kept in local variables, because stores of bytes may alias the
    // object and would force reloads.
    put(row.front().value, row.front().end);
    end_run();
    make_room_in_checksum(row.back().end - row.front().end);
    Checksum checksum = checksum_;
    std::uint32_t from = row.front().end;
    for (std::size_t i = 1; i + 1 < row.size();) {
        const std::size_t some = std::min(row.size() - 1 - i, most_runs - run_count_);
        Run* to = runs_.data() + run_count_;
        for (const PixelRun& run : row.subspan(i, some)) {
            const std::uint32_t count = run.end - from;
            from = run.end;
            checksum.add(run.value, count);
            *to++ = {count, run.value};
        }
        i += some;
        run_count_ += some;
        if (run_count_ == most_runs)
            write_block(false);
    }
    const std::uint32_t count = row.back().end - from;
    checksum.add(row.back().value, count);
    checksum_ = checksum;
    value_ = row.back().value;
    count_ = count;
}

void RunDeflater::write_block(bool last) {
    if (!begun_) {
        stream_.clear();
        stream_.append(std::string_view("\x78\x01", 2)); // Deflate, window of 32 KB, the fastest kind
        begun_ = true;
    }
    std::array<std::uint64_t, symbols> frequencies{};
    frequencies[end_of_block] = 1;
    const std::span<const Run> runs(runs_.data(), run_count_);
    for (const Run& run : runs) {
        if (run.count <= shortest_copy) {
            frequencies[run.value] += run.count;
        } else if (run.count <= longest_short_run) {
            ++frequencies[run.value];
            ++frequencies[copy_codes[run.count - 1].symbol];
        } else {
            const Parts parts = parts_of(run.count);
            frequencies[run.value] += parts.literals;
            frequencies[longest_copy_symbol] += parts.full;
            if (parts.rest > 0)
                ++frequencies[copy_codes[parts.rest].symbol];
        }
    }
    if (runs.empty()) // a code needs two symbols
        frequencies[0] = 1;
    const auto codes = huffman_codes(frequencies, longest_code);

    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < symbols; ++i)
        bits += frequencies[i] *
                (codes[i].length + (i < literals ? 0U : 6U)); // up to 5 extra bits, and a distance
    char* const room = stream_.room(bits / 8 + most_header_bytes);
    BitWriter out(room, bits_, bit_count_);
    out.put(last ? 1 : 0, 1);
    out.put(2, 2); // dynamic Huffman codes
    put_lengths(codes, out);
    const auto copies = copies_of(codes);
    for (const Run& run : runs) {
        const Code& literal = codes[run.value];
        if (run.count <= shortest_copy) {
            const std::uint64_t twice = std::uint64_t{literal.bits} << literal.length | literal.bits;
            const std::uint64_t thrice = twice << literal.length | literal.bits;
            out.put(run.count == 1   ? literal.bits
                    : run.count == 2 ? twice
                                     : thrice,
                    run.count * literal.length);
        } else if (run.count <= longest_short_run) {
            const CopyBits& copy = copies[run.count];
            out.put(literal.bits | std::uint64_t{copy.bits} << literal.length, literal.length + copy.count);
        } else {
            put_long_run(parts_of(run.count), literal, codes, out);
        }
    }
    out.put(codes[end_of_block]);
    stream_.end_at(out.out());
    bits_ = out.bits();
    bit_count_ = out.count();
    run_count_ = 0;
}

std::string_view RunDeflater::finish() {
    end_run();
    write_block(true);
    for (; bit_count_ > 0; bit_count_ -= std::min(bit_count_, 8U), bits_ >>= 8) {
        const char byte = static_cast<char>(bits_ & 0xff);
        stream_.append({&byte, 1});
    }
    reduce_checksum();
    const std::uint64_t checksum = checksum_.sum_of_sums << 16 | checksum_.sum;
    std::array<char, 4> ending;
    for (unsigned i = 0; i < 4; ++i)
        ending[i] = static_cast<char>(checksum >> (24 - 8 * i) & 0xff);
    stream_.append({ending.data(), ending.size()});
    bits_ = 0;
    checksum_ = {};
    begun_ = false;
    return stream_.view();
}

} // namespace lamella
