#include "slicing/paper/node_pool.hpp"
#include "slicing/paper/serial_engine.hpp"
#include "slicing/shrunken_contours.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

// Conventional slicing
//
// This is the flowchart of King, Rennie and Bennett (2021, Fig. 1), after Xu et al. (2016). For each plane,
// it cuts every triangle of the mesh and then sorts the segments end to end. It compares the end of a contour
// with both end points of every remaining segment, one after the other, and appends the first one that
// coincides, until the contour is back at its beginning.
//
// Points do not show which triangles are neighbours. If more than two segments meet in a point (Fig. 2), the
// first one in the list is taken, and it may belong to another contour.

namespace lamella {

namespace {

/// The intersection of one triangle with one plane.
struct Segment {
    Point2 from;
    Point2 to;
    Segment* next = nullptr;
    Segment* previous = nullptr;
};

class Conventional {
  public:
    Conventional(const SerialEngine& engine, MatchingCounts& counts) : engine_(engine), counts_(counts) {
        counts_.node_bytes = sizeof(Segment);
    }

    void slice_plane(std::uint32_t plane, LayerBuilder& layer) {
        cut_triangles(plane);
        counts_.bytes = std::max(counts_.bytes, memory_.bytes());
        while (segments_.first != nullptr)
            sort_contour(layer);
        memory_.clear();
    }

  private:
    void cut_triangles(std::uint32_t plane) {
        const double z = engine_.z(plane);
        for (std::size_t triangle = 0; triangle < engine_.mesh().triangles.size(); ++triangle) {
            for (const TriangleSection& section : engine_.sections(triangle)) {
                if (plane < section.begin || plane >= section.end)
                    continue;
                const Point2 from = engine_.cut(section.from).at(z);
                const Point2 to = engine_.cut(section.to).at(z);
                if (!(from == to)) // a point would close a contour before it began
                    segments_.append(memory_.make({from, to}));
            }
        }
    }

    /// Moves one contour from the list to the layer. The contour has the direction of its first segment.
    void sort_contour(LayerBuilder& layer) {
        Segment* start = segments_.first;
        segments_.remove(start);
        ++counts_.inserted.new_list;
        contour_.assign({start->from, start->to});
        while (append_segment()) {
            if (contour_.back() == contour_.front()) {
                ++counts_.inserted.close;
                contour_.pop_back();
                add_contour(layer, contour_, true);
                return;
            }
            ++counts_.inserted.back;
        }
        // The contour does not close: segments before its beginning belong to it, too.
        std::reverse(contour_.begin(), contour_.end());
        while (append_segment())
            ++counts_.inserted.front;
        std::reverse(contour_.begin(), contour_.end());
        add_contour(layer, contour_, false);
    }

    /// Moves the first segment with an end point at the end of the contour from the list to the contour.
    /// Returns false if there is none.
    bool append_segment() {
        engine_.check_cancelled();
        ++counts_.searches;
        const Point2 end = contour_.back();
        for (Segment* segment = segments_.first; segment != nullptr; segment = segment->next) {
            ++counts_.comparisons;
            const bool begins_here = segment->from == end;
            if (!begins_here && !(segment->to == end))
                continue;
            contour_.push_back(begins_here ? segment->to : segment->from);
            segments_.remove(segment);
            return true;
        }
        return false;
    }

    const SerialEngine& engine_;
    MatchingCounts& counts_;
    NodePool<Segment> memory_;
    LinkedList<Segment> segments_; ///< in no contour yet, in the order of the triangles
    std::vector<Point2> contour_;
};

} // namespace

void slice_by_conventional(const SliceJob& job) {
    SerialEngine engine(job);
    Conventional conventional(engine, job.report.matching.emplace());
    engine.deliver([&](std::uint32_t plane, LayerBuilder& layer) { conventional.slice_plane(plane, layer); });
}

} // namespace lamella
