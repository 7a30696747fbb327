#include "slicing/sweep/cut_graph.hpp"

#include "lamella/core/error.hpp"

#include "core/bit_cast.hpp"
#include "core/key_groups.hpp"
#include "slicing/sweep/edge_hash.hpp"
#include "slicing/sweep/pairing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

// Construction of the graph
//
// Collect. Workers take chunks of consecutive triangles. Each worker looks edges up in a small private table
// that stays in its second-level cache, because most files have the two triangles of an edge close together.
// If the edge is found, its node is complete. If not, a new node, known from one side only, takes the slot in
// the table; the node that it replaces there is completed in the next step. No thread waits for another, and
// only appended nodes are written to memory outside the cache.
//
// Join. Hashes bring nodes with equal ends together (core/key_groups.hpp). Two halves become one node.
//
// Pair. If an edge has more than two triangles, or if hashes collide, the nodes whose ends are really equal
// get new links by geometry (pairing.hpp).

namespace lamella {

namespace {

/// Nodes, keyed by the lower half of the hashes of their edges; the upper bits choose the partition.
/// Different edges rarely agree in both.
using NodePartitions = KeyPartitions<std::uint32_t>;

// Chunks of triangles. A Corner holds the bits that identify a vertex; they are the same in all triangles of
// the vertex.

struct FloatCorners {
    using Vertex = Point3f;
    /// Two integers that stay in registers and are read and written without conversion.
    struct Corner {
        std::uint64_t xy;
        std::uint32_t z;
        friend bool operator==(const Corner&, const Corner&) = default;
    };

    FloatCorners(const TriangleSoup& chunk, const Ranks& ranks)
        : data_(chunk.data()), stride_(chunk.stride()), ranks_(ranks) {}

    /// Returns false if no plane cuts triangle i of the chunk.
    bool load(std::uint64_t i, std::array<Corner, 3>& corners, std::array<std::uint32_t, 3>& rank) const {
        const std::byte* const triangle = data_ + i * stride_;
        std::array<float, 3> z;
        for (std::size_t k = 0; k < 3; ++k)
            std::memcpy(&z[k], triangle + 12 * k + 8, 4);
        if (z[0] == z[1] && z[1] == z[2])
            return false;
        for (std::size_t k = 0; k < 3; ++k)
            rank[k] = ranks_(z[k]);
        if (rank[0] == rank[1] && rank[1] == rank[2])
            return false;
        for (std::size_t k = 0; k < 3; ++k) {
            std::array<float, 2> xy;
            std::memcpy(&xy, triangle + 12 * k, 8);
            xy = {xy[0] + 0.0F, xy[1] + 0.0F}; // -0 becomes +0
            corners[k] = {lamella::bit_cast<std::uint64_t>(xy),
                          lamella::bit_cast<std::uint32_t>(z[k] + 0.0F)};
        }
        return true;
    }
    [[nodiscard]] static std::uint64_t hash(const Corner& c) { return corner_hash(c.xy, c.z); }
    [[nodiscard]] static bool is(const Point3f& stored, const Corner& c) {
        const auto xy = lamella::bit_cast<std::array<float, 2>>(c.xy);
        return static_cast<int>(stored.x == xy[0]) & static_cast<int>(stored.y == xy[1]) &
               static_cast<int>(stored.z == lamella::bit_cast<float>(c.z));
    }

  private:
    const std::byte* data_;
    std::size_t stride_;
    const Ranks& ranks_;
};

struct PlacedCorners {
    using Vertex = Point3;
    using Corner = Point3;

    PlacedCorners(TriangleSoup chunk, const Ranks& ranks) : chunk_(std::move(chunk)), ranks_(ranks) {}

    bool load(std::uint64_t i, std::array<Corner, 3>& corners, std::array<std::uint32_t, 3>& rank) const {
        corners = chunk_.placed(i);
        for (std::size_t k = 0; k < 3; ++k)
            rank[k] = ranks_(corners[k].z);
        return !(rank[0] == rank[1] && rank[1] == rank[2]);
    }
    [[nodiscard]] static std::uint64_t hash(const Corner& c) {
        return mix(mix(lamella::bit_cast<std::uint64_t>(c.x), lamella::bit_cast<std::uint64_t>(c.y)),
                   lamella::bit_cast<std::uint64_t>(c.z));
    }
    [[nodiscard]] static bool is(const Point3& stored, const Corner& c) { return stored == c; }

