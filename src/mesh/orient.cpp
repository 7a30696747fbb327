// Consistent orientation, in four steps:
//
//     flood   starts at the first triangle of each patch, crosses edges of two triangles, and finds the
//             triangles of opposite orientation; the smaller of the two sets is flipped
//     fit     ties the patches at each edge of more triangles: patches that balance there keep their relative
//             orientation; two that would balance if one of them were flipped get opposite orientations
//     close   finds the groups of tied patches that are now closed, and the box around the open edges of
//             the others
//     turn    flips groups as a whole, by their volumes and by the shells that enclose them

#include "lamella/core/error.hpp"
#include "lamella/mesh/repair.hpp"

#include "core/executor.hpp"
#include "core/let_go.hpp"
#include "mesh/box_tree.hpp"
#include "mesh/edge_survey.hpp"
#include "mesh/edge_uses.hpp"
#include "mesh/folds.hpp"
#include "mesh/measures.hpp"
#include "mesh/shells.hpp"
#include "mesh/triangle_contact.hpp"
#include "mesh/union_find.hpp"
#include "mesh/valid_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

namespace lamella {

namespace {

/// If an edge has two triangles, the neighbour over it is stored for each of them as twice the neighbour's
/// number, plus 1 if both triangles use the edge in the same direction.
constexpr std::uint32_t no_neighbour = 0xffffffff;

PageArray<std::uint32_t> find_neighbours(Executor& executor, const IndexedMesh& mesh) {
    PageArray<std::uint32_t> neighbours(3 * mesh.triangles.size());
    executor.for_chunks(neighbours.size(), fold_chunk, [&](std::size_t begin, std::size_t end, unsigned) {
        std::fill(neighbours.data() + begin, neighbours.data() + end, no_neighbour);
    });
    for_each_edge(executor, mesh, [&](std::span<const EdgeUse> uses, unsigned) {
        if (uses.size() != 2)
            return;
        const std::uint32_t against = uses[0].upwards() == uses[1].upwards() ? 1 : 0;
        for (std::size_t k = 0; k < 2; ++k) {
            const auto& t = mesh.triangles[uses[k].triangle];
            const auto ends = ends_of(mesh, uses[k]);
            const std::uint32_t from = uses[k].upwards() ? ends.first : ends.second;
            const std::size_t side = t[0] == from ? 0 : t[1] == from ? 1 : 2;
            neighbours[std::size_t{3} * uses[k].triangle + side] = 2 * uses[1 - k].triangle + against;
        }
    });
    return neighbours;
}

struct Patches {
    Shells shells;             ///< the patches, as if they were shells
    std::vector<bool> flipped; ///< true for flipped triangles
    std::vector<bool> non_orientable;
};

Patches flood(const IndexedMesh& mesh, const PageArray<std::uint32_t>& neighbours) {
    const std::size_t n = mesh.triangles.size();
    Patches patches;
    Shells& shells = patches.shells;
    shells.of_triangle = PageArray<std::uint32_t>(n);
    std::fill(shells.of_triangle.data(), shells.of_triangle.data() + n, no_shell);
    patches.flipped.assign(n, false);
    std::vector<std::uint32_t> members;
    for (std::uint32_t start = 0; start < n; ++start) {
        if (shells.of_triangle[start] != no_shell || degenerate(mesh.triangles[start]))
            continue;
        const auto patch = static_cast<std::uint32_t>(shells.first.size());
        shells.first.push_back(start);
        patches.non_orientable.push_back(false);
        members.assign(1, start);
        shells.of_triangle[start] = patch;
        for (std::size_t next = 0; next < members.size(); ++next) {
            const std::uint32_t i = members[next];
            for (std::size_t side = 0; side < 3; ++side) {
                const std::uint32_t neighbour = neighbours[std::size_t{3} * i + side];
                if (neighbour == no_neighbour)
                    continue;
                const std::uint32_t j = neighbour / 2;
                const bool turn = patches.flipped[i] != (neighbour % 2 != 0);
                if (shells.of_triangle[j] == no_shell) {
                    shells.of_triangle[j] = patch;
                    patches.flipped[j] = turn;
                    members.push_back(j);
                } else if (patches.flipped[j] != turn) {
                    patches.non_orientable[patch] = true;
                }
            }
        }
        if (patches.non_orientable[patch])
            for (const std::uint32_t i : members)
                patches.flipped[i] = false;
    }
    return patches;
}

/// A triangle of a shell in which exactly half of the triangles are flipped.
struct TiedTriangle {
    std::uint32_t shell;
    Triangle3 corners; ///< the lexicographically smallest first
    int way;           ///< 1 if the triangle runs through them in this order, otherwise -1
};

/// Swaps flipped and unflipped triangles in each shell in which more than half of them are flipped. If
/// exactly half are, the lexicographically smallest triangle that does not occur in both orientations
/// decides. So neither the order of triangles nor their first corners matter.
void flip_the_minority(const IndexedMesh& mesh, const Shells& shells, std::vector<bool>& flipped) {
    const std::size_t n = mesh.triangles.size();
    std::vector<std::int64_t> lead(shells.size(), 0);
    for (std::size_t i = 0; i < n; ++i)
        if (const std::uint32_t s = shells.of_triangle[i]; s != no_shell)
            lead[s] += flipped[i] ? 1 : -1;
    std::vector<TiedTriangle> tied;
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t s = shells.of_triangle[i];
        if (s == no_shell || lead[s] != 0)
            continue;
        const Triangle3 t = corners(mesh, i);
        tied.push_back({s, in_order(t), runs_in_order(t) != flipped[i] ? 1 : -1});
    }
    std::sort(tied.begin(), tied.end(), [](const TiedTriangle& a, const TiedTriangle& b) {
        return std::tie(a.shell, a.corners) < std::tie(b.shell, b.corners);
    });
    for (std::size_t begin = 0; begin < tied.size();) {
        const std::uint32_t s = tied[begin].shell;
        const Triangle3& first = tied[begin].corners;
        int way = 0;
        for (; begin < tied.size() && tied[begin].shell == s && tied[begin].corners == first; ++begin)
            way += tied[begin].way;
        if (lead[s] == 0)
            lead[s] = -way;
    }
    for (std::size_t i = 0; i < n; ++i)
        if (const std::uint32_t s = shells.of_triangle[i]; s != no_shell && lead[s] > 0)
            flipped[i] = !flipped[i];
}

using Balance = std::pair<std::uint32_t, int>;

/// Sorts by the first member, replaces entries with equal first members by one with the sum of their second
/// members, and drops sums of 0.
void add_up(std::vector<Balance>& balances) {
    std::sort(balances.begin(), balances.end());
    std::size_t kept = 0;
    for (std::size_t begin = 0; begin < balances.size();) {
        Balance sum{balances[begin].first, 0};
        for (; begin < balances.size() && balances[begin].first == sum.first; ++begin)
            sum.second += balances[begin].second;
        if (sum.second != 0)
            balances[kept++] = sum;
    }
    balances.resize(kept);
}

/// A patch that uses an edge more often in one direction than in the other.
struct UnevenUse {
    VertexPair edge;
    std::uint32_t patch; ///< patch, or the first patch of a group
    int balance;         ///< uses upwards minus uses downwards, not 0
};

/// Returns the uneven uses in ascending order; uses by non-orientable patches are left out.
std::vector<UnevenUse> find_uneven_uses(Executor& executor, const IndexedMesh& mesh, const Patches& patches) {
    std::vector<std::vector<UnevenUse>> found(executor.workers());
    for_each_edge(executor, mesh, [&](std::span<const EdgeUse> uses, unsigned worker) {
        const auto upwards = [&](const EdgeUse& use) {
            return use.upwards() != patches.flipped[use.triangle];
        };
        if (uses.size() == 2 && upwards(uses[0]) != upwards(uses[1]))
            return;
        std::vector<Balance> patches_here;
        for (const EdgeUse& use : uses)
            patches_here.emplace_back(patches.shells.of_triangle[use.triangle], upwards(use) ? 1 : -1);
        add_up(patches_here);
        for (const auto& [patch, balance] : patches_here)
            if (!patches.non_orientable[patch])
                found[worker].push_back({ends_of(mesh, uses[0]), patch, balance});
    });
    std::vector<UnevenUse> all;
    for (std::vector<UnevenUse>& part : found) {
        all.insert(all.end(), part.begin(), part.end());
        let_go(part);
    }
    // Areas are added up in this order, so it must not depend on the workers.
    std::sort(all.begin(), all.end(), [](const UnevenUse& a, const UnevenUse& b) {
        return std::tie(a.edge, a.patch) < std::tie(b.edge, b.patch);
    });
    return all;
}

/// Calls visit(uses) with the uses of each edge.
template <class Visit>
void for_each_uneven_edge(const std::vector<UnevenUse>& uneven, const Visit& visit) {
    for (std::size_t begin = 0; begin < uneven.size();) {
        std::size_t end = begin + 1;
        while (end < uneven.size() && uneven[end].edge == uneven[begin].edge)
            ++end;
        visit(std::span(uneven).subspan(begin, end - begin));
        begin = end;
    }
}

/// Groups of tied patches. Each patch is oriented like the first one of its group, or opposite to it.
class Ties {
  public:
    struct Position {
        std::uint32_t first; ///< identifies the group
        bool against;        ///< true if oriented opposite to the first
    };

