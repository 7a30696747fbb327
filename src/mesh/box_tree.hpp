#pragma once

// A tree of boxes (BVH) over triangles in the order of a space-filling curve, for finding close triangles.
//
// Boxes are stored in single precision, relative to the box of the whole mesh. The conversion (subtract,
// multiply, round) preserves the order of numbers. So boxes that overlap still overlap afterwards; no overlap
// is missed.

#include "lamella/mesh/indexed_mesh.hpp"

#include "core/executor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella {

class BoxTree {
  public:
    /// Builds the tree of the triangles i < `triangles` for which use(i) is true; corners(i) returns their
    /// corners, within `box`.
    template <class Corners, class Use>
    BoxTree(Executor& executor, std::size_t triangles, const Box3& box, const Corners& corners,
            const Use& use);
    /// Builds the tree of some triangles of a mesh, whose vertex indices must all be valid.
    template <class Use>
    BoxTree(Executor& executor, const IndexedMesh& mesh, const Box3& box, const Use& use)
        : BoxTree(
              executor, mesh.triangles.size(), box, [&](std::uint32_t i) { return corners(mesh, i); }, use) {}

    /// Number of leaves; a leaf has up to `leaf_size` positions.
    [[nodiscard]] std::size_t leaves() const noexcept { return levels_.empty() ? 0 : levels_[0].size(); }
    /// The triangle at a position in the order of the curve.
    [[nodiscard]] std::uint32_t triangle(std::size_t position) const noexcept { return order_[position]; }

    /// The positions of a leaf, as a half-open interval.
    [[nodiscard]] std::pair<std::size_t, std::size_t> positions(std::size_t leaf) const noexcept {
        return {leaf * leaf_size, std::min((leaf + 1) * leaf_size, order_.size())};
    }
    /// Calls visit(point_a, point_b) for the positions of overlapping boxes with point_a < point_b and
    /// point_a in the leaf.
    template <class Visit>
    void close_to_leaf(std::size_t leaf, const Visit& visit) const;
    /// Calls visit(triangle) for all triangles whose boxes the plane meets, and for some whose boxes it
    /// almost meets. The normal must not be 0.
    template <class Visit>
    void near_plane(const Point3& origin, const Point3& normal, const Visit& visit) const;

  private:
    struct Bounds {
        std::array<float, 3> min{2, 2, 2};
        std::array<float, 3> max{-1, -1, -1};

        void add(const Bounds& other) noexcept {
            for (std::size_t k = 0; k < 3; ++k) {
                min[k] = std::min(min[k], other.min[k]);
                max[k] = std::max(max[k], other.max[k]);
            }
        }
        [[nodiscard]] bool overlaps(const Bounds& other) const noexcept {
            // No branches, because it is unpredictable which of the six comparisons decides.
            int apart = 0;
            for (std::size_t k = 0; k < 3; ++k)
                apart |= static_cast<int>(min[k] > other.max[k]) | static_cast<int>(other.min[k] > max[k]);
            return apart == 0;
        }
    };
    static constexpr std::size_t leaf_size = 4;
    static constexpr std::size_t children = 4;
    static constexpr std::size_t chunk = std::size_t{1} << 14;

    /// Coordinates relative to the whole box, from 0 to 1.
    struct Frame {
        std::array<double, 3> low{};
        double scale = 0;

        explicit Frame(const Box3& box) : low{box.min.x / 4, box.min.y / 4, box.min.z / 4} {
            const double extent =
                std::max({box.max.x / 4 - low[0], box.max.y / 4 - low[1], box.max.z / 4 - low[2]});
            scale = extent > 1e-300 ? 1 / extent : 0;
        }
        [[nodiscard]] double exact(double x, std::size_t axis) const noexcept {
            return (x / 4 - low[axis]) * scale;
        }
        [[nodiscard]] float position(double x, std::size_t axis) const noexcept {
            return static_cast<float>(exact(x, axis));
        }
    };

    /// Interleaves the bits of three numbers of 21 bits (Morton order).
    static std::uint64_t curve_position(const Bounds& bounds) noexcept {
        std::uint64_t code = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const float middle = (bounds.min[k] + bounds.max[k]) / 2;
            auto v = static_cast<std::uint64_t>(std::clamp(middle, 0.0F, 1.0F) * 0x1fffff);
            v = (v | v << 32) & 0x1f00000000ffff;
            v = (v | v << 16) & 0x1f0000ff0000ff;
            v = (v | v << 8) & 0x100f00f00f00f00f;
            v = (v | v << 4) & 0x10c30c30c30c30c3;
            v = (v | v << 2) & 0x1249249249249249;
            code |= v << k;
        }
        return code;
    }

    Frame frame_;
    std::vector<std::uint32_t> order_;
    std::vector<Bounds> boxes_;               ///< by position
    std::vector<std::vector<Bounds>> levels_; ///< leaves first; the last one has one box
};