  private:
    TriangleSoup chunk_;
    const Ranks& ranks_;
};

struct IndexedCorners {
    using Vertex = std::uint32_t;
    using Corner = std::uint32_t;

    IndexedCorners(std::span<const std::array<std::uint32_t, 3>> chunk,
                   const PageArray<std::uint32_t>& vertex_ranks)
        : chunk_(chunk), ranks_(vertex_ranks) {}

    bool load(std::uint64_t i, std::array<Corner, 3>& corners, std::array<std::uint32_t, 3>& rank) const {
        corners = chunk_[i];
        for (std::size_t k = 0; k < 3; ++k)
            rank[k] = ranks_[corners[k]];
        return !(rank[0] == rank[1] && rank[1] == rank[2]);
    }
    [[nodiscard]] static std::uint64_t hash(Corner vertex) { return vertex; }
    [[nodiscard]] static bool is(std::uint32_t stored, Corner vertex) { return stored == vertex; }

  private:
    std::span<const std::array<std::uint32_t, 3>> chunk_;
    const PageArray<std::uint32_t>& ranks_;
};

/// Hands out node numbers in chunks from one counter, so that workers do not wait and the numbers stay dense.
class CutNodePool {
  public:
    CutNodePool(std::uint64_t capacity, std::uint32_t block) : capacity_(capacity), block_(block) {}

    struct Block {
        std::uint64_t number = 0;
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
    };

    /// Returns numbers that no other worker has.
    Block take() {
        const std::uint64_t begin = used_.fetch_add(block_, std::memory_order_relaxed);
        return {begin / block_, static_cast<std::uint32_t>(begin),
                static_cast<std::uint32_t>(std::min<std::uint64_t>(begin + block_, capacity_))};
    }
    [[nodiscard]] std::uint32_t used() const {
        return static_cast<std::uint32_t>(std::min<std::uint64_t>(used_.load(), capacity_));
    }

  private:
    std::uint64_t capacity_;
    std::uint32_t block_;
    std::atomic<std::uint64_t> used_{0};
};

/// Collects the nodes of one worker. The collector copies the data that it reads all the time into memory of
/// its own, so that writes of other workers nearby do not evict the data from its cache.
template <class Corners, class Ends>
class alignas(128) Collector {
    using Corner = typename Corners::Corner;

  public:
    /// Requires a power of two as `table_size`.
    Collector(const LocatedGraph<Ends>& graph, const NodePartitions& partitions, CutNodePool& pool,
              std::uint32_t block_size, std::size_t table_size)
        : nodes_(graph.nodes.data()), ends_(graph.ends), partitions_(partitions), pool_(pool),
          hashes_(block_size), table_(table_size, Fill::zero) {}

    /// Adds the triangles [begin, end) of a chunk; `first` is the number of the first triangle of the chunk.
    void add(Corners corners, std::uint64_t first, std::uint64_t begin, std::uint64_t end) {
        for (std::uint64_t i = begin; i < end; ++i)
            add_triangle(corners, i, first + i);
        end_ = first + end;
    }

    /// Returns the number after that of the last triangle.
    [[nodiscard]] std::uint64_t end() const noexcept { return end_; }

    /// Must be called after the last triangle.
    void finish() { put_hashes(); }

  private:
    /// The node last seen with this part of a hash, plus 1; 0 if empty.
    struct Slot {
        std::uint32_t tag;
        std::uint32_t node;
    };

    void add_triangle(const Corners& corners, std::uint64_t i, std::uint64_t number) {
        std::array<Corner, 3> corner;
        std::array<std::uint32_t, 3> rank;
        if (!corners.load(i, corner, rank))
            return;
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0])
            return; // no area and no effect on the topology: its two cut edges, if any, coincide