    explicit Ties(std::size_t patches) : ways_(2 * patches) {}

    [[nodiscard]] Position position(std::uint32_t patch) const noexcept {
        const std::uint32_t lowest = ways_.find(2 * patch);
        return {lowest / 2, lowest % 2 != 0};
    }

    /// Ties two patches. Returns false if they are already tied with the other relative orientation.
    bool tie(std::uint32_t a, std::uint32_t b, bool against) const noexcept {
        const std::uint32_t turn = against ? 1 : 0;
        if (ways_.find(2 * a) == ways_.find(2 * b + 1 - turn))
            return false;
        ways_.join(2 * a, 2 * b + turn);
        ways_.join(2 * a + 1, 2 * b + 1 - turn);
        return true;
    }

  private:
    UnionFind ways_; ///< 2p is patch p as it is, and 2p + 1 is p flipped
};

/// Returns the balances of an edge by groups of tied patches, each in the orientation of its first patch.
std::vector<Balance> tied_balances(std::span<const UnevenUse> uses, const Ties& ties) {
    std::vector<Balance> all;
    for (const UnevenUse& use : uses) {
        const Ties::Position at = ties.position(use.patch);
        all.emplace_back(at.first, at.against ? -use.balance : use.balance);
    }
    add_up(all);
    return all;
}

/// Ties the patches at each balanced edge with their present orientations. Where exactly two patches or
/// groups would balance if one of them were flipped, ties them with opposite orientations. If such ties
/// contradict one another, none of them is made.
Ties fit(std::size_t patches, const std::vector<UnevenUse>& uneven) {
    Ties ties(patches);
    for_each_uneven_edge(uneven, [&](std::span<const UnevenUse> uses) {
        int sum = 0;
        for (const UnevenUse& use : uses)
            sum += use.balance;
        if (sum == 0)
            for (const UnevenUse& use : uses)
                (void)ties.tie(use.patch, uses[0].patch, false);
    });
    std::vector<std::pair<std::uint32_t, std::uint32_t>> turns;
    for_each_uneven_edge(uneven, [&](std::span<const UnevenUse> uses) {
        const std::vector<Balance> here = tied_balances(uses, ties);
        if (here.size() == 2 && here[0].second == here[1].second)
            turns.emplace_back(here[0].first, here[1].first);
    });
    if (turns.empty())
        return ties;
    Ties together(patches);
    std::vector<std::uint32_t> contradicted;
    for (const auto& [a, b] : turns)
        if (!together.tie(a, b, true))
            contradicted.push_back(a);
    std::vector<bool> refused(patches, false);
    for (const std::uint32_t a : contradicted)
        refused[together.position(a).first] = true;
    for (const auto& [a, b] : turns)
        if (!refused[together.position(a).first])
            (void)ties.tie(a, b, true);
    return ties;
}

/// Returns the groups of tied patches as shells; all are marked closed for now.
Shells tied_shells(const Shells& patches, const Ties& ties) {
    Shells shells;
    shells.of_triangle = PageArray<std::uint32_t>(patches.of_triangle.size());
    std::vector<std::uint32_t> number(patches.size(), no_shell);
    for (std::size_t i = 0; i < patches.of_triangle.size(); ++i) {
        shells.of_triangle[i] = no_shell;
        if (patches.of_triangle[i] == no_shell)
            continue;
        std::uint32_t& shell = number[ties.position(patches.of_triangle[i]).first];
        if (shell == no_shell) {
            shell = static_cast<std::uint32_t>(shells.size());
            shells.first.push_back(static_cast<std::uint32_t>(i));
        }
        shells.of_triangle[i] = shell;
    }
    shells.closed.assign(shells.size(), true);
    return shells;
}

/// Volume of a shell. An open shell is closed by fans from the centre of the box around its open edges.
struct Content {
    ShellContent shell;
    double area = 0; ///< of an open shell
    double fans = 0; ///< total area of its fans

