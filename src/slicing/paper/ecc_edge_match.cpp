#include "slicing/paper/edge_links.hpp"
#include "slicing/paper/serial_engine.hpp"

#include <cstdint>

// Efficient contour construction with edge matching
//
// This is section 3.2 of King, Rennie and Bennett (2021), and the column "ECC + edge matching" of its
// Table 5. It is ECC, except that it searches only for the first intersection on a pair of edges; the
// positions of the others follow from the first. The cases are tested in the order in which the paper
// introduces them.

namespace lamella {

void slice_by_ecc_edge_match(const SliceJob& job) {
    SerialEngine engine(job);
    EdgeLinkedLists lists(engine);
    using Node = EdgeLinkedLists::Node;
    const auto position = [&](std::uint32_t plane, Node* node, const Node& before, Inserted how) {
        if (how == Inserted::new_list)
            return lists.into_new(plane, node);
        if (how == Inserted::back)
            return lists.at_back(plane, node, before);
        if (how == Inserted::front)
            return lists.at_front(plane, node, before);
        return lists.between(plane, node, before);
    };
    const auto leave_completed = [](std::uint32_t, EdgeLinkedLists::List*) {
    };
    engine.for_triangles([&](std::size_t triangle) {
        lists.insert_triangle(engine, engine.sections(triangle), position, leave_completed);
    });
    job.report.matching = lists.final_counts();
    engine.deliver(
        [&](std::uint32_t plane, LayerBuilder& layer) { lists.write(lists.active(plane), plane, layer); });
}

} // namespace lamella
