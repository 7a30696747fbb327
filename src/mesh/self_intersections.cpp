#include "lamella/mesh/self_intersections.hpp"

#include "core/executor.hpp"
#include "core/pages.hpp"
#include "mesh/box_tree.hpp"
#include "mesh/edge_uses.hpp"
#include "mesh/folds.hpp"
#include "mesh/triangle_contact.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace lamella {

namespace {

struct Pair {
    std::uint32_t a;
    std::uint32_t b;
    Contact contact;

    friend bool operator<(const Pair& p, const Pair& q) noexcept {
        return std::pair(p.a, p.b) < std::pair(q.a, q.b);
    }
};

/// The lowest few of all pairs that are added.
class FirstPairs {
  public:
    void add(const Pair& pair, std::size_t keep) {
        if (pairs_.size() >= keep) {
            if (keep == 0 || !(pair < pairs_.front()))
                return;
            std::pop_heap(pairs_.begin(), pairs_.end());
            pairs_.pop_back();
        }
        pairs_.push_back(pair);
        std::push_heap(pairs_.begin(), pairs_.end());
    }
    [[nodiscard]] const std::vector<Pair>& pairs() const noexcept { return pairs_; }

  private:
    std::vector<Pair> pairs_; ///< a heap with the last of them on top
};

/// Of pairs of parts; without parts, all triangles are of part 0.
struct Found {
    FirstPairs through; ///< that cross or overlap
    FirstPairs beside;  ///< that touch
    std::map<std::pair<std::uint32_t, std::uint32_t>, PartMeetings> parts;

    void add(const Pair& pair, const MeetingOptions& options) {
        (pair.contact == Contact::touching ? beside : through).add(pair, options.keep);
        const auto part_of = [&](std::uint32_t triangle) {
            return options.parts.empty() ? 0U : options.parts[triangle];
        };
        const auto [a, b] = std::minmax({part_of(pair.a), part_of(pair.b)});
        PartMeetings& meetings = parts[{a, b}];
        meetings.part_a = a;
        meetings.part_b = b;
        ++(pair.contact == Contact::crossing      ? meetings.crossing
           : pair.contact == Contact::overlapping ? meetings.overlapping
                                                  : meetings.touching);
    }
};

NamedTriangle named(const IndexedMesh& mesh, std::uint32_t i) {
    return {corners(mesh, i), mesh.triangles[i]};
}

Meeting described(const IndexedMesh& mesh, const Pair& pair) {
    const MeetingKind kind = pair.contact == Contact::crossing      ? MeetingKind::crossing
                             : pair.contact == Contact::overlapping ? MeetingKind::overlapping
                                                                    : MeetingKind::touching;
    return {pair.a, pair.b, kind,
            contact_place(named(mesh, pair.a).corners, named(mesh, pair.b).corners, pair.contact)};
}

} // namespace

SelfIntersections find_self_intersections(const IndexedMesh& mesh, const MeetingOptions& options,
                                          const Execution& execution) {
    Executor executor(execution);
    SelfIntersections result;
    const std::size_t n = mesh.triangles.size();

    const PageArray<std::uint8_t> without_area(n, Fill::zero);
    const auto piece = [&](std::size_t begin, std::size_t end) {
        std::uint64_t count = 0;
        for (std::size_t i = begin; i < end; ++i)
            if (degenerate(mesh.triangles[i]) || flat(named(mesh, static_cast<std::uint32_t>(i)).corners)) {
                without_area[i] = 1;
                ++count;
            }
        return count;
    };
    result.flat_triangles = fold(executor, n, std::uint64_t{0}, piece,
                                 [](std::uint64_t& total, std::uint64_t count) { total += count; });

    const BoxTree tree(executor, mesh, bounding_box(mesh, execution),
                       [&](std::uint32_t i) { return without_area[i] == 0; });
    std::vector<Found> found(executor.workers());
    constexpr std::size_t leaves_at_once = 256;
    const auto search = [&](std::size_t first_leaf, std::size_t last_leaf, unsigned worker) {
        std::vector<ContactSeeker> seekers;
        for (std::size_t leaf = first_leaf; leaf < last_leaf && !executor.stopping(); ++leaf) {
            const auto [begin, end] = tree.places(leaf);
            seekers.clear();
            for (std::size_t place = begin; place < end; ++place)
                seekers.emplace_back(named(mesh, tree.triangle(place)));
            tree.close_to_leaf(leaf, [&, first = begin](std::size_t place_a, std::size_t place_b) {
                const std::uint32_t a = tree.triangle(place_a);
                const std::uint32_t b = tree.triangle(place_b);
                const Contact contact = seekers[place_a - first].with(named(mesh, b));
                if (contact != Contact::none)
                    found[worker].add({std::min(a, b), std::max(a, b), contact}, options);
            });
        }
    };
    executor.for_chunks(tree.leaves(), leaves_at_once, search);
    executor.check_cancelled();

    Found all;
    for (const Found& part : found) {
        for (const Pair& pair : part.through.pairs())
            all.through.add(pair, options.keep);
        for (const Pair& pair : part.beside.pairs())
            all.beside.add(pair, options.keep);
        for (const auto& [key, meetings] : part.parts) {
            PartMeetings& sum = all.parts[key];
            sum.part_a = meetings.part_a;
            sum.part_b = meetings.part_b;
            sum.crossing += meetings.crossing;
            sum.overlapping += meetings.overlapping;
            sum.touching += meetings.touching;
        }
    }
    for (const FirstPairs* some : {&all.through, &all.beside}) {
        std::vector<Pair> pairs = some->pairs();
        std::sort(pairs.begin(), pairs.end());
        for (const Pair& pair : pairs)
            result.first.push_back(described(mesh, pair));
    }
    for (const auto& [key, meetings] : all.parts) {
        result.crossing += meetings.crossing;
        result.overlapping += meetings.overlapping;
        result.touching += meetings.touching;
        if (!options.parts.empty())
            result.parts.push_back(meetings);
    }
    return result;
}

} // namespace lamella