        const std::array<std::uint64_t, 3> hash{Corners::hash(corner[0]), Corners::hash(corner[1]),
                                                Corners::hash(corner[2])};
        const auto side = static_cast<std::uint32_t>(3 * number);
        const auto node_of = [&](std::uint32_t from, std::uint32_t to) {
            if (rank[from] == rank[to])
                return no_node;
            const bool up = rank[from] < rank[to];
            const std::size_t low = up ? from : to;
            const std::size_t high = up ? to : from;
            return find_or_add(corner[from], corner[to], edge_hash(hash[low], hash[high]), rank[low],
                               rank[high], side + from, up);
        };
        const std::uint32_t node01 = node_of(0, 1);
        const std::uint32_t node12 = node_of(1, 2);
        const std::uint32_t node20 = node_of(2, 0);

        // Contours leave an edge through the triangle in which it runs downwards. On planes below the third
        // corner they continue to the edge at its lower end, on planes above that corner to the edge at its
        // upper end.
        const auto link = [&](std::uint32_t from, std::uint32_t number_here, std::uint32_t upper_rank,
                              std::uint32_t lower_rank, std::uint32_t third_rank, std::uint32_t at_lower,
                              std::uint32_t at_upper) {
            if (upper_rank <= lower_rank)
                return;
            assert(from != no_node); // planes cut the edge
            CutNode& leaving = nodes_[from];
            const bool above_lower = lower_rank < third_rank;
            const bool below_upper = third_rank < upper_rank;
            leaving.next_low = above_lower ? at_lower : at_upper;
            leaving.next_high = below_upper ? at_upper : at_lower;
            leaving.split = above_lower && below_upper ? third_rank : lower_rank;
            leaving.side = side + number_here;
            assert(leaving.next_low != no_node && leaving.next_high != no_node);
        };
        link(node01, 0, rank[0], rank[1], rank[2], node12, node20);
        link(node12, 1, rank[1], rank[2], rank[0], node20, node01);
        link(node20, 2, rank[2], rank[0], rank[1], node01, node12);
    }

    std::uint32_t find_or_add(const Corner& from, const Corner& to, std::uint64_t hash, std::uint32_t first,
                              std::uint32_t last, std::uint32_t side, bool entered) {
        const auto tag = static_cast<std::uint32_t>(hash >> 32);
        Slot& slot = table_[hash & (table_.size() - 1)];
        if (slot.node != 0 && slot.tag == tag) {
            const std::uint32_t found = slot.node - 1;
            CutNode& node = nodes_[found];
            const bool other_side = entered ? node.entered == 0 : !node.left();
            if (other_side && runs_between(ends_(node.side), to, from)) {
                node.entered |= static_cast<unsigned>(entered);
                slot.node = 0; // complete: a third triangle at this edge must get a new node
                return found;
            }
        }
        assert(first < last);
        const std::uint32_t added = take_number();
        CutNode& node = nodes_[added];
        node.next_low = no_node;
        node.next_high = no_node;
        node.split = 0;
        node.side = side;
        node.first = first;
        node.set_last(last);
        node.entered = static_cast<unsigned>(entered);
        hashes_[added - block_.begin] = hash;
        slot = {tag, added + 1};
        return added;
    }

    static bool runs_between(const std::array<typename Ends::Vertex, 2>& ends, const Corner& from,
                             const Corner& to) {
        return Corners::is(ends[0], from) && Corners::is(ends[1], to);
    }

    std::uint32_t take_number() {
        if (next_ == block_.end) {
            put_hashes();
            block_ = pool_.take();
            next_ = block_.begin;
        }
        assert(next_ < block_.end); // there are numbers for all nodes of these triangles
        return next_++;
    }

    void put_hashes() {
        if (next_ != block_.begin)
            partitions_.put(
                block_.number, next_ - block_.begin, [&](std::uint32_t i) { return hashes_[i]; },
                [&](std::uint32_t i) {
                    return NodePartitions::Record{static_cast<std::uint32_t>(hashes_[i]), block_.begin + i};
                });
    }

