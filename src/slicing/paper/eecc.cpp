#include "slicing/paper/edge_links.hpp"
#include "slicing/paper/serial_engine.hpp"

#include <cstdint>
#include <vector>

// Enhanced efficient contour construction
//
// These are sections 3.2 and 3.3 and Fig. 9 of King, Rennie and Bennett (2021). The method uses edge
// matching. Completed lists move to a CLL of their own, which no search examines. The cases are tested in the
// order of their frequencies in Table 4.

namespace lamella {

void slice_by_eecc(const SliceJob& job) {
    SerialEngine engine(job);
    EdgeLinkedLists lists(engine);
    using Node = EdgeLinkedLists::Node;
    std::vector<ContourList<Node>> completed(engine.planes());
    const auto position = [&](std::uint32_t plane, Node* node, const Node& before, Inserted how) {
        if (how == Inserted::front) // 29.89 %
            return lists.at_front(plane, node, before);
        if (how == Inserted::new_list) // 26.91 %
            return lists.into_new(plane, node);
        if (how == Inserted::link) // 22.40 %
            return lists.between(plane, node, before);
        return lists.at_back(plane, node, before); // 20.79 %
    };
    const auto move_completed = [&](std::uint32_t plane, EdgeLinkedLists::List* list) {
        lists.active(plane).remove(list);
        completed[plane].append(list);
    };
    engine.for_triangles([&](std::size_t triangle) {
        lists.insert_triangle(engine, engine.sections(triangle), position, move_completed);
    });
    job.report.matching = lists.final_counts();
    engine.deliver([&](std::uint32_t plane, LayerBuilder& layer) {
        lists.write(completed[plane], plane, layer);
        lists.write(lists.active(plane), plane, layer);
    });
}

} // namespace lamella
