#include "polygon/moved_bodies.hpp"

#include "lamella/contour/normal_form.hpp"

#include "polygon/overlay.hpp"
#include "polygon/reversed_rings.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella {

namespace {

// Why halves can be united. Let M be the winding number of some bodies before the move, 0 or 1 as bodies do
// not overlap, and S >= 0 that of the strips and wedges of their rings (without the parts that short cuts
// remove). Let W be the winding number of their moved rings.
// - Growing: W = M + S >= 0, and a sum of such numbers is above 0 where one of them is. So W can be replaced
//   by 1 where it is above 1.
// - Shrinking: W = M - S. Of two halves, W + V is above 0 only where one is 1 and the other 0: a point of a
//   body of one half is in no body of the other one, so strips make a number there below 0. So W can be
//   replaced by -1 where it is below -1, and is never above 1.
// Hence a half is given by the boundary of the points with W > 0 and the reversed boundary of the points with
// W < 0, and both rings together wind around a point at most once in either direction.
//
// Why few crossings are left. The points within a distance of convex bodies that do not overlap are
// pseudo-discs: the boundary of the union of n of them has O(n) corners (Kedem, Livne, Pach, Sharir 1986).
// The crossings of two such unions are corners of the union of both.

/// Sums up the moved rings of bodies.
class Halves {
  public:
    Halves(bool shrinks, const LayerLimits& limits) : shrinks_(shrinks), limits_(limits) {}

    /// Returns rings whose winding numbers are above 0 where those of all rings together are.
    [[nodiscard]] Layer sum(std::span<const Layer> bodies) const {
        if (bodies.size() == 1)
            return bodies.front();
        const std::size_t half = bodies.size() / 2;
        return merged(std::array{half_of(sum(bodies.first(half))), half_of(sum(bodies.subspan(half)))});
    }

  private:
    /// Returns rings with the same signs of winding numbers, which are -1, 0 or 1.
    [[nodiscard]] Layer half_of(const Layer& rings) const {
        Layer above = united(rings, limits_);
        if (!shrinks_)
            return above;
        const Layer below = united(with_rings_reversed(rings), limits_);
        return merged(std::array{std::move(above), with_rings_reversed(below)});
    }

    bool shrinks_;
    const LayerLimits& limits_;
};

} // namespace

Layer united_by_halves(const Layer& moved, std::span<const Polygon> bodies, double distance,
                       const LayerLimits& limits) {
    std::vector<Layer> layers;
    for (const Polygon& body : bodies) {
        LayerBuilder builder;
        builder.add_contour(moved.contour(body.outer), true);
        for (const std::uint32_t hole : body.holes)
            builder.add_contour(moved.contour(hole), true);
        Layer layer = builder.finish(moved.index, moved.z, moved.bottom, moved.top);
        if (!layer.points.empty())
            layers.push_back(normal_form(std::move(layer)));
    }
    // From left to right, whatever the order of the rings.
    std::sort(layers.begin(), layers.end(), [](const Layer& a, const Layer& b) {
        return std::lexicographical_compare(a.points.begin(), a.points.end(), b.points.begin(),
                                            b.points.end());
    });
    if (layers.empty())
        return {.index = moved.index, .z = moved.z, .bottom = moved.bottom, .top = moved.top};
    return united(Halves(distance < 0, limits).sum(layers), limits);
}

} // namespace lamella
