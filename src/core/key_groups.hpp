#pragma once

// Finds equal keys among many: in parallel, in expected linear time, and with the same result for any number
// of threads. Welding and all other matching of equal keys use it.
//
//     partition   the top bits of its hash select the partition of each key; keys are moved there in chunks
//                 that fit into a core's cache, and keep their order
//     join        within a partition, which fits into the cache, too, a small hash table finds for each key
//                 the first one equal to it
//
// Keys come from files, which may be hostile. If a probe in a table gets long, the partition is sorted
// instead, so that crafted keys cost O(n log n), never O(n^2).

#include "core/executor.hpp"
#include "core/pages.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace lamella {

/// Combines both halves of the 128-bit product, so that every bit of the result depends on all bits of both
/// arguments.
[[nodiscard]] inline std::uint64_t mix(std::uint64_t a, std::uint64_t b) noexcept {
    __extension__ using Wide = unsigned __int128;
    const Wide product = static_cast<Wide>(a ^ 0x9e3779b97f4a7c15) * (b ^ 0xd1b54a32d192ed03);
    return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
}

namespace key_groups {

/// Keys per partition: keys and table fit into the second-level cache.
inline constexpr std::size_t partition_keys = std::size_t{1} << 13;
inline constexpr unsigned most_partition_bits = 12;
/// Least average number of keys of a chunk in a partition. With fewer, collecting the scattered keys is slow.
inline constexpr std::size_t partition_share = 8;
inline constexpr std::size_t least_block = std::size_t{1} << 14;
/// In a table that is at most half full, a probe this long is not due to chance.
inline constexpr unsigned longest_probe = 64;

template <class Key>
struct Record {
    Key key;
    std::uint32_t id;
};

/// Reports equal keys by sorting. Records before `from` were already reported.
template <class Key, class Found>
void join_sorted(std::span<const Record<Key>> records, std::size_t from, unsigned worker,
                 const Found& found) {
    std::vector<std::uint32_t> order(records.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = static_cast<std::uint32_t>(i);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return records[a].key == records[b].key ? a < b : records[a].key < records[b].key;
    });
    for (std::size_t i = 0; i < order.size();) {
        const Record<Key>& first = records[order[i]];
        for (++i; i < order.size() && records[order[i]].key == first.key; ++i)
            if (order[i] >= from)
                found(first.id, records[order[i]].id, worker);
    }
}

/// Reports equal keys by a hash table. `table` is scratch memory with any content.
template <class Key, class Hash, class Found>
void join_partition(std::span<const Record<Key>> records, std::vector<std::uint32_t>& table, unsigned worker,
                    const Hash& hash, const Found& found) {
    if (records.size() < 2)
        return;
    table.assign(std::bit_ceil(2 * records.size()), 0); // position + 1, or 0
    const std::uint64_t mask = table.size() - 1;
    for (std::size_t i = 0; i < records.size(); ++i) {
        // The low bits: the top ones are equal within a partition.
        std::uint64_t slot = hash(records[i].key) & mask;
        for (unsigned probe = 0;; ++probe) {
            std::uint32_t& entry = table[slot];
            if (entry == 0) {
                entry = static_cast<std::uint32_t>(i + 1);
                break;
            }
            const Record<Key>& first = records[entry - 1];
            if (first.key == records[i].key) {
                assert(first.id < records[i].id);
                found(first.id, records[i].id, worker);
                break;
            }
            if (probe == longest_probe) {
                join_sorted(records, i, worker, found);
                return;
            }
            slot = (slot + 1) & mask;
        }
    }
}

} // namespace key_groups

/// Keys with ids, which are sorted into partitions chunk by chunk and joined when all are present. Equal keys
/// must have equal hashes; a key may omit what its hash already contains.
template <class Key>
class KeyPartitions {
    static_assert(std::is_trivially_copyable_v<Key> && std::totally_ordered<Key>);

  public:
    using Record = key_groups::Record<Key>;

    /// `expected` is the approximate number of keys.
    explicit KeyPartitions(std::uint64_t expected)
        : bits_(std::min(static_cast<unsigned>(
                             std::countr_zero(std::bit_ceil(expected / key_groups::partition_keys + 1))),
                         key_groups::most_partition_bits)) {}

    /// Largest number of keys in a chunk; at most 2^15, so that 16 bits can count them.
    [[nodiscard]] std::uint32_t block_size() const noexcept {
        return static_cast<std::uint32_t>(
            std::max(key_groups::least_block, partitions() * key_groups::partition_share));
    }

    /// Must be called before the first `put`, for at most `blocks` chunks of at most `size` keys.
    void reserve(std::uint64_t blocks, std::uint32_t size) {
        assert(size <= block_size());
        size_ = size;
        records_ = PageArray<Record>(blocks * size);
        counts_ = PageArray<std::uint32_t>(blocks, Fill::zero);
        begins_ = PageArray<std::uint16_t>(blocks * partitions());
    }