    /// Returns true if the sign of the volume is certain and mostly due to existing triangles, not to fans.
    /// (The limit is below one half, because in a box without a lid that is four times as wide as high the
    /// ratio is exactly half.)
    [[nodiscard]] bool certain() const noexcept {
        return shell.certain() && (fans == 0 || fans < 0.45 * area);
    }
};

/// Marks the shells that are not closed, and measures all of them.
std::vector<Content> measure_shells(Executor& executor, const IndexedMesh& mesh,
                                    const std::vector<Box3>& boxes, const std::vector<UnevenUse>& uneven,
                                    const Shells& patches, const Ties& ties, Shells& shells) {
    std::vector<UnevenUse> open; // of shells
    for_each_uneven_edge(uneven, [&](std::span<const UnevenUse> uses) {
        for (const Balance& balance : tied_balances(uses, ties))
            open.push_back({uses[0].edge, shells.of_triangle[patches.first[balance.first]], balance.second});
    });
    std::vector<Box3> around(shells.size());
    for (const auto& [edge, shell, balance] : open) {
        shells.closed[shell] = false;
        around[shell].add(mesh.vertices[edge.first]);
        around[shell].add(mesh.vertices[edge.second]);
    }
    std::vector<Point3> origins;
    for (std::size_t s = 0; s < shells.size(); ++s)
        origins.push_back(middle(shells.closed[s] ? boxes[s] : around[s]));

    std::vector<Content> contents;
    for (const ShellContent& content : shell_contents(executor, mesh, shells, origins))
        contents.push_back({content});
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (const std::uint32_t s = shells.of_triangle[i]; s != no_shell && !shells.closed[s])
            contents[s].area += area(in_order(corners(mesh, i)));
    for (const auto& [edge, shell, balance] : open)
        contents[shell].fans +=
            std::abs(balance) * area({mesh.vertices[edge.first], mesh.vertices[edge.second], origins[shell]});
    return contents;
}

bool holds(const Box3& outer, const Box3& inner) noexcept {
    Box3 both = outer;
    both.add(inner);
    return both == outer;
}

using ShellPair = std::pair<std::uint32_t, std::uint32_t>;

/// Returns pairs (inner, outer) of the involved shells that have points in common, where the outer shell is
/// closed and its box contains the inner box. The value is true if triangles cross. Shared vertices count as
/// common points.
std::map<ShellPair, bool> find_contacts(Executor& executor, const IndexedMesh& mesh, const Shells& shells,
                                        const std::vector<Box3>& boxes, const std::vector<bool>& involved) {
    Box3 box;
    for (std::size_t s = 0; s < shells.size(); ++s)
        if (involved[s])
            box.add(boxes[s]);
    const BoxTree tree(executor, mesh, box, [&](std::uint32_t i) {
        const std::uint32_t s = shells.of_triangle[i];
        return s != no_shell && involved[s] && !flat(corners(mesh, i));
    });
    std::vector<std::map<ShellPair, bool>> found(executor.workers());
    const auto compare = [&](std::uint32_t a, std::uint32_t b, unsigned worker) {
        ShellPair pair{shells.of_triangle[a], shells.of_triangle[b]};
        if (pair.first == pair.second)
            return;
        const auto may_lie = [&](std::uint32_t inner, std::uint32_t outer) {
            return shells.closed[outer] && holds(boxes[outer], boxes[inner]);
        };
        const bool first = may_lie(pair.first, pair.second);
        const bool second = may_lie(pair.second, pair.first);
        if (!first && !second)
            return;
        const std::optional<IntersectionKind> kind =
            contact({corners(mesh, a), {0, 1, 2}}, {corners(mesh, b), {3, 4, 5}});
        if (!kind)
            return;
        if (first)
            found[worker][pair] |= *kind == IntersectionKind::crossing;
        if (second)
            found[worker][{pair.second, pair.first}] |= *kind == IntersectionKind::crossing;
    };
    executor.for_chunks(tree.leaves(), 256, [&](std::size_t begin, std::size_t end, unsigned worker) {
        for (std::size_t leaf = begin; leaf < end && !executor.stopping(); ++leaf)
            tree.close_to_leaf(leaf, [&](std::size_t point_a, std::size_t point_b) {
                compare(tree.triangle(point_a), tree.triangle(point_b), worker);
            });
    });
    executor.check_cancelled();
    std::map<ShellPair, bool> all;
    for (const std::map<ShellPair, bool>& part : found)
        for (const auto& [pair, crossing] : part)
            all[pair] |= crossing;
    return all;
}

/// The orientation that a shell should get.
enum class Sense : std::uint8_t { as_it_is, outward, inward };

/// Finds the orientations of the shells in `asked`.
std::vector<Sense> find_senses(Executor& executor, const IndexedMesh& mesh, const Shells& shells,
                               const std::vector<Box3>& boxes, const std::vector<bool>& asked) {
    const std::size_t count = shells.size();
    std::vector<std::uint32_t> depth(count, 0);
    std::vector<bool> involved(count, false);
    bool any = false;
    const auto for_each_closed = [&](const std::vector<bool>& inner, const auto& visit) {
        for_each_enclosure(executor, mesh, shells, boxes, inner, [&](const Enclosure& enclosure) {
            if (shells.closed[enclosure.encloser] && holds(boxes[enclosure.encloser], boxes[enclosure.shell]))
                visit(enclosure.shell, enclosure.encloser);
        });
    };
    if (count > 1)
        for_each_closed(asked, [&](std::uint32_t shell, std::uint32_t encloser) {
            ++depth[shell];
            involved[shell] = involved[encloser] = any = true;
        });
    // So far only one point of each shell was examined. If surfaces meet, other points may be on the other
    // side.
    std::vector<bool> touching(count, false);
    if (any) {
        const std::map<ShellPair, bool> contacts = find_contacts(executor, mesh, shells, boxes, involved);
        std::vector<bool> again(count, false);
        for (const auto& contact : contacts)
            again[contact.first.first] = asked[contact.first.first];
        if (!contacts.empty())
            for_each_closed(again, [&](std::uint32_t shell, std::uint32_t encloser) {
                const auto contact = contacts.find({shell, encloser});
                if (contact == contacts.end())
                    return;
                if (contact->second)
                    --depth[shell];
                else
                    touching[shell] = true;
            });
    }
    std::vector<Sense> senses(count, Sense::as_it_is);
    for (std::size_t s = 0; s < count; ++s)
        if (asked[s] && !touching[s])
            senses[s] = depth[s] % 2 != 0 ? Sense::inward : Sense::outward;
    return senses;
}

IndexedMesh flipped_where(IndexedMesh mesh, const std::vector<bool>& flipped) {
    for (std::size_t i = 0; i < flipped.size(); ++i)
        if (flipped[i])
            std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
    return mesh;
}

/// Flips shells as a whole if the sign of their volume is certain.
void flip_by_volume(Executor& executor, const IndexedMesh& mesh, Patches& patches,
                    const std::vector<UnevenUse>& uneven, const Ties& ties, Shells& shells,
                    OrientedMesh& result) {
    const IndexedMesh now = flipped_where(mesh, patches.flipped);
    const std::vector<Box3> boxes = shell_boxes(now, shells);
    const std::vector<Content> contents =
        measure_shells(executor, now, boxes, uneven, patches.shells, ties, shells);
    std::vector<bool> asked;
    for (const Content& content : contents)
        asked.push_back(content.certain());
    for (std::size_t p = 0; p < patches.shells.size(); ++p)
        if (const std::uint32_t s = shells.of_triangle[patches.shells.first[p]]; patches.non_orientable[p])
            asked[s] = shells.closed[s] = false;
    const std::vector<Sense> senses = find_senses(executor, now, shells, boxes, asked);
    const auto turns = [&](std::uint32_t s) {
        return senses[s] == (contents[s].shell.six_volumes < 0 ? Sense::outward : Sense::inward);
    };
    for (std::size_t i = 0; i < now.triangles.size(); ++i)
        if (const std::uint32_t s = shells.of_triangle[i]; s != no_shell && turns(s))
            patches.flipped[i] = !patches.flipped[i];
    for (const std::uint32_t first : patches.shells.first)
        if (const std::uint32_t s = shells.of_triangle[first]; turns(s))
            ++(senses[s] == Sense::inward ? result.flipped_inward : result.flipped_outward);
}

} // namespace

