#include "slicing/cut_graph.hpp"

#include "lamella/core/error.hpp"

#include "core/key_groups.hpp"
#include "slicing/edge_pairing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

// How the graph is built
//
// Collect. Workers take chunks of consecutive triangles. An edge is looked up in a small table private to the
// worker that stays in its second-level cache: most files have the two triangles of an edge close together.
// Found: the node is complete. Not found: a new node, known from one side so far, takes the slot; whoever sat
// there is left to the next step. No thread waits for another, and no memory access leaves the cache but to
// append.
//
// Join. Nodes of equal ends are brought together by their hashes (core/key_groups.hpp). Two halves become one
// node.
//
// Pair. Where more than two triangles met in an edge, or where hashes collide, the links are dealt out anew
// among the nodes that really have equal ends, by geometry (edge_pairing.hpp).

namespace lamella {

namespace {

template <class Ends>
std::uint64_t hash_of(const Ends& ends) {
    std::array<std::uint64_t, sizeof(Ends) / 8> words;
    static_assert(sizeof words == sizeof ends);
    std::memcpy(words.data(), &ends, sizeof ends);
    std::uint64_t h = 0;
    for (std::size_t i = 0; i + 1 < words.size(); i += 2)
        h = mix(words[i] ^ h, words[i + 1]);
    if (words.size() % 2 == 1)
        h = mix(words.back() ^ h, words.size());
    return h;
}

struct FloatCorners {
    using Ends = FloatEnds;
    using Corner = Point3f;

    FloatCorners(const TriangleSoup& soup, const Ranks& ranks)
        : data_(soup.data()), stride_(soup.stride()), ranks_(ranks) {}

    /// False when no plane cuts triangle i.
    bool load(std::uint64_t i, std::array<Corner, 3>& corners, std::array<std::uint32_t, 3>& rank) const {
        std::memcpy(&corners, data_ + i * stride_, sizeof corners);
        if (corners[0].z == corners[1].z && corners[1].z == corners[2].z)
            return false;
        for (std::size_t k = 0; k < 3; ++k)
            rank[k] = ranks_(corners[k].z);
        if (rank[0] == rank[1] && rank[1] == rank[2])
            return false;
        for (Corner& c : corners)
            c = {c.x + 0.0F, c.y + 0.0F, c.z + 0.0F}; // -0 is +0
        return true;
    }
    [[nodiscard]] static Ends ends(const Corner& low, const Corner& high) { return {low, high}; }

  private:
    const std::byte* data_;
    std::size_t stride_;
    const Ranks& ranks_;
};

struct PlacedCorners {
    using Ends = DoubleEnds;
    using Corner = Point3;

    PlacedCorners(const TriangleSoup& soup, const Ranks& ranks) : soup_(soup), ranks_(ranks) {}

    bool load(std::uint64_t i, std::array<Corner, 3>& corners, std::array<std::uint32_t, 3>& rank) const {
        corners = soup_.placed(i);
        for (std::size_t k = 0; k < 3; ++k)
            rank[k] = ranks_(corners[k].z);
        return !(rank[0] == rank[1] && rank[1] == rank[2]);
    }
    [[nodiscard]] static Ends ends(const Corner& low, const Corner& high) { return {low, high}; }

  private:
    const TriangleSoup& soup_;
    const Ranks& ranks_;
};

struct IndexedCorners {
    using Ends = IndexEnds;
    using Corner = std::uint32_t;

    IndexedCorners(const IndexedMesh& mesh, const PageArray<std::uint32_t>& vertex_ranks)
        : mesh_(mesh), ranks_(vertex_ranks) {}

    bool load(std::uint64_t i, std::array<Corner, 3>& corners, std::array<std::uint32_t, 3>& rank) const {
        corners = mesh_.triangles[i];
        for (std::size_t k = 0; k < 3; ++k)
            rank[k] = ranks_[corners[k]];
        return !(rank[0] == rank[1] && rank[1] == rank[2]);
    }
    [[nodiscard]] static Ends ends(Corner low, Corner high) { return {low, high}; }

