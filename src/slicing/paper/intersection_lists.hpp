#pragma once

// The data structures of efficient contour construction, in the terms of King, Rennie and Bennett (2021,
// section 3.1), who adopted them from Zhang and Joshi (2015): IN, ILL and CLL.
//
// IN    intersection node: the intersection of one triangle with one plane. It has the point where the
//       contour enters the triangle; its neighbour has the point where the contour leaves it.
// EP    edge pointer of an IN: refers to the vertices of an edge of the triangle that the plane cuts. An IN
//       has two EPs, and they alone decide which INs match.
// ILL   intersection linked list: INs in the order of the contour.
// CLL   contour linked list: the ILLs of one plane.

#include "lamella/contour/layer.hpp"
#include "lamella/core/point.hpp"
#include "lamella/slicing/slice.hpp"

#include "slicing/paper/node_pool.hpp"
#include "slicing/paper/serial_engine.hpp"
#include "slicing/shrunken_contours.hpp"

#include <cassert>
#include <cstdint>
#include <vector>

namespace lamella {

/// IN (Fig. 4).
struct IntersectionNode {
    Point2 point;     ///< the cut of the edge `from` by the plane
    const Edge* from; ///< EP
    const Edge* to;   ///< EP: `from` of the IN that follows
    IntersectionNode* next = nullptr;
    IntersectionNode* previous = nullptr;
};

/// ILL. `Node` is the IN of the engine.
template <class Node>
struct IntersectionList {
    Node* first;
    Node* last;
    IntersectionList* next = nullptr;     ///< in the CLL
    IntersectionList* previous = nullptr; ///< in the CLL
    bool complete = false;                ///< a ring: no IN can be added
};

/// CLL. New lists are appended.
template <class Node>
using ContourList = LinkedList<IntersectionList<Node>>;

/// The case in which an IN was inserted.
enum class Inserted { new_list, front, back, link, close };

/// All CLLs of a mesh, and the six cases of inserting an IN (section 3.1).
template <class Node>
class IntersectionLists {
  public:
    using List = IntersectionList<Node>;

    struct Placed {
        Inserted how;
        List* list; ///< the list that holds the IN now
    };

    explicit IntersectionLists(const SerialEngine& engine) : engine_(engine), active_(engine.planes()) {
        counts_.node_bytes = sizeof(Node);
    }

    const Edge* make_edge(const Edge& edge) { return edges_.make(edge); }
    Node* make_node(const Point2& point, const Edge* from, const Edge* to) {
        return nodes_.make({point, from, to});
    }

    /// Returns the lists of a plane that are searched.
    [[nodiscard]] ContourList<Node>& active(std::uint32_t plane) { return active_[plane]; }

    /// Inserts `node` where the last or the first IN of a list of the plane matches. O(lists).
    Placed insert_by_search(std::uint32_t plane, Node* node) {
        engine_.check_cancelled();
        ++counts_.searches;
        List* ends = nullptr;   // the IN follows its last IN
        List* begins = nullptr; // the IN precedes its first IN
        for (List* list = active_[plane].first; list != nullptr; list = list->next) {
            ++counts_.comparisons;
            // The ends of a complete list match each other.
            if (ends == nullptr && *list->last->to == *node->from && !list->complete)
                ends = list;
            if (begins == nullptr && *list->first->from == *node->to && !list->complete)
                begins = list;
            if (ends != nullptr && begins != nullptr)
                break;
        }
        if (ends == nullptr && begins == nullptr)
            return insert_into_new(plane, node); // cases 1 and 6
        if (ends == nullptr)
            return insert_at_front(begins, node); // case 2
        if (begins == nullptr)
            return insert_at_back(ends, node); // case 3
        if (ends != begins)
            return insert_between(plane, ends, begins, node); // case 4
        return insert_and_close(ends, node);                  // case 5
    }

    Placed insert_into_new(std::uint32_t plane, Node* node) {
        ++counts_.inserted.new_list;
        List* list = lists_.make({.first = node, .last = node});
        active_[plane].append(list);
        return {Inserted::new_list, list};
    }

    Placed insert_at_front(List* list, Node* node) {
        assert(!list->complete && *node->to == *list->first->from);
        ++counts_.inserted.front;
        join(node, list->first);
        list->first = node;
        return {Inserted::front, list};
    }

    Placed insert_at_back(List* list, Node* node) {
        assert(!list->complete && *list->last->to == *node->from);
        ++counts_.inserted.back;
        append(list, node);
        return {Inserted::back, list};
    }

    /// Joins two lists by `node`. `second` is emptied, leaves the CLL and refers to `first` from then on
    /// (`holder_of`).
    Placed insert_between(std::uint32_t plane, List* first, List* second, Node* node) {
        assert(first != second && !first->complete && !second->complete);
        assert(*first->last->to == *node->from && *node->to == *second->first->from);
        ++counts_.inserted.link;
        append(first, node);
        join(first->last, second->first);
        first->last = second->last;
        active_[plane].remove(second);
        second->first = second->last = nullptr;
        second->next = first;
        return {Inserted::link, first};
    }

    Placed insert_and_close(List* list, Node* node) {
        assert(!list->complete && *list->last->to == *node->from && *node->to == *list->first->from);
        ++counts_.inserted.close;
        append(list, node);
        list->complete = true;
        return {Inserted::close, list};
    }

    /// Returns the list that holds the INs of `list` now. Amortised O(log lists).
    static List* holder_of(List* list) {
        while (list->first == nullptr) {
            if (list->next->first == nullptr)
                list->next = list->next->next;
            list = list->next;
        }
        return list;
    }

    /// Adds the contours of a CLL to a layer. Lists that never closed are chains. A chain also gets the point
    /// where the contour leaves its last triangle, because no neighbour stores it.
    void write(const ContourList<Node>& contours, std::uint32_t plane, LayerBuilder& layer) {
        for (const List* list = contours.first; list != nullptr; list = list->next) {
            points_.clear();
            for (const Node* node = list->first; node != nullptr; node = node->next)
                points_.push_back(node->point);
            if (!list->complete)
                points_.push_back(engine_.cut(*list->last->to).at(engine_.z(plane)));
            add_contour(layer, points_, list->complete);
        }
    }

    [[nodiscard]] MatchingCounts& counts() noexcept { return counts_; }
    /// Returns the counts with the allocated memory.
    [[nodiscard]] MatchingCounts final_counts() const {
        assert(counts_.inserted.total() == counts_.by_edge_link.total() + counts_.searches);
        MatchingCounts counts = counts_;
        counts.bytes = nodes_.bytes() + lists_.bytes() + edges_.bytes();
        return counts;
    }

  private:
    static void join(Node* before, Node* after) {
        before->next = after;
        after->previous = before;
    }
    static void append(List* list, Node* node) {
        join(list->last, node);
        list->last = node;
    }

    const SerialEngine& engine_;
    std::vector<ContourList<Node>> active_; // per plane
    NodePool<Edge> edges_;
    NodePool<Node> nodes_;
    NodePool<List> lists_;
    std::vector<Point2> points_;
    MatchingCounts counts_;
};

} // namespace lamella