    CutNode* nodes_;
    const Ends& ends_;
    const NodePartitions& partitions_;
    CutNodePool& pool_;
    CutNodePool::Block block_;
    std::uint32_t next_ = 0; ///< the next number to assign
    std::uint64_t end_ = 0;
    PageArray<std::uint64_t> hashes_; ///< hashes of the nodes with these numbers
    PageArray<Slot> table_;
};

/// Returns whether the links are complete. Each node in use must link, on all of its planes or (where the
/// mesh ends) on none, to nodes that these planes cut. As many contours must arrive as leave, so that links
/// are one to one.
[[maybe_unused]] bool is_complete(const CutGraph& graph) {
    std::uint64_t leaving = 0;
    std::uint64_t arriving = 0;
    const auto leads_to = [&](std::uint32_t next, std::uint32_t first, std::uint32_t last) {
        return first >= last || (next < graph.count && graph.nodes[next].entered &&
                                 graph.nodes[next].first <= first && last <= graph.nodes[next].last);
    };
    for (std::uint32_t id = 0; id < graph.count; ++id) {
        const CutNode& node = graph.nodes[id];
        if (!node.in_use())
            continue;
        const std::uint32_t last = node.last;
        if (node.first >= last)
            return false;
        if (node.left()) {
            leaving += last - node.first;
            const std::uint32_t split = std::clamp(node.split, node.first, last);
            if (!leads_to(node.next_low, node.first, split) || !leads_to(node.next_high, split, last))
                return false;
        }
        if (node.entered)
            arriving += last - node.first;
    }
    return leaving == arriving;
}

template <class Corners, class Ends>
class Builder {
  public:
    Builder(std::uint64_t triangles, Ends ends, Executor& executor, ProgressMeter& progress)
        : triangles_(triangles), executor_(executor), progress_(progress), workers_(executor.workers()),
          partitions_(triangles * 3 / 2), graph_(std::move(ends)) {
        // There are at most three nodes per triangle, and one partly used chunk of numbers per worker.
        block_ = static_cast<std::uint32_t>(
            std::clamp<std::uint64_t>(3 * triangles / workers_ + 3, 3, partitions_.block_size()));
        const std::uint64_t capacity = 3 * triangles + std::uint64_t{block_} * workers_;
        if (capacity >= no_node)
            throw Error(ErrorKind::limit,
                        fmt::format("{} triangles are more than can be sliced at once in 32-bit "
                                    "numbers ({})",
                                    triangles, no_node / 3));
        graph_.nodes = PageArray<CutNode>(capacity, Fill::zero); // a node of zeros is not in use
        partitions_.reserve(capacity / block_ + 1, block_);
        pool_.emplace(capacity, block_);
    }

    /// Collects the `count` triangles of a chunk. May be called by as many threads at once as there are
    /// workers. All chunks together must have the number of triangles of the mesh.
    void add(const Corners& chunk, std::uint64_t first, std::uint64_t count, const RangeVisitor& visit = {}) {
        std::unique_ptr<Collector<Corners, Ends>> collector = take_collector(first);
        // Chunks that are visited are added in parts that are still in the cache when they are added.
        const std::uint64_t part = visit ? 1024 : count;
        for (std::uint64_t begin = 0; begin < count; begin += part) {
            const std::uint64_t end = std::min(count, begin + part);
            if (visit)
                visit(first + begin, first + end);
            collector->add(chunk, first, begin, end);
        }
        progress_.add(count);
        const std::lock_guard lock(mutex_);
        collectors_.push_back(std::move(collector));
    }

    /// Must be called after all triangles were added.
    LocatedGraph<Ends> finish() {
        for (const std::unique_ptr<Collector<Corners, Ends>>& collector : collectors_)
            collector->finish();
        collectors_.clear();
        graph_.count = pool_->used();
        join();
        if (!non_manifold_.empty())
            graph_.nonmanifold_edges = pair_non_manifold_edges(graph_, non_manifold_, executor_);
        assert(is_complete(graph_));
        return std::move(graph_);
    }