  private:
    const IndexedMesh& mesh_;
    const PageArray<std::uint32_t>& ranks_;
};

/// Node numbers come in blocks from one counter, so that workers number nodes without waiting and the numbers
/// stay dense.
template <class Ends>
class NodePool {
  public:
    NodePool(PageArray<CutNode<Ends>>& nodes, std::uint32_t block) : nodes_(nodes), block_(block) {}

    struct Cursor {
        std::uint32_t next = 0;
        std::uint32_t end = 0;
    };

    std::uint32_t take(Cursor& cursor) {
        if (cursor.next == cursor.end) {
            const std::uint64_t begin = used_.fetch_add(block_, std::memory_order_relaxed);
            cursor.next = static_cast<std::uint32_t>(begin);
            cursor.end = static_cast<std::uint32_t>(std::min<std::uint64_t>(begin + block_, nodes_.size()));
        }
        return cursor.next++;
    }
    [[nodiscard]] std::uint32_t used() const {
        return static_cast<std::uint32_t>(std::min<std::uint64_t>(used_.load(), nodes_.size()));
    }

  private:
    PageArray<CutNode<Ends>>& nodes_;
    std::uint32_t block_;
    std::atomic<std::uint64_t> used_{0};
};

template <class Corners>
class Builder {
    using Ends = typename Corners::Ends;
    using Node = CutNode<Ends>;

  public:
    Builder(const Corners& corners, std::uint64_t triangles, const Point3* vertices, Executor& executor,
            ProgressMeter& progress)
        : corners_(corners), triangles_(triangles), executor_(executor), progress_(progress),
          workers_(executor.workers()) {
        graph_.vertices = vertices;
    }

    CutGraph<Ends> build() {
        // At most three nodes for each triangle, and one partly used block for each worker.
        const std::uint64_t block = std::clamp<std::uint64_t>(3 * triangles_ / workers_ + 3, 3, 1U << 14);
        const std::uint64_t capacity = 3 * triangles_ + block * workers_;
        if (capacity >= no_node)
            throw Error(ErrorKind::limit,
                        fmt::format("{} triangles are more than can be sliced at once in 32-bit "
                                    "numbers ({})",
                                    triangles_, no_node / 3));
        graph_.nodes = PageArray<Node>(capacity, Fill::zero); // a node of zeros is not in use
        hashes_ = PageArray<std::uint64_t>(capacity);
        NodePool<Ends> pool(graph_.nodes, static_cast<std::uint32_t>(block));

        collect(pool);
        graph_.count = pool.used();
        join();
        if (!crowded_.empty())
            graph_.nonmanifold_edges = pair_crowded_edges(graph_, crowded_, executor_);
        return std::move(graph_);
    }

  private:
    /// Two nodes of equal hash.
    struct Meeting {
        std::uint32_t first; ///< the same at each meeting of a group
        std::uint32_t other;
    };

    /// The node last seen with this part of a hash, + 1, so that zero is empty.
    struct Slot {
        std::uint32_t tag;
        std::uint32_t node;
    };

    struct Worker {
        PageArray<Slot> table;
        typename NodePool<Ends>::Cursor cursor;
        std::array<Meeting, 16> meetings; ///< under way, oldest at `met` modulo their number
        std::size_t met = 0;
        std::vector<std::uint32_t> crowded; ///< nodes that share their hash with others, repeated
    };

    void collect(NodePool<Ends>& pool) {
        const std::uint64_t expected = triangles_ * 3 / 2;
        const auto table_bits = std::clamp(static_cast<int>(std::bit_width(expected)), 4, 15);
        table_mask_ = (1U << table_bits) - 1;

        worker_.resize(workers_);
        const std::uint64_t chunk =
            std::clamp<std::uint64_t>(triangles_ / (std::uint64_t{workers_} * 8), 4096, 1U << 16);
        executor_.for_chunks(triangles_, chunk, [&](std::uint64_t begin, std::uint64_t end, unsigned w) {
            Worker& worker = worker_[w];
            if (worker.table.size() == 0) {
                worker.table = PageArray<Slot>(table_mask_ + std::size_t{1}, Fill::zero);
            }
            for (std::uint64_t i = begin; i < end; ++i)
                add_triangle(i, worker, pool);
            progress_.add(end - begin);
        });
    }

