// The rows are visited from the top down. In each of them, bright pixels form intervals, whose ends are
// vertical edges. An edge continues while the next row has the same end of an interval; a side is such an
// edge in its whole length. Where sides begin and end, on the line between two rows, they are connected in
// pairs by horizontal edges: along the line, the rows differ between the first and the second of these
// places, are equal between the second and the third, and so on. Thus each corner is the end of one side and
// of one horizontal edge, and no corner is collinear with its neighbours.

#include "raster/outlines.hpp"

#include "lamella/contour/normal_form.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

namespace lamella {

namespace {

/// An end of an interval of bright pixels in consecutive rows, from row `top` up to `bottom`.
struct OutlineSide {
    std::uint32_t column = 0;
    std::uint32_t top = 0;
    std::uint32_t bottom = 0;
    bool left = false;    ///< bright pixels are to its right
    std::size_t next = 0; ///< the side that follows in the ring
};

class OutlineSweep {
  public:
    OutlineSweep(const RunImage& image, std::uint8_t threshold) : image_(image), threshold_(threshold) {}

    void run() {
        std::vector<std::uint32_t> ends; // of the intervals of a row
        for (std::uint32_t row = 0; row < image_.height;) {
            const std::uint32_t times = take_row(row, ends);
            move_to(row, ends);
            found_.count += pixels_of(ends) * times;
            row += times;
        }
        ends.clear();
        move_to(image_.height, ends);
        found_.corners = 2 * std::uint64_t{sides_.size()};
    }

    [[nodiscard]] const BrightPixels& found() const noexcept { return found_; }
    [[nodiscard]] const std::vector<OutlineSide>& sides() const noexcept { return sides_; }

  private:
    static std::uint64_t pixels_of(const std::vector<std::uint32_t>& ends) {
        std::uint64_t pixels = 0;
        for (std::size_t i = 0; i < ends.size(); i += 2)
            pixels += ends[i + 1] - ends[i];
        return pixels;
    }

    /// Finds the ends of the intervals of a row, and returns the number of rows that are known to be equal.
    std::uint32_t take_row(std::uint32_t row, std::vector<std::uint32_t>& ends) {
        ends.clear();
        const std::uint64_t begin = std::uint64_t{row} * image_.width;
        const std::uint64_t end = begin + image_.width;
        assert(next_ < image_.runs.size());
        if (const ImageRun& run = image_.runs[next_]; run.end >= end + image_.width) {
            if (run.value >= threshold_)
                ends = {0, image_.width};
            const std::uint64_t rows = (run.end - begin) / image_.width;
            if (run.end == begin + rows * image_.width)
                ++next_;
            return static_cast<std::uint32_t>(rows);
        }
        for (std::uint64_t at = begin; at < end;) {
            const ImageRun& run = image_.runs[next_];
            const std::uint64_t to = std::min(run.end, end);
            if (run.value >= threshold_) {
                if (!ends.empty() && ends.back() == at - begin)
                    ends.back() = static_cast<std::uint32_t>(to - begin);
                else
                    ends.insert(ends.end(), {static_cast<std::uint32_t>(at - begin),
                                             static_cast<std::uint32_t>(to - begin)});
            }
            at = to;
            if (to == run.end)
                ++next_;
        }
        return 1;
    }