  private:
    /// Two nodes of equal hash.
    struct NodePair {
        std::uint32_t first; ///< the same in all pairs with one hash
        std::uint32_t other;
    };

    struct Worker {
        std::array<NodePair, 16>
            pairs; ///< pending ones, as a ring buffer: the oldest is at `found` modulo its size
        std::size_t found = 0;
        std::vector<std::uint32_t>
            non_manifold; ///< nodes that share their hash with others, with repetitions
    };

    /// Returns a collector that no thread uses; if possible, that of the triangles right before `first`. Its
    /// table has the edges at the border, and is in the cache of the thread if this goes from chunk to chunk.
    std::unique_ptr<Collector<Corners, Ends>> take_collector(std::uint64_t first) {
        const std::lock_guard lock(mutex_);
        const auto before = std::find_if(collectors_.begin(), collectors_.end(),
                                         [&](const auto& collector) { return collector->end() == first; });
        if (before != collectors_.end())
            std::swap(*before, collectors_.back());
        if (!collectors_.empty()) {
            std::unique_ptr<Collector<Corners, Ends>> collector = std::move(collectors_.back());
            collectors_.pop_back();
            return collector;
        }
        ++made_;
        assert(made_ <= workers_); // there are numbers for this many
        const std::uint64_t expected = triangles_ * 3 / 2;
        const int table_bits = std::clamp(static_cast<int>(std::bit_width(expected)), 4, 15);
        return std::make_unique<Collector<Corners, Ends>>(graph_, partitions_, *pool_, block_,
                                                          std::size_t{1} << table_bits);
    }

    void join() {
        worker_.resize(workers_);
        partitions_.join(
            executor_, [](std::uint32_t hash) { return hash; },
            [&](std::uint32_t first, std::uint32_t other, unsigned w) {
                // The two nodes and their ends may be anywhere in memory: prefetch them now and use them
                // later.
                Worker& worker = worker_[w];
                __builtin_prefetch(&graph_.nodes[first], 1);
                __builtin_prefetch(&graph_.nodes[other], 1);
                const std::size_t pending = worker.pairs.size();
                if (worker.found >= pending / 2) {
                    const NodePair& half = worker.pairs[(worker.found - pending / 2) % pending];
                    graph_.ends.prefetch(graph_.nodes[half.first].side);
                    graph_.ends.prefetch(graph_.nodes[half.other].side);
                }
                NodePair& oldest = worker.pairs[worker.found % pending];
                if (worker.found >= pending)
                    join_pair(oldest, worker.non_manifold);
                oldest = {first, other};
                ++worker.found;
            });
        for (Worker& worker : worker_) {
            const std::size_t pending = worker.pairs.size();
            for (std::size_t i = worker.found < pending ? 0 : worker.found - pending; i < worker.found; ++i)
                join_pair(worker.pairs[i % pending], worker.non_manifold);
            non_manifold_.insert(non_manifold_.end(), worker.non_manifold.begin(), worker.non_manifold.end());
        }
        // A half may have been recorded before it became part of another node, which then replaces it.
        for (std::uint32_t& id : non_manifold_)
            if (!graph_.nodes[id].in_use())
                id = graph_.nodes[id].split;
    }

    void join_pair(const NodePair& pair, std::vector<std::uint32_t>& non_manifold) {
        const CutNode& a = graph_.nodes[pair.first];
        const CutNode& b = graph_.nodes[pair.other];
        if (!a.in_use()) {
            // It is already part of another node, so the edge has at least three halves.
            non_manifold.insert(non_manifold.end(), {a.split, pair.other});
            return;
        }
        const bool halves = a.entered != b.entered && a.left() != b.left() && a.entered != a.left();
        if (!halves || !(graph_.vertices(pair.first) == graph_.vertices(pair.other))) {
            non_manifold.insert(non_manifold.end(), {pair.first, pair.other});
        } else if (a.entered) {
            unite(pair.first, pair.other);
        } else {
            unite(pair.other, pair.first);
        }
    }

