#include "slicing/paper/intersection_lists.hpp"
#include "slicing/paper/serial_engine.hpp"

#include <cstdint>

// Efficient contour construction
//
// This is the method of Zhang and Joshi (2015), as King, Rennie and Bennett (2021) describe it in section
// 3.1. It takes one triangle after the other. For each plane that cuts the triangle, from top to bottom, it
// makes one intersection, where the contour enters the triangle. It inserts the intersection into the lists
// of its plane at once, by comparing its edges with both ends of every list. Completed lists remain where
// they are and are searched again and again.

namespace lamella {

void slice_by_ecc(const SliceJob& job) {
    SerialEngine engine(job);
    IntersectionLists<IntersectionNode> lists(engine);
    engine.for_triangles([&](std::size_t triangle) {
        for (const TriangleSection& section : engine.sections(triangle)) {
            if (section.begin == section.end)
                continue;
            const EdgeCut cut = engine.cut(section.from);
            const Edge* from = lists.make_edge(section.from);
            const Edge* to = lists.make_edge(section.to);
            for (std::uint32_t plane = section.end; plane-- > section.begin;)
                lists.insert_by_search(plane, lists.make_node(cut.at(engine.z(plane)), from, to));
        }
    });
    job.report.matching = lists.final_counts();
    engine.deliver(
        [&](std::uint32_t plane, LayerBuilder& layer) { lists.write(lists.active(plane), plane, layer); });
}

} // namespace lamella
