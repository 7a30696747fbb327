#pragma once

// Linked lists, and memory for their nodes, which do not move and are all freed together.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella {

/// A list through nodes of a pool, each of which points to its neighbours.
template <class Node>
struct LinkedList {
    Node* first = nullptr;
    Node* last = nullptr;

    void append(Node* node) {
        node->next = nullptr;
        node->previous = last;
        (last != nullptr ? last->next : first) = node;
        last = node;
    }

    void remove(Node* node) {
        (node->previous != nullptr ? node->previous->next : first) = node->next;
        (node->next != nullptr ? node->next->previous : last) = node->previous;
        node->next = node->previous = nullptr;
    }
};

template <class T>
class NodePool {
  public:
    /// Returns a new node, which does not move during the life of the pool.
    T* make(const T& value) {
        if (blocks_.empty() || blocks_.back().size() == blocks_.back().capacity()) {
            const std::size_t size =
                blocks_.empty() ? first_block : std::min(2 * blocks_.back().size(), largest_block);
            blocks_.emplace_back().reserve(size);
        }
        blocks_.back().push_back(value);
        return &blocks_.back().back();
    }

    void clear() { blocks_.clear(); }

    /// Returns the allocated bytes, including space for further nodes.
    [[nodiscard]] std::uint64_t bytes() const noexcept {
        std::uint64_t nodes = 0;
        for (const std::vector<T>& block : blocks_)
            nodes += block.capacity();
        return nodes * sizeof(T);
    }

  private:
    static constexpr std::size_t first_block = 64;
    static constexpr std::size_t largest_block = 1U << 16;

    std::vector<std::vector<T>> blocks_;
};

} // namespace lamella