    /// Stores chunk number `block`, each at most once, from any thread; a chunk that is never stored is
    /// empty. hash(i) returns 64 bits, record(i) key and id. Ids must ascend within and between chunks.
    template <class Hash, class MakeRecord>
    void put(std::uint64_t block, std::uint32_t count, const Hash& hash, const MakeRecord& record) const {
        std::array<std::uint16_t, std::size_t{1} << key_groups::most_partition_bits> next;
        std::fill_n(next.begin(), partitions(), std::uint16_t{0});
        for (std::uint32_t i = 0; i < count; ++i)
            ++next[partition(hash(i))];
        std::uint16_t* const begins = begins_.data() + block * partitions();
        std::uint16_t sum = 0;
        for (std::size_t q = 0; q < partitions(); ++q) {
            begins[q] = sum;
            sum = static_cast<std::uint16_t>(sum + std::exchange(next[q], sum));
        }
        assert(block < counts_.size() && count <= size_ && sum == count);
        assert(counts_[block] == 0); // each chunk is stored once
        Record* const records = records_.data() + block * size_;
        for (std::uint32_t i = 0; i < count; ++i)
            records[next[partition(hash(i))]++] = record(i);
        counts_[block] = count;
    }

    /// Calls found(first, other, worker) for every key `other` for which there is an equal key of lower id;
    /// `first` is the lowest such id, `worker` the calling worker. Calls come from all workers at once; those
    /// for equal keys come from one worker and with ascending `other`. hash(key) returns 64 bits, of which
    /// the lower ones must differ within a partition.
    template <class Hash, class Found>
    void join(Executor& executor, const Hash& hash, const Found& found) const {
        struct Worker {
            std::vector<Record> records;
            std::vector<std::uint32_t> table;
        };
        std::vector<Worker> workers(executor.workers());
        executor.for_chunks(partitions(), 1, [&](std::size_t q, std::size_t, unsigned w) {
            Worker& worker = workers[w];
            worker.records.clear();
            for (std::size_t block = 0; block < counts_.size(); ++block) {
                const std::uint16_t* const begins = begins_.data() + block * partitions();
                const Record* const records = records_.data() + block * size_;
                if (counts_[block] != 0)
                    worker.records.insert(worker.records.end(), records + begins[q],
                                          records + (q + 1 < partitions() ? begins[q + 1] : counts_[block]));
            }
            key_groups::join_partition<Key>(worker.records, worker.table, w, hash, found);
        });
    }

  private:
    [[nodiscard]] std::size_t partitions() const noexcept { return std::size_t{1} << bits_; }
    // Shifted in two steps, because a shift by 64 is undefined.
    [[nodiscard]] std::size_t partition(std::uint64_t hash) const noexcept {
        return hash >> 1 >> (63 - bits_);
    }

    unsigned bits_;
    std::uint32_t size_ = 0;
    PageArray<Record> records_;       // the records of each chunk, ordered by partition
    PageArray<std::uint32_t> counts_; // per chunk
    PageArray<std::uint16_t> begins_; // per chunk and partition
};

/// Joins keys in memory, and calls found(first, other, worker) as KeyPartitions::join does. The id of a key
/// is its position in the concatenation of all parts, below 2^32. hash(key) returns 64 bits.
template <class Key, class Hash, class Found>
void join_equal_keys(Executor& executor, std::span<const std::span<const Key>> parts, const Hash& hash,
                     const Found& found) {
    struct Block {
        std::span<const Key> keys;
        std::uint32_t first_id;
    };
    std::size_t count = 0;
    for (const std::span<const Key> part : parts)
        count += part.size();
    KeyPartitions<Key> partitions(count);
    std::vector<Block> blocks;
    std::uint32_t id = 0;
    for (std::span<const Key> part : parts)
        while (!part.empty()) {
            const std::size_t size = std::min<std::size_t>(part.size(), partitions.block_size());
            blocks.push_back({part.first(size), id});
            part = part.subspan(size);
            id += static_cast<std::uint32_t>(size);
        }
    partitions.reserve(blocks.size(), partitions.block_size());
    executor.for_chunks(blocks.size(), 1, [&](std::size_t b, std::size_t, unsigned) {
        const Block& block = blocks[b];
        partitions.put(
            b, static_cast<std::uint32_t>(block.keys.size()),
            [&](std::uint32_t i) { return hash(block.keys[i]); },
            [&](std::uint32_t i) {
                return key_groups::Record<Key>{block.keys[i], block.first_id + i};
            });
    });
    partitions.join(executor, hash, found);
}

} // namespace lamella
