#include "lamella/slicing/slice.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/named_solids.hpp"
#include "fixtures/rounds.hpp"
#include "parts/shapes.hpp"
#include "slicing/paper/paper_engines.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <string>
#include <string_view>

namespace lamella {
namespace {

TEST(Engines, BeginWithTheSweep) {
    ASSERT_FALSE(engines().empty());
    EXPECT_EQ(engines().front().name, "sweep");
}

TEST(Engines, HaveDifferentNamesAndSayWhatTheyAre) {
    std::set<std::string_view> names;
    for (const Engine& one : engines()) {
        EXPECT_TRUE(names.insert(one.name).second) << one.name;
        EXPECT_FALSE(one.summary.empty()) << one.name;
        EXPECT_EQ(one.summary.find('\n'), std::string_view::npos) << one.name;
        EXPECT_NE(one.slice, nullptr) << one.name;
        EXPECT_EQ(&engine(one.name), &one);
    }
}

TEST(Engines, GiveTheSameLayersWhereverAPartStands) {
    std::size_t turn = 0;
    for (const test::Solid& solid : test::small_solids()) {
        const TriangleSoup made = solid.make();
        for (const test::Placement& placement : test::placements()) {
            if (test::slowed && turn++ % 6 != 0) // each of them with some solid
                continue;
            const TriangleSoup mesh = shuffled(made, 3).transformed(placement.map);
            for (const test::NamedPlan& plan : test::plans_for(mesh, 8)) {
                const LayerStack expected = slice(mesh, plan.plan);
                for (const Engine& one : engines()) {
                    SCOPED_TRACE(std::string(solid.name) + ", " + placement.name + ", planes " + plan.name);
                    test::expect_same_where_it_can(one.name, slice(mesh, plan.plan, {.engine = one}),
                                                   expected);
                }
            }
        }
    }
}

TEST(Engines, AreListedWhenANameIsUnknown) {
    test::expect_error(ErrorKind::usage, {"'swep'", "sweep"}, [] { (void)engine("swep"); });
    test::expect_error(ErrorKind::usage, {"''", "sweep"}, [] { (void)engine(""); });
    test::expect_error(ErrorKind::usage, {"'Sweep'"}, [] { (void)engine("Sweep"); });
}

} // namespace
} // namespace lamella
