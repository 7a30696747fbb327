#include "slicing/sweep/runs.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace lamella::runs_cases {
namespace {

/// Adds a run whose ring on plane p starts at (p, nodes.front()), and whose columns hold nodes.front().
void add(Runs& runs, ColumnStore& store, std::uint32_t plane, std::uint32_t end,
         const std::vector<std::uint32_t>& nodes) {
    Run& run = runs.add(plane, {nodes, end, true});
    run.columns = store.reserve(run.size);
    if (run.columns != ColumnStore::not_kept)
        *store.at(run.columns) = nodes.front();
    std::uint32_t p = plane;
    for (Ring& ring : runs.rings(run, {plane, end}))
        ring = {{static_cast<double>(p++), static_cast<double>(nodes.front())}, 0, 3, 0};
}

/// The runs have the nodes, rings and columns that they were given.
void expect_whole(Runs& runs, const ColumnStore& store) {
    for (const Run& run : runs.all()) {
        ASSERT_EQ(runs.nodes(run).size(), run.size);
        const std::uint32_t mark = runs.nodes(run).front();
        if (run.columns != ColumnStore::not_kept) {
            EXPECT_EQ(*store.at(run.columns), mark);
        }
        for (std::uint32_t p = run.begin; p < run.end; ++p) {
            const std::uint64_t index = Runs::index_of(run, p);
            EXPECT_EQ(runs.ring(index).first, (Point2{static_cast<double>(p), static_cast<double>(mark)}));
            EXPECT_EQ(&runs.run_of(index), &run);
        }
    }
}

TEST(Runs, KeepWhatGoesOnWhenOthersAreForgotten) {
    Runs runs;
    ColumnStore store(32);
    runs.begin_task({10, 20});
    add(runs, store, 10, 12, {1, 2, 3});
    add(runs, store, 10, 20, {4, 5, 6, 7, 8, 9, 10, 11, 12});
    add(runs, store, 11, 15, {13, 14, 15});
    add(runs, store, 11, 13, {16, 17, 18}); // has no room in the store
    ASSERT_EQ(runs.all().back().columns, ColumnStore::not_kept);
    expect_whole(runs, store);

    runs.forget_before(12, store);
    ASSERT_EQ(runs.all().size(), 3U);
    EXPECT_EQ(runs.all()[0].begin, 12U);
    expect_whole(runs, store);
    add(runs, store, 12, 14, {19, 20, 21}); // where the first one was
    EXPECT_NE(runs.all().back().columns, ColumnStore::not_kept);
    expect_whole(runs, store);

    runs.forget_before(14, store);
    ASSERT_EQ(runs.all().size(), 2U);
    expect_whole(runs, store);
    runs.forget_before(20, store);
    EXPECT_TRUE(runs.all().empty());
    runs.begin_task({20, 30});
}

TEST(Runs, AskToBeForgottenWhenMostOfThemHaveEnded) {
    const std::vector<std::uint32_t> many(1U << 15, 0);
    const std::vector<std::uint32_t> more(1U << 17, 0);
    Runs runs;
    ColumnStore store(0);
    runs.begin_task({0, 10});
    runs.add(0, {more, 10, true});
    runs.add(0, {many, 2, true});
    EXPECT_FALSE(runs.end_plane(0)); // none has ended
    EXPECT_TRUE(runs.end_plane(1));
    runs.forget_before(2, store);
    for (std::uint32_t plane = 2; plane < 5; ++plane) { // as many as are alive have to end now
        runs.add(plane, {many, plane + 1, true});
        EXPECT_FALSE(runs.end_plane(plane)) << plane;
    }
    runs.add(5, {many, 6, true});
    EXPECT_TRUE(runs.end_plane(5));
}

} // namespace
} // namespace lamella::runs_cases
