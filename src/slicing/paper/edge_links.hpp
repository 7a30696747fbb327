#pragma once

// Edge matching (King, Rennie and Bennett 2021, section 3.2): two triangles that share an edge on one plane
// share it on every plane that cuts the edge. Therefore, among the planes that cut a triangle in the same two
// edges, only the first one needs a search. On each of the others, the IN is inserted at the position that
// corresponds to that of the IN on the plane above.

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
    /// The ILL that received the next IN of this triangle, on the plane below.
    IntersectionList<LinkedIntersectionNode>* edge_link = nullptr;
};

/// The lists of an engine with edge links, and its four cases. Each case inserts `node` like `before`, the IN
/// on the plane above that has the same triangle and the same edges.
///
/// A link is used only if it is still valid: the list that it refers to must end (or begin) with the required
/// edge. A link is always valid if no edge has more than two triangles. If it is not valid, the IN is
/// inserted by search.
class EdgeLinkedLists : public IntersectionLists<LinkedIntersectionNode> {
  public:
    using Node = LinkedIntersectionNode;
    using IntersectionLists::IntersectionLists;

    /// Case 1: into a new list.
    Placed into_new(std::uint32_t plane, Node* node) {
        ++counts().by_edge_link.new_list;
        return insert_into_new(plane, node);
    }

    /// Case 2: after the neighbour after which `before` was inserted.
    Placed at_back(std::uint32_t plane, Node* node, const Node& before) {
        List* list = list_that_ends_at(node, before.previous->edge_link);
        if (list == nullptr)
            return insert_by_search(plane, node);
        ++counts().by_edge_link.back;
        return insert_at_back(list, node);
    }

    /// Case 3: before the neighbour before which `before` was inserted.
    Placed at_front(std::uint32_t plane, Node* node, const Node& before) {
        List* list = list_that_begins_at(node, before.next->edge_link);
        if (list == nullptr)
            return insert_by_search(plane, node);
        ++counts().by_edge_link.front;
        return insert_at_front(list, node);
    }

    /// Case 4: between the neighbours between which `before` was inserted. Two lists on the plane above may
    /// be the two ends of one list here.
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
    /// place(plane, node, before, how) is the engine's chain of cases. It inserts `node` like `before`, which
    /// was inserted by the case `how`: new_list, back, front or link. closed(plane, list) is called for every
    /// completed list.
    template <class Position, class Closed>
    void insert_triangle(const SerialEngine& engine, const TriangleSections& sections,
                         const Position& position, const Closed& closed) {
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
                // None of the four cases follows a completed contour.
                const bool first_on_these_edges = plane + 1 == section.end;
                const Placed now = first_on_these_edges || placed.how == Inserted::close
                                       ? insert_by_search(plane, node)
                                       : position(plane, node, *before, placed.how);
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
