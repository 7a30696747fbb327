#include "core/key_groups.hpp"
#include "fixtures/skip_if_slowed.hpp"

#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <random>
#include <unordered_set>

namespace lamella {
namespace {

using Pairs = std::map<std::uint32_t, std::uint32_t>; // other -> first

template <class Hash>
Pairs join(const std::vector<std::uint64_t>& keys, std::size_t parts, unsigned threads, const Hash& hash) {
    std::vector<std::span<const std::uint64_t>> spans;
    for (std::size_t p = 0; p < parts; ++p) {
        const std::size_t begin = keys.size() * p / parts;
        spans.push_back(std::span(keys).subspan(begin, keys.size() * (p + 1) / parts - begin));
    }
    Executor executor({.threads = threads});
    Pairs out;
    std::mutex mutex;
    join_equal_keys<std::uint64_t>(
        executor, spans, hash, [&](std::uint32_t first, std::uint32_t other, unsigned) {
            const std::lock_guard lock(mutex);
            EXPECT_TRUE(out.emplace(other, first).second) << "reported twice: " << other;
        });
    return out;
}

Pairs naive_join(const std::vector<std::uint64_t>& keys) {
    Pairs out;
    std::map<std::uint64_t, std::uint32_t> seen;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto [at, fresh] = seen.try_emplace(keys[i], static_cast<std::uint32_t>(i));
        if (!fresh)
            out[static_cast<std::uint32_t>(i)] = at->second;
    }
    return out;
}

std::vector<std::uint64_t> random_keys(std::size_t n, std::uint64_t kinds, unsigned seed) {
    std::mt19937_64 random(seed);
    std::vector<std::uint64_t> keys(n);
    for (std::uint64_t& key : keys)
        key = random() % kinds;
    return keys;
}

const auto good_hash = [](std::uint64_t key) {
    return mix(key, 1);
};

TEST(KeyGroups, FindsTheFirstEqualKeyForAnyNumberOfPartsAndThreads) {
    for (const std::size_t n : {0U, 1U, 2U, 1000U, 50000U})
        for (const std::uint64_t kinds :
             {std::uint64_t{1}, std::uint64_t{37}, std::uint64_t{20000}, ~std::uint64_t{0}}) {
            const std::vector<std::uint64_t> keys = random_keys(n, kinds, 1);
            const Pairs expected = naive_join(keys);
            for (const std::size_t parts : {1U, 2U, 7U})
                for (const unsigned threads : {1U, 3U})
                    EXPECT_EQ(join(keys, parts, threads, good_hash), expected);
        }
}

TEST(KeyGroups, NoPartsAndEmptyPartsAreFine) {
    Executor executor({.threads = 2});
    const auto never = [](std::uint32_t, std::uint32_t, unsigned) {
        ADD_FAILURE();
    };
    join_equal_keys<std::uint64_t>(executor, {}, good_hash, never);
    const std::vector<std::span<const std::uint64_t>> empty(3);
    join_equal_keys<std::uint64_t>(executor, empty, good_hash, never);
}

TEST(KeyGroups, AConstantHashGivesTheSameAnswer) {
    const std::vector<std::uint64_t> keys = random_keys(30000, 9000, 2);
    const Pairs expected = naive_join(keys);
    for (const std::uint64_t constant : {std::uint64_t{0}, ~std::uint64_t{0}})
        EXPECT_EQ(join(keys, 3, 2, [&](std::uint64_t) { return constant; }), expected);
}

TEST(KeyGroups, AConstantHashDoesNotCostTheSquare) {
    LAMELLA_SKIP_IF_SLOWED();
    // A million different keys in one chain would take 5e11 comparisons: hours. Sorted, it is a second.
    std::vector<std::uint64_t> keys = random_keys(500000, ~std::uint64_t{0}, 3);
    keys.insert(keys.end(), keys.begin(), keys.end());
    EXPECT_EQ(join(keys, 2, 2, [](std::uint64_t) { return std::uint64_t{0}; }).size(), 500000U);
}

TEST(KeyGroups, HashesThatCollideInAllLowBitsGiveTheSameAnswer) {
    const std::vector<std::uint64_t> keys = random_keys(40000, 30000, 4);
    EXPECT_EQ(join(keys, 2, 2, [](std::uint64_t key) { return key << 48; }), naive_join(keys));
}

TEST(KeyGroups, ReportsEqualKeysInAscendingOrder) {
    const std::vector<std::uint64_t> keys = random_keys(50000, 11, 5);
    Executor executor({.threads = 3});
    const std::vector<std::span<const std::uint64_t>> parts{std::span(keys).first(20000),
                                                            std::span(keys).subspan(20000)};
    std::vector<std::uint32_t> last(keys.size(), 0);
    join_equal_keys<std::uint64_t>(executor, parts, good_hash,
                                   [&](std::uint32_t first, std::uint32_t other, unsigned) {
                                       EXPECT_LT(last[first], other);
                                       last[first] = other;
                                   });
}

TEST(KeyPartitions, JoinsWhatIsPutInAnyOrderOfBlocksSomeOfThemPartlyFullOrMissing) {
    const std::uint32_t size = 1000;
    const std::vector<std::uint64_t> keys = random_keys(40 * size, 9000, 6);
    for (const std::uint64_t expected :
         {std::uint64_t{0}, std::uint64_t{keys.size()}, std::uint64_t{1} << 27}) {
        KeyPartitions<std::uint64_t> partitions(expected);
        partitions.reserve(41, size);
        Pairs wanted;
        std::map<std::uint64_t, std::uint32_t> seen;
        for (std::uint32_t block = 0; block < 40; ++block) {
            const std::uint32_t count = block % 3 == 2 ? 0 : block % 3 == 1 ? size / 2 : size;
            for (std::uint32_t id = block * size; id < block * size + count; ++id)
                if (const auto [at, fresh] = seen.try_emplace(keys[id], id); !fresh)
                    wanted[id] = at->second;
        }
        for (std::uint32_t block = 40; block-- > 0;)
            if (const std::uint32_t count = block % 3 == 1 ? size / 2 : size; block % 3 != 2)
                partitions.put(
                    block, count, [&](std::uint32_t i) { return good_hash(keys[block * size + i]); },
                    [&](std::uint32_t i) {
                        return key_groups::Record<std::uint64_t>{keys[block * size + i], block * size + i};
                    });
        Executor executor({.threads = 3});
        std::mutex mutex;
        Pairs found;
        partitions.join(executor, good_hash, [&](std::uint32_t first, std::uint32_t other, unsigned) {
            const std::lock_guard lock(mutex);
            EXPECT_TRUE(found.emplace(other, first).second);
        });
        EXPECT_EQ(found, wanted);
    }
}

TEST(KeyPartitions, AFullBlockInTheLastOfAllPartitionsIsFound) {
    const auto record = [&](std::uint32_t i) {
        return key_groups::Record<std::uint32_t>{i / 2, i};
    };
    for (const std::uint64_t hash : {std::uint64_t{0}, ~std::uint64_t{0}}) {
        KeyPartitions<std::uint32_t> partitions(std::uint64_t{1} << 30);
        const std::uint32_t size = partitions.block_size();
        EXPECT_GE(size, key_groups::least_block);
        partitions.reserve(1, size);
        partitions.put(
            0, size, [&](std::uint32_t) { return hash; }, record);
        Executor executor({.threads = 1});
        std::uint32_t pairs = 0;
        partitions.join(
            executor, [](std::uint32_t key) { return mix(key, 1); },
            [&](std::uint32_t first, std::uint32_t other, unsigned) {
                EXPECT_EQ(first + 1, other);
                ++pairs;
            });
        EXPECT_EQ(pairs, size / 2);
    }
}

TEST(Mix, SpreadsNeighbouringNumbersOverTopAndBottomBits) {
    std::unordered_set<std::uint64_t> top;
    std::unordered_set<std::uint64_t> bottom;
    for (std::uint64_t i = 0; i < 1000; ++i) {
        top.insert(mix(i, 0) >> 32);
        bottom.insert(mix(0, i) & 0xffffffff);
    }
    EXPECT_GE(top.size(), 999U);
    EXPECT_GE(bottom.size(), 999U);
}

} // namespace
} // namespace lamella
