#include "lamella/findings/findings.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace lamella {
namespace {

TEST(FindingKinds, HaveARowEachInTheirOrderWithNamesOfTheirOwn) {
    std::set<std::string> names;
    std::uint32_t number = 0;
    for (const FindingDescription& row : finding_kinds()) {
        EXPECT_EQ(static_cast<std::uint32_t>(row.kind), number++) << row.name;
        EXPECT_EQ(&description(row.kind), &row);
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_TRUE(std::set<std::string>({"", "mm", "mm2", "mm3"}).contains(row.unit)) << row.unit;
    }
}

TEST(FindingKinds, HaveTextsOfOneLineForOneAndForMany) {
    for (const FindingDescription& row : finding_kinds())
        for (const std::uint64_t count : {1, 2}) {
            const Finding found{.kind = row.kind, .count = count, .amount = 3, .layers = 4, .of_layers = 20};
            const std::string text = found.text(); // throws for a field that is unknown
            EXPECT_FALSE(text.empty()) << row.name;
            EXPECT_EQ(text.find_first_of("{}\n"), std::string::npos) << text;
        }
}

} // namespace
} // namespace lamella