template <class Corners, class Use>
BoxTree::BoxTree(Executor& executor, std::size_t triangles, const Box3& box, const Corners& corners,
                 const Use& use)
    : frame_(box) {
    const auto bounds_of = [&](std::uint32_t i) {
        Bounds bounds;
        for (const Point3& p : corners(i)) {
            const std::array at{frame_.position(p.x, 0), frame_.position(p.y, 1), frame_.position(p.z, 2)};
            bounds.add({at, at});
        }
        return bounds;
    };
    std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted;
    for (std::uint32_t i = 0; i < triangles; ++i)
        if (use(i))
            sorted.emplace_back(0, i);
    executor.for_chunks(sorted.size(), chunk, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i)
            sorted[i].first = curve_position(bounds_of(sorted[i].second));
    });
    std::sort(sorted.begin(), sorted.end());
    order_.resize(sorted.size());
    boxes_.resize(sorted.size());
    executor.for_chunks(sorted.size(), chunk, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            order_[i] = sorted[i].second;
            boxes_[i] = bounds_of(sorted[i].second);
        }
    });
    const auto grouped = [](const std::vector<Bounds>& below, std::size_t size) {
        std::vector<Bounds> level((below.size() + size - 1) / size);
        for (std::size_t i = 0; i < below.size(); ++i)
            level[i / size].add(below[i]);
        return level;
    };
    if (boxes_.empty())
        return;
    levels_.push_back(grouped(boxes_, leaf_size));
    while (levels_.back().size() > 1)
        levels_.push_back(grouped(levels_.back(), children));
}

template <class Visit>
void BoxTree::close_to_leaf(std::size_t leaf, const Visit& visit) const {
    const Bounds& mine = levels_[0][leaf];
    const auto mine_at = positions(leaf);
    const auto compare_with = [&](std::size_t other) {
        const auto [from, to] = positions(other);
        for (std::size_t a = mine_at.first; a < mine_at.second; ++a) {
            if (other != leaf && !boxes_[a].overlaps(levels_[0][other]))
                continue;
            for (std::size_t b = std::max(a + 1, from); b < to; ++b)
                if (boxes_[a].overlaps(boxes_[b]))
                    visit(a, b);
        }
    };
    // A node is (level, number); only leaves from `leaf` on are visited.
    std::array<std::pair<std::uint32_t, std::size_t>, children * 24> stack; // 4^24 leaves at most
    std::size_t size = 0;
    stack[size++] = {static_cast<std::uint32_t>(levels_.size() - 1), 0};
    while (size > 0) {
        const auto [level, number] = stack[--size];
        if (level == 0) {
            compare_with(number);
            continue;
        }
        const std::vector<Bounds>& below = levels_[level - 1];
        const std::size_t first_wanted = leaf >> (2 * (level - 1));
        const std::size_t last = std::min((number + 1) * children, below.size());
        for (std::size_t child = std::max(number * children, first_wanted); child < last; ++child)
            if (mine.overlaps(below[child]))
                stack[size++] = {level - 1, child};
    }
}

template <class Visit>
void BoxTree::near_plane(const Point3& origin, const Point3& normal, const Visit& visit) const {
    if (levels_.empty())
        return;
    const double longest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
    const std::array n{normal.x / longest, normal.y / longest, normal.z / longest};
    const std::array at{frame_.exact(origin.x, 0), frame_.exact(origin.y, 1), frame_.exact(origin.z, 2)};
    const auto meets = [&](const Bounds& box) {
        // The plane is tested in double precision against boxes in single precision, which lie in [0, 1].
        constexpr double rounding = 1e-6;
        double from_middle = 0;
        double reach = rounding;
        for (std::size_t k = 0; k < 3; ++k) {
            const double low = static_cast<double>(box.min[k]) - at[k];
            const double high = static_cast<double>(box.max[k]) - at[k];
            from_middle += n[k] * (low + high);
            reach += std::abs(n[k]) * (high - low);
            reach += 1e-15 * std::abs(at[k]);
        }
        return std::abs(from_middle) <= reach;
    };
    std::array<std::pair<std::uint32_t, std::size_t>, children * 24> stack; // 4^24 leaves at most
    std::size_t size = 0;
    stack[size++] = {static_cast<std::uint32_t>(levels_.size() - 1), 0};
    while (size > 0) {
        const auto [level, number] = stack[--size];
        if (!meets(levels_[level][number]))
            continue;
        if (level == 0) {
            const auto [from, to] = positions(number);
            for (std::size_t position = from; position < to; ++position)
                if (meets(boxes_[position]))
                    visit(order_[position]);
            continue;
        }
        const std::size_t last = std::min((number + 1) * children, levels_[level - 1].size());
        for (std::size_t child = number * children; child < last; ++child)
            stack[size++] = {level - 1, child};
    }
}

} // namespace lamella
