#include "core/distinct_names.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>

namespace lamella {
namespace {

TEST(DistinctNames, AreDistinctWhateverIsAsked) {
    test::Random random(621);
    for (int round = 0; round < test::rounds_within_reason(500); ++round) {
        DistinctNames names;
        std::set<std::string> given;
        std::uint64_t changed = 0;
        std::string first;
        for (std::int64_t n = random.integer(0, 30); n > 0; --n) {
            // Some names look like those that are made.
            std::string name(static_cast<std::size_t>(random.integer(0, 1)), 'a');
            if (random.integer(0, 2) == 0)
                name += " " + std::to_string(random.integer(1, 4));
            const bool taken = given.contains(name);
            const std::string distinct = names.of(name);
            EXPECT_TRUE(given.insert(distinct).second) << distinct;
            EXPECT_EQ(distinct == name, !taken) << "a free name stays";
            if (taken && changed++ == 0)
                first = distinct;
            EXPECT_TRUE(distinct.starts_with(name.empty() && taken ? "part" : name));
        }
        EXPECT_EQ(names.changed(), changed);
        EXPECT_EQ(names.first_changed(), first);
    }
}

} // namespace
} // namespace lamella
