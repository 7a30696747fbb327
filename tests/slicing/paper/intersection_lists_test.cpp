#include "parts/shapes.hpp"
#include "slicing/paper/intersection_lists.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace lamella {
namespace {

/// One plane, and edges by number: the IN (i, k) enters over edge i and leaves over edge k.
class Lists : public testing::Test {
  protected:
    using IN = IntersectionNode;
    using Placed = IntersectionLists<IN>::Placed;

    Placed insert(std::size_t from, std::size_t to) {
        return lists_.insert_by_search(
            0, lists_.make_node({static_cast<double>(from), 0}, edge(from), edge(to)));
    }

    /// The x of each list's points: the numbers of the edges.
    [[nodiscard]] std::vector<std::vector<double>> contents() {
        std::vector<std::vector<double>> all;
        for (const IntersectionList<IN>* list = lists_.active(0).first; list != nullptr; list = list->next) {
            std::vector<double> one;
            const IN* previous = nullptr;
            for (const IN* node = list->first; node != nullptr; node = node->next) {
                EXPECT_EQ(node->previous, previous);
                one.push_back(node->point.x);
                previous = node;
            }
            EXPECT_EQ(list->last, previous);
            EXPECT_EQ(list->next == nullptr, list == lists_.active(0).last);
            all.push_back(one);
        }
        return all;
    }

    [[nodiscard]] const MatchingCounts& counts() { return lists_.counts(); }

  private:
    /// An EP of its own each time: edges are the same when their vertices are.
    const Edge* edge(std::size_t i) { return lists_.make_edge({&vertices_[i], &vertices_[i + 1]}); }

    std::array<Point3, 20> vertices_{};
    IndexedMesh nothing_;
    Mesh mesh_ = nothing_;
    Plan plan_ = plan_listed({0});
    LayerSink sink_;
    Execution execution_;
    SliceReport report_;
    SliceJob job_{mesh_, plan_, sink_, execution_, 0, report_};
    SerialEngine engine_{job_};
    IntersectionLists<IN> lists_{engine_};
};

using Contents = std::vector<std::vector<double>>;

TEST_F(Lists, Case1TheFirstIntersectionMakesAList) {
    EXPECT_EQ(insert(1, 2).how, Inserted::new_list);
    EXPECT_EQ(contents(), (Contents{{1}}));
}

TEST_F(Lists, Case2AMatchWithTheFirstOneIsInsertedAtTheFront) {
    const Placed placed = insert(1, 2);
    EXPECT_EQ(insert(0, 1).how, Inserted::front);
    EXPECT_EQ(contents(), (Contents{{0, 1}}));
    EXPECT_EQ(insert(2, 3).list, placed.list);
}

TEST_F(Lists, Case3AMatchWithTheLastOneIsInsertedAtTheBack) {
    insert(1, 2);
    EXPECT_EQ(insert(2, 3).how, Inserted::back);
    EXPECT_EQ(contents(), (Contents{{1, 2}}));
}

TEST_F(Lists, Case4MatchesInTwoListsLinkThemAndTheSecondIsDeleted) {
    // In whichever order the two lists stand, and with others around them.
    insert(10, 11);
    const Placed back = insert(3, 4);
    insert(12, 13);
    const Placed front = insert(1, 2);
    insert(14, 15);
    const Placed linked = insert(2, 3);
    EXPECT_EQ(linked.how, Inserted::link);
    EXPECT_EQ(linked.list, front.list);
    EXPECT_EQ(contents(), (Contents{{10}, {12}, {1, 2, 3}, {14}}));
    EXPECT_EQ(IntersectionLists<IN>::holder_of(back.list), front.list)
        << "who knew the second list finds the first";
    EXPECT_EQ(IntersectionLists<IN>::holder_of(front.list), front.list);
}

TEST_F(Lists, Case5BothMatchesInOneListComplete) {
    insert(1, 2);
    insert(2, 3);
    EXPECT_EQ(insert(3, 1).how, Inserted::close);
    EXPECT_EQ(contents(), (Contents{{1, 2, 3}}));
    // It still ends in the edge that it begins with; nothing is added to it any more.
    EXPECT_EQ(insert(1, 7).how, Inserted::new_list);
    EXPECT_EQ(insert(7, 1).how, Inserted::close);
    EXPECT_EQ(contents(), (Contents{{1, 2, 3}, {1, 7}}));
}

TEST_F(Lists, Case6NoMatchMakesAListBehindTheOthers) {
    insert(1, 2);
    EXPECT_EQ(insert(5, 6).how, Inserted::new_list);
    EXPECT_EQ(insert(2, 1).how, Inserted::close);
    EXPECT_EQ(contents(), (Contents{{1, 2}, {5}}));
}

TEST_F(Lists, FindWhoHoldsTheNodesThroughAnyNumberOfLinks) {
    std::vector<Placed> placed;
    for (std::size_t i = 0; i < 9; ++i)
        placed.push_back(insert(2 * i, 2 * i + 1));
    for (const std::size_t i : {6U, 7U, 4U, 5U, 2U, 0U, 1U, 3U})
        EXPECT_EQ(insert(2 * i + 1, 2 * i + 2).how, Inserted::link);
    ASSERT_EQ(contents().size(), 1U);
    EXPECT_EQ(contents()[0].size(), 17U);
    for (const Placed& one : placed)
        EXPECT_EQ(IntersectionLists<IN>::holder_of(one.list), placed[0].list);
}

TEST_F(Lists, CountSearchesListsAndCases) {
    insert(1, 2); // looks at none
    insert(5, 6); // 1
    insert(2, 3); // 2, for a second match might come
    insert(4, 5); // 2
    insert(3, 4); // 2: both found
    insert(6, 1); // 1 is left
    EXPECT_EQ(counts().searches, 6U);
    EXPECT_EQ(counts().comparisons, 8U);
    EXPECT_EQ(counts().inserted.new_list, 2U);
    EXPECT_EQ(counts().inserted.front, 1U);
    EXPECT_EQ(counts().inserted.back, 1U);
    EXPECT_EQ(counts().inserted.link, 1U);
    EXPECT_EQ(counts().inserted.close, 1U);
    EXPECT_EQ(counts().inserted.total(), 6U);
    EXPECT_EQ(counts().by_edge_link.total(), 0U);
}

TEST(IntersectionNode, HasThePartsThatThePaperCounts) {
    // Section 4.1 counts 40 bytes: x and y in single precision, and four pointers. Here they are doubles.
    EXPECT_EQ(sizeof(IntersectionNode), 2 * sizeof(double) + 4 * sizeof(void*));
}

} // namespace
} // namespace lamella