    /// Other nodes link to the entered half, so this half stays and takes the links of the other half. The
    /// other half is then not in use; its `split` becomes the number of the node that it is now part of.
    void unite(std::uint32_t entered_half, std::uint32_t left_half) {
        CutNode& entered = graph_.nodes[entered_half];
        CutNode& left = graph_.nodes[left_half];
        assert(entered.entered && !entered.left() && left.left() && !left.entered);
        assert(entered.last == left.last);
        entered.next_low = left.next_low;
        entered.next_high = left.next_high;
        entered.split = left.split;
        entered.side = left.side;
        left.next_low = left.next_high = no_node;
        left.last = 0;
        left.split = entered_half;
    }

    std::uint64_t triangles_;
    Executor& executor_;
    ProgressMeter& progress_;
    unsigned workers_;
    NodePartitions partitions_;
    LocatedGraph<Ends> graph_;
    std::uint32_t block_ = 0;         // node numbers that a collector takes at once
    std::optional<CutNodePool> pool_; // of the node numbers
    std::mutex mutex_;
    std::vector<std::unique_ptr<Collector<Corners, Ends>>> collectors_; // those that no thread uses
    unsigned made_ = 0;                                                 // collectors
    std::vector<Worker> worker_;
    std::vector<std::uint32_t> non_manifold_; // nodes that share their ends, unordered, with repetitions
};

/// Builds the graph of a mesh in memory. `corners(begin, end)` returns a chunk of its triangles.
template <class Corners, class Ends, class Chunk>
LocatedGraph<Ends> build(std::uint64_t triangles, Ends ends, const Chunk& corners, Executor& executor,
                         ProgressMeter& progress, const RangeVisitor& visit) {
    Builder<Corners, Ends> builder(triangles, std::move(ends), executor, progress);
    const std::uint64_t size =
        std::clamp<std::uint64_t>(triangles / (std::uint64_t{executor.workers()} * 8), 4096, 1U << 16);
    executor.for_chunks(triangles, size, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
        builder.add(corners(begin, end), begin, end - begin, visit);
    });
    return builder.finish();
}

template <class Corners, class Ends>
LocatedGraph<Ends> build(const TriangleSoup& soup, const Ranks& ranks, Executor& executor,
                         ProgressMeter& progress, const RangeVisitor& visit) {
    const auto corners = [&](std::uint64_t begin, std::uint64_t end) {
        return Corners(soup.part(begin, end), ranks);
    };
    return build<Corners>(soup.size(), Ends(soup), corners, executor, progress, visit);
}

} // namespace

LocatedGraph<SoupEnds> build_cut_graph(const TriangleSoup& unplaced, const Ranks& ranks, Executor& executor,
                                       ProgressMeter& progress, const RangeVisitor& visit) {
    return build<FloatCorners, SoupEnds>(unplaced, ranks, executor, progress, visit);
}

LocatedGraph<PlacedEnds> build_placed_cut_graph(const TriangleSoup& soup, const Ranks& ranks,
                                                Executor& executor, ProgressMeter& progress,
                                                const RangeVisitor& visit) {
    return build<PlacedCorners, PlacedEnds>(soup, ranks, executor, progress, visit);
}

LocatedGraph<IndexedEnds> build_cut_graph(const IndexedMesh& mesh, const Ranks& ranks, Executor& executor,
                                          ProgressMeter& progress, const RangeVisitor& visit) {
    PageArray<std::uint32_t> vertex_ranks(mesh.vertices.size());
    executor.for_chunks(mesh.vertices.size(), 1U << 14,
                        [&](std::uint64_t begin, std::uint64_t end, unsigned) {
                            for (std::uint64_t v = begin; v < end; ++v)
                                vertex_ranks[v] = ranks(mesh.vertices[v].z);
                        });
    const auto corners = [&](std::uint64_t begin, std::uint64_t end) {
        return IndexedCorners(std::span(mesh.triangles).subspan(begin, end - begin), vertex_ranks);
    };
    return build<IndexedCorners>(mesh.triangles.size(), IndexedEnds(mesh), corners, executor, progress,
                                 visit);
}

} // namespace lamella
