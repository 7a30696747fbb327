#include "slicing/cut_graph.hpp"

#include "lamella/core/error.hpp"

#include "slicing/edge_pairing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

// How the graph is built
//
// 1. Collect. Workers take chunks of consecutive triangles. An edge is looked up in a small table private to
// the
//    worker that stays in its second-level cache: most files have the two triangles of an edge close
//    together. Found: the node is complete. Not found: a new node, known from one side so far, takes the
//    slot; whoever sat there is left to step 2. No thread waits for another, and no memory access leaves the
//    cache but to append.
// 2. Join. Every node has also left a record (hash, id) in one of many partitions, by hash. A partition fits
// the
//    cache; nodes of equal ends meet there. Two halves become one node.
// 3. Pair. Where more than two triangles met in an edge, its links are dealt out anew by geometry
//    (edge_pairing.hpp).

namespace lamella {

namespace {

__extension__ using Wide = unsigned __int128;

std::uint64_t fold(std::uint64_t a, std::uint64_t b) {
    const Wide product = static_cast<Wide>(a) * b;
    return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
}

constexpr std::uint64_t key_a = 0x9E3779B97F4A7C15;
constexpr std::uint64_t key_b = 0xC2B2AE3D27D4EB4F;
constexpr std::uint64_t key_c = 0x165667B19E3779F9;

template <class Ends>
std::uint64_t hash_of(const Ends& ends) {
    std::array<std::uint64_t, (sizeof(Ends) + 7) / 8> words{};
    std::memcpy(words.data(), &ends, sizeof ends);
    std::uint64_t h = key_c;
    for (std::size_t i = 0; i + 1 < words.size(); i += 2)
        h = fold(words[i] ^ key_a ^ h, words[i + 1] ^ key_b);
    if (words.size() % 2 == 1)
        h = fold(words.back() ^ key_a ^ h, key_b);
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

/// What a node leaves behind for the join.
struct Record {
    std::uint32_t tag;
    std::uint32_t node;
};

// Which bits of the hash serve what: the partition the highest, the worker's table the lowest, the tag those
// between. 31 bits of tag leave the join one bit for a mark.
std::uint32_t tag_of(std::uint64_t hash) {
    return static_cast<std::uint32_t>(hash >> 20) & 0x7FFFFFFF;
}

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
        NodePool<Ends> pool(graph_.nodes, static_cast<std::uint32_t>(block));

        collect(pool);
        graph_.count = pool.used();
        join();
        if (!crowded_.empty())
            graph_.nonmanifold_edges = pair_crowded_edges(graph_, crowded_, executor_);
        return std::move(graph_);
    }

  private:
    struct Slot {
        std::uint32_t tag;
        std::uint32_t node;
    };

    struct Worker {
        PageArray<Slot> table; // node + 1, so that zero is empty
        std::vector<std::vector<Record>> partitions;
        typename NodePool<Ends>::Cursor cursor;
    };

