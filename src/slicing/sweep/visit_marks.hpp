#pragma once

// For each node of the cut graph, the plane before which it needs no visit by a walk.

#include "lamella/slicing/plan.hpp"

#include "core/pages.hpp"
#include "slicing/sweep/cut_graph.hpp"

#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// One mark per node, which all workers share. A node begins in one task, and only the worker of this task
/// changes its mark here.
using SharedMarks = PageArray<std::atomic<std::uint32_t>>;

/// The marks as one worker sees them. Nodes that reach into its task from below have marks of its own, so
/// that the memory does not grow by all nodes with each worker.
class VisitMarks {
  public:
    /// Requires one shared mark, initially 0, per node; both must outlive this object.
    VisitMarks(const SharedMarks& shared, const PageArray<CutNode>& nodes) : shared_(shared), nodes_(nodes) {}

    /// Begins a task at a plane. `carried` are all nodes that begin before it and are visited in the task.
    void begin_task(std::uint32_t first_plane, std::span<const std::uint32_t> carried) {
        first_plane_ = first_plane;
        // At most half of the slots are in use; where that takes more memory than a slot per node, each node
        // has the slot of its number, and no key is compared.
        const std::size_t nodes = shared_.size();
        hashed_ = carried.size() < nodes / 4;
        const std::size_t slots = carried.empty() ? 0 : hashed_ ? 2 * carried.size() : nodes;
        marks_.assign(slots, 0);
        keys_.assign(hashed_ ? slots : 0, no_node);
        if (hashed_)
            for (const std::uint32_t node : carried)
                keys_[slot_of(node)] = node;
    }

    /// Returns true if the node needs no visit on this plane.
    [[nodiscard, gnu::always_inline]] bool marked(std::uint32_t node, std::uint32_t plane) const {
        return shared_[node].load(std::memory_order_relaxed) > plane ||
               (is_carried(node) && marks_[slot_of(node)] > plane);
    }

    /// Marks the node on all planes before `end`. May be called from several threads at once, for different
    /// nodes, in a task that begins at plane 0.
    void mark(std::uint32_t node, std::uint32_t end) {
        if (is_carried(node))
            marks_[slot_of(node)] = end;
        else
            shared_[node].store(end, std::memory_order_relaxed);
    }

    void prefetch(std::uint32_t node) const { __builtin_prefetch(&shared_[node], 1); }

  private:
    [[nodiscard]] bool is_carried(std::uint32_t node) const {
        return first_plane_ != 0 && nodes_[node].first < first_plane_;
    }

    /// Returns the slot of a carried node, or while nodes are entered, a free slot for it.
    [[nodiscard]] std::size_t slot_of(std::uint32_t node) const {
        if (!hashed_)
            return node;
        // The upper bits of the product are evenly distributed.
        std::size_t slot = (std::uint64_t{node * 0x9E3779B1U} * keys_.size()) >> 32;
        while (keys_[slot] != node && keys_[slot] != no_node)
            slot = slot + 1 == keys_.size() ? 0 : slot + 1;
        return slot;
    }

    const SharedMarks& shared_;
    const PageArray<CutNode>& nodes_;
    std::uint32_t first_plane_ = 0;
    bool hashed_ = false;
    std::vector<std::uint32_t> keys_;  ///< per slot: the carried node, or no_node
    std::vector<std::uint32_t> marks_; ///< per slot
};

} // namespace lamella