    /// Ends and begins sides on the line above this row, which has these ends of intervals.
    void move_to(std::uint32_t row, const std::vector<std::uint32_t>& ends) {
        if (!ends.empty()) {
            found_.top = std::min(found_.top, row);
            found_.left = std::min(found_.left, ends.front());
            found_.right = std::max(found_.right, ends.back());
        } else if (!open_.empty()) {
            found_.bottom = row;
        }
        still_open_.clear();
        std::size_t old = 0;
        for (std::size_t i = 0; i < ends.size() || old < open_.size();) {
            const bool more = old < open_.size();
            const bool left = i % 2 == 0;
            if (i < ends.size() && more && sides_[open_[old]].column == ends[i] &&
                sides_[open_[old]].left == left) {
                still_open_.push_back(open_[old++]);
                ++i;
            } else if (more && (i == ends.size() || ends_first(sides_[open_[old]], ends[i]))) {
                sides_[open_[old]].bottom = row;
                connect(open_[old], !sides_[open_[old]].left);
                ++old;
            } else {
                still_open_.push_back(sides_.size());
                sides_.push_back({.column = ends[i], .top = row, .bottom = row, .left = left});
                connect(sides_.size() - 1, left);
                ++i;
            }
        }
        assert(!has_half_);
        std::swap(open_, still_open_);
    }

    /// Returns whether a side that ends on a line comes before one that begins there at this column. At a
    /// corner where pixels touch, the one with its pixels on the left comes first: then each of the two
    /// horizontal edges bounds the same pixel as the side that it is connected with.
    static bool ends_first(const OutlineSide& side, std::uint32_t column) {
        return side.column != column ? side.column < column : !side.left;
    }

    /// Connects this side with the other one of its horizontal edge. Rings run upwards along left sides, in
    /// image coordinates; `leaves` is true if the ring leaves the side here.
    void connect(std::size_t side, bool leaves) {
        if (!has_half_) {
            half_ = side;
            half_leaves_ = leaves;
        } else {
            assert(leaves != half_leaves_);
            (leaves ? sides_[side] : sides_[half_]).next = leaves ? half_ : side;
        }
        has_half_ = !has_half_;
    }

    const RunImage& image_;
    std::uint8_t threshold_;
    std::size_t next_ = 0; ///< the run with the first pixel of the next row
    std::vector<OutlineSide> sides_;
    std::vector<std::size_t> open_; ///< the sides of the row above, from the left
    std::vector<std::size_t> still_open_;
    bool has_half_ = false;
    std::size_t half_ = 0;
    bool half_leaves_ = false;
    BrightPixels found_;
};

/// Maps corners of pixels to layer coordinates.
class CornerMap {
  public:
    explicit CornerMap(const PixelGrid& grid) : grid_(grid), scale_(grid.ux * grid.vy - grid.uy * grid.vx) {
        assert(scale_ != 0);
    }
    [[nodiscard]] bool mirrors() const noexcept { return scale_ < 0; }
    [[nodiscard]] Point2 operator()(std::uint32_t column, std::uint32_t row) const noexcept {
        const double u = column - grid_.u0;
        const double v = row - grid_.v0;
        return {(grid_.vy * u - grid_.uy * v) / scale_, (grid_.ux * v - grid_.vx * u) / scale_};
    }

  private:
    PixelGrid grid_;
    double scale_;
};

} // namespace

BrightPixels bright_pixels(const RunImage& image, std::uint8_t threshold) {
    OutlineSweep sweep(image, threshold);
    sweep.run();
    return sweep.found();
}

Layer outlines(const RunImage& image, const PixelGrid& grid, std::uint8_t threshold) {
    OutlineSweep sweep(image, threshold);
    sweep.run();
    const std::vector<OutlineSide>& sides = sweep.sides();
    const CornerMap map(grid);
    std::vector<bool> taken(sides.size());
    std::vector<Point2> ring;
    LayerBuilder builder;
    for (std::size_t first = 0; first < sides.size(); ++first) {
        if (taken[first])
            continue;
        ring.clear();
        for (std::size_t at = first; !taken[at]; at = sides[at].next) {
            const OutlineSide& side = sides[at];
            taken[at] = true;
            ring.push_back(map(side.column, side.left ? side.bottom : side.top));
            ring.push_back(map(side.column, side.left ? side.top : side.bottom));
        }
        if (map.mirrors())
            std::reverse(ring.begin(), ring.end());
        builder.add_contour(ring, true);
    }
    return builder.finish(0, 0, 0, 0);
}

} // namespace lamella