    void add_triangle(std::uint64_t i, Worker& worker, NodePool<Ends>& pool) {
        std::array<typename Corners::Corner, 3> corner;
        std::array<std::uint32_t, 3> rank;
        if (!corners_.load(i, corner, rank))
            return;
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0])
            return; // no area and no effect on the topology: its two cut edges, if any, are one

        std::array<std::uint32_t, 3> node;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t k1 = k == 2 ? 0 : k + 1;
            if (rank[k] < rank[k1])
                node[k] =
                    find_or_add(Corners::ends(corner[k], corner[k1]), rank[k], rank[k1], true, worker, pool);
            else if (rank[k] > rank[k1])
                node[k] =
                    find_or_add(Corners::ends(corner[k1], corner[k]), rank[k1], rank[k], false, worker, pool);
            else
                node[k] = no_node;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t k1 = k == 2 ? 0 : k + 1;
            const std::size_t k2 = k1 == 2 ? 0 : k1 + 1;
            if (rank[k] <= rank[k1])
                continue;
            // The edge runs downwards here, so contours leave it through this triangle: below the third
            // corner over the edge at the lower end, above it over the one at the upper end.
            Node& leaving = graph_.nodes[node[k]];
            leaving.triangle = static_cast<std::uint32_t>(i);
            const bool between = rank[k1] < rank[k2] && rank[k2] < rank[k];
            leaving.next_low = rank[k1] < rank[k2] ? node[k1] : node[k2];
            leaving.next_high = rank[k2] < rank[k] ? node[k2] : node[k1];
            leaving.split = between ? rank[k2] : rank[k1];
        }
    }

    std::uint32_t find_or_add(const Ends& ends, std::uint32_t first, std::uint32_t last, bool entered,
                              Worker& worker, NodePool<Ends>& pool) {
        const std::uint64_t hash = hash_of(ends);
        const auto tag = static_cast<std::uint32_t>(hash >> 32);
        Slot& slot = worker.table[hash & table_mask_];
        if (slot.node != 0 && slot.tag == tag) {
            Node& node = graph_.nodes[slot.node - 1];
            if ((entered ? node.entered == 0 : !node.left()) && node.ends == ends) {
                const std::uint32_t found = slot.node - 1;
                if (entered)
                    node.entered = 1;
                slot.node = 0; // complete: a third triangle at this edge must make a node of its own
                return found;
            }
        }
        const std::uint32_t added = pool.take(worker.cursor);
        graph_.nodes[added] = {ends, no_node, no_node, first, first & 0x7FFFFFFF, entered, last, 0};
        slot = {tag, added + 1};
        hashes_[added] = hash;
        return added;
    }

    void join() {
        // Numbers that were handed out but not used take part with hashes of their own.
        for (const Worker& worker : worker_)
            for (std::uint32_t id = worker.cursor.next; id < worker.cursor.end; ++id)
                hashes_[id] = mix(id, graph_.count);

        std::vector<std::span<const std::uint64_t>> parts;
        for (std::uint64_t w = 0; w < workers_; ++w) {
            const std::uint64_t begin = graph_.count * w / workers_;
            const std::uint64_t end = graph_.count * (w + 1) / workers_;
            parts.emplace_back(hashes_.span().subspan(begin, end - begin));
        }
        join_equal_keys<std::uint64_t>(
            executor_, parts, [](std::uint64_t hash) { return hash; },
            [&](std::uint32_t first, std::uint32_t other, unsigned w) {
                // The two nodes may lie anywhere: they are looked at a while after they are asked for.
                Worker& worker = worker_[w];
                __builtin_prefetch(&graph_.nodes[first], 1);
                __builtin_prefetch(&graph_.nodes[other], 1);
                Meeting& oldest = worker.meetings[worker.met % worker.meetings.size()];
                if (worker.met >= worker.meetings.size())
                    meet(oldest, worker.crowded);
                oldest = {first, other};
                ++worker.met;
            });
        for (Worker& worker : worker_) {
            const std::size_t places = worker.meetings.size();
            for (std::size_t i = worker.met < places ? 0 : worker.met - places; i < worker.met; ++i)
                meet(worker.meetings[i % places], worker.crowded);
            crowded_.insert(crowded_.end(), worker.crowded.begin(), worker.crowded.end());
        }
        // A half may have been in a crowd before it became part of another node, which then stands for it.
        for (std::uint32_t& id : crowded_)
            if (graph_.nodes[id].first == graph_.nodes[id].last)
                id = graph_.nodes[id].triangle;
    }

    void meet(const Meeting& meeting, std::vector<std::uint32_t>& crowded) {
        Node& a = graph_.nodes[meeting.first];
        Node& b = graph_.nodes[meeting.other];
        if (a.first == a.last) {
            // It is one node with another one already: three are a crowd.
            crowded.insert(crowded.end(), {a.triangle, meeting.other});
            return;
        }
        const bool halves = a.entered != b.entered && a.left() != b.left() && a.entered != a.left();
        if (!halves || !(a.ends == b.ends)) {
            crowded.insert(crowded.end(), {meeting.first, meeting.other});
        } else if (a.entered) {
            unite(a, b, meeting.first);
        } else {
            unite(b, a, meeting.other);
        }
    }

    /// Nodes are known by the edges that lead to them, so the entered half stays and takes the other's links.
    /// The other one is no longer in use; as its triangle it keeps the number of the node that it is part of.
    static void unite(Node& entered, Node& left, std::uint32_t number) {
        entered.next_low = left.next_low;
        entered.next_high = left.next_high;
        entered.split = left.split;
        entered.triangle = left.triangle;
        left.next_low = left.next_high = no_node;
        left.last = left.first;
        left.triangle = number;
    }

    const Corners& corners_;
    std::uint64_t triangles_;
    Executor& executor_;
    ProgressMeter& progress_;
    unsigned workers_;
    std::uint32_t table_mask_ = 0;
    std::vector<Worker> worker_;
    PageArray<std::uint64_t> hashes_; // per node
    CutGraph<Ends> graph_;
    std::vector<std::uint32_t> crowded_; // nodes that share their ends with others, in no order, repeated
};

} // namespace

