#pragma once

// Edge matching (King, Rennie and Bennett 2021, section 3.2): two triangles that met in an edge on one plane
// meet in it on every plane that cuts it. So of the planes that cut a triangle in the same two edges only the
// first needs a search; on the others an IN goes where the one before it went.

#include "slicing/paper/intersection_lists.hpp"

#include <cstdint>

namespace lamella {

/// IN with an edge link (Fig. 8).
struct LinkedIntersectionNode {
    Point2 point;
    const Edge* from;
    const Edge* to;
    LinkedIntersectionNode* next = nullptr;
    LinkedIntersectionNode* previous = nullptr;
    /// Leads to the ILL that was given the next IN of this triangle, on the plane below.
    IntersectionList<LinkedIntersectionNode>* edge_link = nullptr;
};

/// The lists of an engine with edge links, and its four cases. Each places `node` as the IN before it on the
/// same triangle and the same edges, `before`, was placed on the plane above.
///
/// A link is followed only as far as it holds: the list that it leads to must end (begin) with the edge that
/// is looked for. It always does where no edge has more than two triangles. Where it does not, the IN is
/// inserted by search.
class EdgeLinkedLists : public IntersectionLists<LinkedIntersectionNode> {
  public:
    using Node = LinkedIntersectionNode;
    using IntersectionLists::IntersectionLists;

    /// Case 1.
    Placed into_new(std::uint32_t plane, Node* node) {
        ++counts().by_edge_link.new_list;
        return insert_into_new(plane, node);
    }

    /// Case 2: behind the neighbour that `before` was put behind.
    Placed at_back(std::uint32_t plane, Node* node, const Node& before) {
        List* list = list_that_ends_at(node, before.previous->edge_link);
        if (list == nullptr)
            return insert_by_search(plane, node);
        ++counts().by_edge_link.back;
        return insert_at_back(list, node);
    }

    /// Case 3: before the neighbour that `before` was put before.
    Placed at_front(std::uint32_t plane, Node* node, const Node& before) {
        List* list = list_that_begins_at(node, before.next->edge_link);
        if (list == nullptr)
            return insert_by_search(plane, node);
        ++counts().by_edge_link.front;
        return insert_at_front(list, node);
    }

    /// Case 4: between the neighbours that `before` was put between. What were two lists on the plane above
    /// may be two ends of one here.
    Placed between(std::uint32_t plane, Node* node, const Node& before) {
        List* first = list_that_ends_at(node, before.previous->edge_link);
        List* second = list_that_begins_at(node, before.next->edge_link);
        if (first == nullptr || second == nullptr)
            return insert_by_search(plane, node);
        if (first == second) {
            ++counts().by_edge_link.close;
            return insert_and_close(first, node);
        }
        ++counts().by_edge_link.link;
        return insert_between(plane, first, second, node);
    }

    /// Inserts the INs of a triangle from top to bottom, and stores their edge links.
    ///
    /// place(plane, node, before, how) is the engine's chain of cases: it puts `node` where `before` tells,
    /// which was inserted as `how` says, one of new_list, back, front and link. closed(plane, list) is told
    /// of every list that was completed.
    template <class Place, class Closed>
    void insert_triangle(const SerialEngine& engine, const TriangleSections& sections, const Place& place,
                         const Closed& closed) {
        Node* before = nullptr;
        Placed placed{};
        for (const TriangleSection& section : sections) {
            if (section.begin == section.end)
                continue;
            const EdgeCut cut = engine.cut(section.from);
            const Edge* from = make_edge(section.from);
            const Edge* to = make_edge(section.to);
            for (std::uint32_t plane = section.end; plane-- > section.begin;) {
                Node* node = make_node(cut.at(engine.z(plane)), from, to);
                // None of the four cases follows on a completed contour.
                const bool first_on_these_edges = plane + 1 == section.end;
                const Placed now = first_on_these_edges || placed.how == Inserted::close
                                       ? insert_by_search(plane, node)
                                       : place(plane, node, *before, placed.how);
                const bool was_an_end = placed.how != Inserted::link && placed.how != Inserted::close;
                if (before != nullptr && was_an_end)
                    before->edge_link = now.list;
                if (now.how == Inserted::close)
                    closed(plane, now.list);
                before = node;
                placed = now;
            }
        }
    }

  private:
    static List* list_that_ends_at(const Node* node, List* link) {
        List* list = link != nullptr ? holder_of(link) : nullptr;
        return list != nullptr && !list->complete && *list->last->to == *node->from ? list : nullptr;
    }
    static List* list_that_begins_at(const Node* node, List* link) {
        List* list = link != nullptr ? holder_of(link) : nullptr;
        return list != nullptr && !list->complete && *list->first->from == *node->to ? list : nullptr;
    }
};

} // namespace lamella