OrientedMesh orient(const IndexedMesh& mesh, const Execution& execution) {
    const std::size_t n = mesh.triangles.size();
    if (n > 0x7fffffff)
        throw Error(ErrorKind::limit,
                    fmt::format("cannot orient {} triangles: at most {} can be indexed", n, 0x7fffffff));
    Executor executor(execution);
    check(mesh, executor);
    Patches patches = flood(mesh, find_neighbours(executor, mesh));
    const std::size_t count = patches.shells.size();
    const std::vector<std::uint32_t>& first = patches.shells.first;
    std::vector<bool>& flipped = patches.flipped;
    flip_the_minority(mesh, patches.shells, flipped);
    std::vector<UnevenUse> uneven = find_uneven_uses(executor, mesh, patches);

    OrientedMesh result;
    result.patches = count;
    for (std::size_t settled = 0;;) {
        const Ties ties = fit(count, uneven);
        Shells shells = tied_shells(patches.shells, ties);
        if (shells.size() == settled)
            break; // the last flips allow no further ties
        std::vector<bool> before;
        bool fitted = false;
        for (std::size_t p = 0; p < count; ++p) {
            before.push_back(flipped[first[p]]);
            fitted = fitted || ties.position(static_cast<std::uint32_t>(p)).against;
        }
        for (std::size_t i = 0; i < n; ++i)
            if (const std::uint32_t p = patches.shells.of_triangle[i];
                p != no_shell && ties.position(p).against)
                flipped[i] = !flipped[i];
        flip_the_minority(mesh, shells, flipped);
        if (!fitted) {
            settled = shells.size();
            result.flipped_outward = result.flipped_inward = 0; // only the flips of the largest groups count
            flip_by_volume(executor, mesh, patches, uneven, ties, shells, result);
        }
        for (UnevenUse& use : uneven)
            if (flipped[first[use.patch]] != before[use.patch])
                use.balance = -use.balance;
    }

    result.non_orientable_patches = static_cast<std::uint64_t>(
        std::count(patches.non_orientable.begin(), patches.non_orientable.end(), true));
    result.mesh = flipped_where(mesh, flipped);
    for (std::size_t i = 0; i < n; ++i)
        if (flipped[i]) {
            ++result.flipped_triangles;
            if (result.locations.size() < repair_locations)
                result.locations.push_back(middle(corners(mesh, i)));
        }
    return result;
}

} // namespace lamella