CutGraph<FloatEnds> build_cut_graph(const TriangleSoup& unplaced, const Ranks& ranks, Executor& executor,
                                    ProgressMeter& progress) {
    const FloatCorners corners(unplaced, ranks);
    return Builder<FloatCorners>(corners, unplaced.size(), nullptr, executor, progress).build();
}

CutGraph<DoubleEnds> build_placed_cut_graph(const TriangleSoup& soup, const Ranks& ranks, Executor& executor,
                                            ProgressMeter& progress) {
    const PlacedCorners corners(soup, ranks);
    return Builder<PlacedCorners>(corners, soup.size(), nullptr, executor, progress).build();
}

CutGraph<IndexEnds> build_cut_graph(const IndexedMesh& mesh, const Ranks& ranks, Executor& executor,
                                    ProgressMeter& progress) {
    PageArray<std::uint32_t> vertex_ranks(mesh.vertices.size());
    executor.for_chunks(mesh.vertices.size(), 1U << 14,
                        [&](std::uint64_t begin, std::uint64_t end, unsigned) {
                            for (std::uint64_t v = begin; v < end; ++v)
                                vertex_ranks[v] = ranks(mesh.vertices[v].z);
                        });
    const IndexedCorners corners(mesh, vertex_ranks);
    return Builder<IndexedCorners>(corners, mesh.triangles.size(), mesh.vertices.data(), executor, progress)
        .build();
}

} // namespace lamella