    void collect(NodePool<Ends>& pool) {
        // Some 8,192 records make a partition, so that its table stays in the second-level cache.
        const std::uint64_t expected = triangles_ * 3 / 2;
        partition_bits_ = std::clamp(static_cast<int>(std::bit_width(expected >> 13)), 0, 12);
        const auto table_bits = std::clamp(static_cast<int>(std::bit_width(expected)), 4, 15);
        table_mask_ = (1U << table_bits) - 1;

        worker_.resize(workers_);
        const std::uint64_t chunk =
            std::clamp<std::uint64_t>(triangles_ / (std::uint64_t{workers_} * 8), 4096, 1U << 16);
        executor_.for_chunks(triangles_, chunk, [&](std::uint64_t begin, std::uint64_t end, unsigned w) {
            Worker& worker = worker_[w];
            if (worker.table.size() == 0) {
                worker.table = PageArray<Slot>(table_mask_ + std::size_t{1}, Fill::zero);
                worker.partitions.resize(std::size_t{1} << partition_bits_);
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
        const std::uint32_t tag = tag_of(hash);
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
        worker.partitions[partition_bits_ == 0 ? 0 : hash >> (64 - partition_bits_)].push_back({tag, added});
        return added;
    }

    // ------------------------------------------------------------------------------------------------ join

    /// Nodes that turned out to have the same ends.
    struct Meeting {
        std::uint32_t first;
        std::uint32_t second;
    };

    void join() {
        std::vector<std::vector<std::uint32_t>> crowded(workers_);
        executor_.for_chunks(std::uint64_t{1} << partition_bits_, 1,
                             [&](std::uint64_t begin, std::uint64_t end, unsigned w) {
                                 for (std::uint64_t p = begin; p < end; ++p)
                                     join_partition(p, crowded[w]);
                             });
        for (const auto& part : crowded)
            crowded_.insert(crowded_.end(), part.begin(), part.end());
        worker_.clear();
    }

    void join_partition(std::uint64_t p, std::vector<std::uint32_t>& crowded) {
        std::size_t size = 0;
        for (const Worker& worker : worker_)
            size += worker.partitions.empty() ? 0 : worker.partitions[p].size();
        if (size < 2)
            return;

        std::vector<Meeting> meetings;
        std::vector<Meeting> crowds;
        if (!meet_by_tag(p, size, meetings, crowds) || !ends_agree(meetings) || !ends_agree(crowds)) {
            meetings.clear();
            crowds.clear();
            meet_by_sorting(p, meetings, crowds);
        }

        for (const Meeting& meeting : meetings) {
            Node& a = graph_.nodes[meeting.first];
            Node& b = graph_.nodes[meeting.second];
            if (a.entered != b.entered && a.left() != b.left() && a.entered != a.left())
                unite(a.entered ? a : b, a.entered ? b : a);
            else
                crowded.insert(crowded.end(), {meeting.first, meeting.second});
        }
        for (const Meeting& meeting : crowds)
            crowded.insert(crowded.end(), {meeting.first, meeting.second});
    }

    /// Nodes are known by the edges that lead to them, so the entered half stays and takes the other's links.
    static void unite(Node& entered, Node& left) {
        entered.next_low = left.next_low;
        entered.next_high = left.next_high;
        entered.split = left.split;
        entered.triangle = left.triangle;
        left.next_low = left.next_high = no_node;
        left.last = left.first;
    }

    /// Pairs nodes of equal tag: the first two in `meetings`; for any further one its meeting with the first,
    /// and the first pair again, in `crowds`. False when the table got so crowded that somebody must have
    /// meant it.
    bool meet_by_tag(std::uint64_t p, std::size_t size, std::vector<Meeting>& meetings,
                     std::vector<Meeting>& crowds) {
        constexpr std::uint32_t met = 0x80000000;
        constexpr std::uint32_t longest_probe = 128;
        const std::uint32_t mask = static_cast<std::uint32_t>(std::bit_ceil(2 * size)) - 1;
        std::vector<Slot> table(std::size_t{mask} + 1, Slot{0, no_node});
        for (const Worker& worker : worker_) {
            if (worker.partitions.empty())
                continue;
            for (const Record& record : worker.partitions[p]) {
                std::uint32_t at = (record.tag * 0x9E3779B1U) >> 7 & mask;
                for (std::uint32_t probe = 0;; ++probe, at = (at + 1) & mask) {
                    if (probe == longest_probe)
                        return false;
                    Slot& slot = table[at];
                    if (slot.node == no_node) {
                        slot = {record.tag, record.node};
                        break;
                    }
                    if ((slot.tag & ~met) != record.tag)
                        continue;
                    if ((slot.tag & met) == 0) {
                        meetings.push_back({slot.node, record.node});
                        slot = {record.tag | met, static_cast<std::uint32_t>(meetings.size() - 1)};
                    } else {
                        const Meeting& before = meetings[slot.node];
                        crowds.push_back(before);
                        crowds.push_back({before.first, record.node});
                    }
                    break;
                }
            }
        }
        return true;
    }

    bool ends_agree(const std::vector<Meeting>& meetings) const {
        constexpr std::size_t ahead = 16;
        for (std::size_t i = 0; i < meetings.size(); ++i) {
            if (i + ahead < meetings.size()) {
                __builtin_prefetch(&graph_.nodes[meetings[i + ahead].first], 1);
                __builtin_prefetch(&graph_.nodes[meetings[i + ahead].second], 1);
            }
            if (!(graph_.nodes[meetings[i].first].ends == graph_.nodes[meetings[i].second].ends))
                return false;
        }
        return true;
    }

    /// The same by sorting: for partitions that crafted hashes have made too full for a table, and for the
    /// rare tag that two different edges share.
    void meet_by_sorting(std::uint64_t p, std::vector<Meeting>& meetings, std::vector<Meeting>& crowds) {
        std::vector<std::uint32_t> ids;
        for (const Worker& worker : worker_)
            if (!worker.partitions.empty())
                for (const Record& record : worker.partitions[p])
                    ids.push_back(record.node);
        const auto bytes_less = [&](std::uint32_t a, std::uint32_t b) {
            const int order = std::memcmp(&graph_.nodes[a].ends, &graph_.nodes[b].ends, sizeof(Ends));
            return order != 0 ? order < 0 : a < b;
        };
        std::sort(ids.begin(), ids.end(), bytes_less);
        const auto same = [&](std::uint32_t a, std::uint32_t b) {
            return graph_.nodes[a].ends == graph_.nodes[b].ends;
        };
        for (std::size_t i = 0; i + 1 < ids.size();) {
            std::size_t end = i + 1;
            while (end < ids.size() && same(ids[i], ids[end]))
                ++end;
            if (end - i >= 2)
                meetings.push_back({ids[i], ids[i + 1]});
            if (end - i > 2)
                for (std::size_t k = i + 1; k < end; ++k)
                    crowds.push_back({ids[i], ids[k]});
            i = end;
        }
    }

    const Corners& corners_;
    std::uint64_t triangles_;
    Executor& executor_;
    ProgressMeter& progress_;
    unsigned workers_;
    int partition_bits_ = 0;
    std::uint32_t table_mask_ = 0;
    std::vector<Worker> worker_;
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
