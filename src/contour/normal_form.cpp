#include "lamella/contour/normal_form.hpp"

#include "lamella/contour/exposure.hpp"
#include "lamella/contour/stack_hash.hpp"

#include "core/pages.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>
#include <utility>
#include <vector>

namespace lamella {

namespace {

static_assert(std::endian::native == std::endian::little, "the content hash reads memory as little-endian");
static_assert(sizeof(Point2) == 2 * sizeof(double), "points are hashed and compared as bytes");

// Plain comparisons are faster than the three-way one: these loops visit every point of every layer.
bool less(const Point2& a, const Point2& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

bool same(const Point2& a, const Point2& b) {
    return a.x == b.x && a.y == b.y;
}

// Returns the smallest rotation of a ring whose smallest point occurs more than once. Two candidate starts i
// and j > i are compared point by point. If they differ after k equal points, the loser and the k starts
// after it are eliminated, because each of them loses to the start at the same distance after the winner. So
// candidates advance by at most 2 n in total.
std::size_t smallest_rotation_with_repeats(std::span<const Point2> ring, std::size_t first,
                                           std::size_t second) {
    const std::size_t n = ring.size();
    assert(first < second && second < n && same(ring[first], ring[second]));
    const auto at = [&](std::size_t i) -> const Point2& {
        return ring[i < n ? i : i - n];
    };
    std::size_t i = first;
    std::size_t j = second;
    std::size_t k = 0;
    while (j < n && k < n) {
        const Point2& a = at(i + k);
        const Point2& b = at(j + k);
        if (same(a, b)) {
            ++k;
            continue;
        }
        if (less(a, b)) {
            j += k + 1;
        } else {
            i = std::max(i + k + 1, j);
            j = i + 1;
        }
        k = 0;
    }
    assert(i < n);
    return i;
}

// The points of a contour in the order of the normal form, without moving them.
class Rotated {
  public:
    Rotated(std::span<const Point2> contour, std::size_t start)
        : front_(contour.subspan(start)), back_(contour.first(start)) {}

    [[nodiscard]] std::size_t size() const { return front_.size() + back_.size(); }
    const Point2& operator[](std::size_t i) const {
        return i < front_.size() ? front_[i] : back_[i - front_.size()];
    }
    Point2* copy_to(Point2* out) const {
        out = std::copy(front_.begin(), front_.end(), out);
        return std::copy(back_.begin(), back_.end(), out);
    }

  private:
    std::span<const Point2> front_;
    std::span<const Point2> back_;
};

template <class Contour>
bool before(const Contour& a, const Contour& b) {
    const std::size_t n = std::min(a.size(), b.size());
    for (std::size_t i = 0; i < n; ++i) {
        if (!same(a[i], b[i]))
            return less(a[i], b[i]);
    }
    return a.size() < b.size();
}

// References to contours of layers; the layers must stay in memory until all contours are copied.
class ContourSet {
  public:
    void add(const Layer& layer) {
        for (std::size_t i = 0; i < layer.contours(); ++i) {
            const std::span<const Point2> contour = layer.contour(i);
            if (layer.closed(i))
                rings_.emplace_back(contour, smallest_rotation(contour));
            else
                chains_.emplace_back(contour, 0);
        }
    }

    // Returns the normal form; index, z, bottom and top are those of `header`.
    Layer laid_out(const Layer& header) && {
        std::size_t size = 0;
        for (std::vector<Rotated>* const group : {&rings_, &chains_}) {
            std::sort(group->begin(), group->end(), before<Rotated>);
            for (const Rotated& contour : *group)
                size += contour.size();
        }
        const auto points = std::make_shared<const PageArray<Point2>>(size);
        Layer layer{.index = header.index, .z = header.z, .bottom = header.bottom, .top = header.top};
        layer.rings = rings_.size();
        layer.offsets.reserve(rings_.size() + chains_.size() + 1);
        Point2* end = points->data();
        for (const std::vector<Rotated>* const group : {&rings_, &chains_})
            for (const Rotated& contour : *group) {
                end = contour.copy_to(end);
                layer.offsets.push_back(static_cast<std::uint64_t>(end - points->data()));
            }
        assert(layer.offsets.back() == size); // all points were copied
        layer.points = PointArray(points, points->data(), size);
        assert(in_normal_form(layer));
        return layer;
    }

  private:
    std::vector<Rotated> rings_;
    std::vector<Rotated> chains_;
};

} // namespace

std::size_t smallest_rotation(std::span<const Point2> ring) noexcept {
    std::size_t best = 0;
    std::size_t repeat = 0; // a later occurrence of the best point; 0: none
    for (std::size_t i = 1; i < ring.size(); ++i) {
        if (ring[i].x > ring[best].x)
            continue;
        if (less(ring[i], ring[best])) {
            best = i;
            repeat = 0;
        } else if (repeat == 0 && same(ring[i], ring[best])) {
            repeat = i;
        }
    }
    return repeat == 0 ? best : smallest_rotation_with_repeats(ring, best, repeat);
}

bool stands_before(std::span<const Point2> a, std::span<const Point2> b) noexcept {
    return before(a, b);
}

bool in_normal_form(const Layer& layer) noexcept {
    for (std::size_t i = 0; i < layer.contours(); ++i) {
        const std::span<const Point2> contour = layer.contour(i);
        if (i > 0 && i != layer.rings && before(contour, layer.contour(i - 1)))
            return false;
        if (layer.closed(i) && smallest_rotation(contour) != 0)
            return false;
    }
    return true;
}

Layer normal_form(Layer layer) {
    if (in_normal_form(layer))
        return layer;

    ContourSet contours;
    contours.add(layer);
    return std::move(contours).laid_out(layer);
}

Layer merged(std::span<const Layer> layers) {
    if (layers.empty())
        return {};
    ContourSet contours;
    for (const Layer& layer : layers)
        contours.add(layer);
    return std::move(contours).laid_out(layers.front());
}

bool same_contours(const Layer& a, const Layer& b) noexcept {
    if (a.rings != b.rings || a.offsets != b.offsets)
        return false;
    // Empty arrays may be null pointers, which must not be passed to memcmp.
    return a.points.empty() || a.points.data() == b.points.data() ||
           std::memcmp(a.points.data(), b.points.data(), a.points.size() * sizeof(Point2)) == 0;
}

namespace {

std::uint64_t hash_of(const Layer& layer, std::span<const Point2> hatches) noexcept {
    assert(layer.offsets.front() == 0 && layer.offsets.back() == layer.points.size());
    XXH3_state_t state;
    XXH3_64bits_reset(&state);
    const std::array<std::uint64_t, 2> counts{layer.contours(), layer.rings};
    XXH3_64bits_update(&state, counts.data(), sizeof counts);
    XXH3_64bits_update(&state, layer.offsets.data() + 1, layer.contours() * sizeof(std::uint64_t));
    XXH3_64bits_update(&state, layer.points.data(), layer.points.size() * sizeof(Point2));
    if (!hatches.empty())
        XXH3_64bits_update(&state, hatches.data(), hatches.size() * sizeof(Point2));
    return XXH3_64bits_digest(&state);
}

} // namespace

std::uint64_t content_hash(const Layer& layer) noexcept {
    return hash_of(layer, {});
}

std::uint64_t content_hash(const Plane& vectors) noexcept {
    assert(vectors.polylines.size() == vectors.hatches.size());
    std::vector<std::uint64_t> hashes;
    for (std::size_t i = 0; i < vectors.parts(); ++i)
        hashes.push_back(hash_of(vectors.polylines[i], vectors.hatches[i].span()));
    return stack_hash(hashes);
}

std::uint64_t stack_hash(std::span<const std::uint64_t> layer_hashes) noexcept {
    return XXH3_64bits(layer_hashes.data(), layer_hashes.size_bytes());
}

} // namespace lamella
