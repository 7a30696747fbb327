#pragma once

// Which of many keys are equal? In parallel, in expected linear time, and the same answer for any number of
// threads. The heart of welding, and of whatever else pairs things up.
//
//     partition   each key goes to the partition that the top bits of its hash name; partitions are small
//                 enough to be worked on within a core's cache, and the order of the keys is kept
//     join        within a partition, a small hash table finds for each key the first one equal to it
//
// Keys come from files, and files may be hostile: where a probe in a table gets long, the partition is sorted
// instead. Crafted keys cost O(n log n), never O(n^2).

#include "core/executor.hpp"
#include "core/pages.hpp"

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace lamella {

/// Multiplies to 128 bits and folds: every bit of the result depends on all bits of both.
[[nodiscard]] inline std::uint64_t mix(std::uint64_t a, std::uint64_t b) noexcept {
    __extension__ using Wide = unsigned __int128;
    const Wide product = static_cast<Wide>(a ^ 0x9e3779b97f4a7c15) * (b ^ 0xd1b54a32d192ed03);
    return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
}

/// Calls found(first, other, worker) for every key that is not the first of its kind: `first` is the lowest
/// id of an equal key, `worker` the one that makes the call. The ids of keys are their positions in all parts
/// together, one part after the other; below 2^32 in all.
///
/// hash(key) gives 64 bits, equal for equal keys. Calls come from all workers at once; those for equal keys
/// come from one worker and with ascending `other`. Hands out parts to workers, so there should be as many.
template <class Key, class Hash, class Found>
requires std::is_trivially_copyable_v<Key> && std::totally_ordered<Key>
void join_equal_keys(Executor& executor, std::span<const std::span<const Key>> parts, const Hash& hash,
                     const Found& found);

namespace key_groups {

/// Keys per partition: keys and table stay within the second-level cache.
inline constexpr std::size_t partition_keys = std::size_t{1} << 13;
inline constexpr unsigned most_partition_bits = 12;
/// With tables at most half full, a probe this long does not happen by chance.
inline constexpr unsigned longest_probe = 64;

template <class Key>
struct Record {
    Key key;
    std::uint32_t id;
};

/// Reports records from `from` on (those before were reported already).
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

/// `table`: memory to work in, of any content.
template <class Key, class Hash, class Found>
void join_partition(std::span<const Record<Key>> records, std::vector<std::uint32_t>& table, unsigned worker,
                    const Hash& hash, const Found& found) {
    if (records.size() < 2)
        return;
    table.assign(std::bit_ceil(2 * records.size()), 0); // position + 1, or 0
    const std::uint64_t mask = table.size() - 1;
    for (std::size_t i = 0; i < records.size(); ++i) {
        std::uint64_t slot = hash(records[i].key) & mask; // low bits: the top ones are the same here
        for (unsigned probe = 0;; ++probe) {
            std::uint32_t& entry = table[slot];
            if (entry == 0) {
                entry = static_cast<std::uint32_t>(i + 1);
                break;
            }
            const Record<Key>& first = records[entry - 1];
            if (first.key == records[i].key) {
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

template <class Key, class Hash, class Found>
requires std::is_trivially_copyable_v<Key> && std::totally_ordered<Key>
void join_equal_keys(Executor& executor, std::span<const std::span<const Key>> parts, const Hash& hash,
                     const Found& found) {
    using key_groups::Record;
    std::size_t keys = 0;
    std::vector<std::size_t> first_id;
    for (const std::span<const Key> part : parts) {
        first_id.push_back(keys);
        keys += part.size();
    }
    const std::size_t wanted = std::bit_ceil(keys / key_groups::partition_keys + 1);
    const unsigned bits =
        std::min(static_cast<unsigned>(std::countr_zero(wanted)), key_groups::most_partition_bits);
    const std::size_t partitions = std::size_t{1} << bits;
    // Shifted in two steps, because a shift by 64 is none.
    const auto partition = [&](const Key& key) {
        return hash(key) >> 1 >> (63 - bits);
    };

    // Count, prefix sum, fill. next[part][partition]: where the part's next key of that partition goes.
    std::vector<std::vector<std::size_t>> next(parts.size(), std::vector<std::size_t>(partitions, 0));
    executor.for_chunks(parts.size(), 1, [&](std::size_t p, std::size_t, unsigned) {
        for (const Key& key : parts[p])
            ++next[p][partition(key)];
    });
    std::vector<std::size_t> begin(partitions + 1, 0);
    std::size_t sum = 0;
    for (std::size_t q = 0; q < partitions; ++q) {
        begin[q] = sum;
        for (std::vector<std::size_t>& counts : next) {
            const std::size_t count = counts[q];
            counts[q] = sum;
            sum += count;
        }
    }
    begin[partitions] = sum;
    const PageArray<Record<Key>> records(keys);
    executor.for_chunks(parts.size(), 1, [&](std::size_t p, std::size_t, unsigned) {
        std::vector<std::size_t>& to = next[p];
        for (std::size_t i = 0; i < parts[p].size(); ++i) {
            const Key& key = parts[p][i];
            records[to[partition(key)]++] = {key, static_cast<std::uint32_t>(first_id[p] + i)};
        }
    });

    std::vector<std::vector<std::uint32_t>> tables(executor.workers());
    executor.for_chunks(partitions, 1, [&](std::size_t q, std::size_t, unsigned worker) {
        const std::span<const Record<Key>> all = records.span();
        key_groups::join_partition(all.subspan(begin[q], begin[q + 1] - begin[q]), tables[worker], worker,
                                   hash, found);
    });
}

} // namespace lamella
