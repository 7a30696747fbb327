#include "raster/relief.hpp"

#include "core/vector_clones.hpp"
#include "raster/edges.hpp"

#include <algorithm>
#include <initializer_list>
#include <limits>

namespace lamella {

namespace {

// Rotated about z by 30 degrees, then seen from 35 degrees above the horizon.
constexpr double turn_cos = 0.8660254037844386;
constexpr double turn_sin = 0.5;
constexpr double view_cos = 0.8191520442889918;
constexpr double view_sin = 0.573576436351046;

constexpr double margin = 0.05; ///< on each side, as a fraction of the size

/// Unit vectors in the axes of Relief::Vector.
constexpr std::array<double, 3> to_light{-0.35, 0.45, 0.8216};
constexpr std::array<double, 3> to_viewer{0, view_cos, view_sin};
constexpr double ambient = 0.25;
constexpr std::array<double, 3> colour{120, 166, 204};

/// Distance of the neighbours from which a slope is computed. Adjacent pixels would show the steps of single
/// layers.
constexpr std::size_t reach = 4;
/// Radius around a pixel in which its light is smoothed.
constexpr std::size_t blur = 2;
/// Neighbours at a greater distance lie on another surface.
constexpr double most_apart = 8 * reach;

/// Number of rows of pixels for which one height is drawn.
constexpr std::uint32_t rows_drawn_at_once = 2;

struct Extent {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void add(double v) {
        low = std::min(low, v);
        high = std::max(high, v);
    }
    [[nodiscard]] double size() const { return high > low ? high - low : 0; }
    [[nodiscard]] double middle() const { return high > low ? 0.5 * (low + high) : 0; }
};

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

std::array<double, 3> cross(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct PixelBox {
    std::size_t left;
    std::size_t top;
    std::size_t right = 0; ///< one past the last
    std::size_t bottom = 0;
};

PixelBox visible(const ColourImage& image) {
    PixelBox box{image.width, image.height};
    for (std::size_t row = 0; row < image.height; ++row)
        for (std::size_t column = 0; column < image.width; ++column)
            if (image.values[4 * (row * image.width + column) + 3] != 0)
                box = {std::min(box.left, column), std::min(box.top, row), std::max(box.right, column + 1),
                       std::max(box.bottom, row + 1)};
    return box;
}

/// Returns the mean visible colour of the pixels between these columns and rows.
std::array<std::uint8_t, 4> mean(const ColourImage& image, double left, double top, double right,
                                 double bottom) {
    std::array<double, 4> sum{};
    const std::size_t last_row = least_whole(bottom, image.height);
    const std::size_t last_column = least_whole(right, image.width);
    for (auto row = static_cast<std::size_t>(top); row < last_row; ++row) {
        const auto r = static_cast<double>(row);
        const double tall = std::min(r + 1, bottom) - std::max(r, top);
        for (auto column = static_cast<std::size_t>(left); column < last_column; ++column) {
            const auto c = static_cast<double>(column);
            const double weight = tall * (std::min(c + 1, right) - std::max(c, left));
            const std::uint8_t* const pixel = &image.values[4 * (row * image.width + column)];
            if (pixel[3] == 0)
                continue;
            for (std::size_t k = 0; k < 3; ++k)
                sum[k] += weight * pixel[3] * pixel[k];
            sum[3] += weight * pixel[3];
        }
    }
    const double alpha = sum[3] / ((right - left) * (bottom - top));
    if (alpha < 0.5)
        return {};
    const auto byte = [](double v) {
        return static_cast<std::uint8_t>(std::clamp(v + 0.5, 0.0, 255.0));
    };
    return {byte(sum[0] / sum[3]), byte(sum[1] / sum[3]), byte(sum[2] / sum[3]), byte(alpha)};
}

/// Adds to each of `count` sums the brightness of a neighbour if it is at about the same height.
LAMELLA_VECTOR_CLONES
void add_near(const float* heights, const float* heights_there, const float* lights_there, float most_higher,
              std::size_t count, float* sums, float* counts) {
    for (std::size_t i = 0; i < count; ++i) {
        const bool near = std::abs(heights_there[i] - heights[i]) <= most_higher; // false if either is NaN
        sums[i] += near ? lights_there[i] : 0.0F;
        counts[i] += near ? 1.0F : 0.0F;
    }
}

} // namespace

ColourImage fitted(const ColourImage& image, std::uint32_t width, std::uint32_t height) {
    ColourImage result{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height)};
    const PixelBox box = visible(image);
    if (box.right == 0)
        return result;
    const auto wide = static_cast<double>(box.right - box.left);
    const auto tall = static_cast<double>(box.bottom - box.top);
    const double step =
        std::max({1.0, wide / ((1 - 2 * margin) * width), tall / ((1 - 2 * margin) * height)});
    const double left = static_cast<double>(box.left) + 0.5 * (wide - step * width);
    const double top = static_cast<double>(box.top) + 0.5 * (tall - step * height);
    for (std::uint32_t row = 0; row < height; ++row) {
        const double from_row = std::max(top + row * step, 0.0);
        const double to_row = std::min(top + (row + 1) * step, static_cast<double>(image.height));
        for (std::uint32_t column = 0; column < width && from_row < to_row; ++column) {
            const double from = std::max(left + column * step, 0.0);
            const double to = std::min(left + (column + 1) * step, static_cast<double>(image.width));
            if (from >= to)
                continue;
            const auto pixel = mean(image, from, from_row, to, to_row);
            std::copy(pixel.begin(), pixel.end(),
                      result.values.begin() +
                          std::ptrdiff_t{4} * (static_cast<std::ptrdiff_t>(row) * width + column));
        }
    }
    return result;
}

Relief::Relief(const Box3& box, std::uint32_t width, std::uint32_t height)
    : width_(width), height_(height), lowest_(box.min.z), ground_{.width = width, .height = height},
      heights_(std::size_t{width} * height, std::numeric_limits<float>::quiet_NaN()) {
    Extent columns;
    Extent rows;
    for (const double x : {box.min.x, box.max.x}) {
        for (const double y : {box.min.y, box.max.y}) {
            columns.add(turn_cos * x - turn_sin * y);
            for (const double z : {box.min.z, box.max.z})
                rows.add(-view_sin * (turn_sin * x + turn_cos * y) - view_cos * z);
        }
    }
    const auto fit = [](std::uint32_t pixels, double size) {
        constexpr double smallest = 1e-6;
        return (1 - 2 * margin) * pixels / std::max(size, smallest);
    };
    scale_ = std::min(fit(width, columns.size()), fit(height, rows.size()));
    row_per_z_ = scale_ * view_cos;
    ground_.ux = scale_ * turn_cos;
    ground_.uy = -scale_ * turn_sin;
    ground_.u0 = 0.5 * width - scale_ * columns.middle();
    ground_.vx = -scale_ * view_sin * turn_sin;
    ground_.vy = -scale_ * view_sin * turn_cos;
    ground_.v0 = 0.5 * height - scale_ * rows.middle();
}

void Relief::draw(std::span<const Layer> parts, double z, std::vector<ReliefSpan>& spans) const {
    PixelGrid grid = ground_;
    grid.v0 -= z * row_per_z_;
    const std::size_t begin = spans.size();
    std::uint32_t row = 0;
    rasterise(parts, grid, {.antialias = 1}, [&](std::span<const PixelRun> runs, std::uint32_t times) {
        for (const std::uint32_t end = row + times; row < end; ++row) {
            std::uint32_t from = 0;
            for (const PixelRun& run : runs) {
                if (run.value != 0)
                    spans.push_back({row, from, run.end, static_cast<float>(z)});
                from = run.end;
            }
        }
    });
    const std::size_t end = spans.size();
    for (std::uint32_t up = 1; up < rows_drawn_at_once; ++up) {
        const auto higher = static_cast<float>(z + up / row_per_z_);
        for (std::size_t i = begin; i < end; ++i)
            if (spans[i].row >= up)
                spans.push_back({spans[i].row - up, spans[i].first, spans[i].end, higher});
    }
}

std::vector<ReliefSpan> Relief::spans(std::span<const Layer> parts) const {
    const Layer& layer = parts.front();
    const double drawn_per_z = row_per_z_ / rows_drawn_at_once;
    const auto drawn_below = [&](double z) {
        return std::floor((z - lowest_) * drawn_per_z);
    };
    std::vector<ReliefSpan> spans;
    // The ground is drawn, too, so that a part lower than a pixel is visible.
    const double first = layer.bottom <= lowest_ ? 0 : drawn_below(layer.bottom) + 1;
    const double last = std::min(drawn_below(layer.top), first + height_);
    for (double i = first; i <= last; ++i)
        draw(parts, lowest_ + i / drawn_per_z, spans);
    return spans;
}

void Relief::add(std::span<const ReliefSpan> spans) {
    for (const ReliefSpan& span : spans)
        std::fill_n(heights_.begin() + static_cast<std::ptrdiff_t>(span.row) * width_ + span.first,
                    span.end - span.first, span.z);
}

Relief::Vector Relief::position(std::size_t row, std::size_t column) const noexcept {
    const double z = heights_[row * width_ + column];
    return {static_cast<double>(column), (static_cast<double>(row) - ground_.v0 + z * row_per_z_) / view_sin,
            z * scale_};
}

Relief::Vector Relief::tangent(std::size_t row, std::size_t column, bool down) const noexcept {
    const Vector here = position(row, column);
    Vector sum{};
    bool found = false;
    // Before the first row or column the index wraps around to a number beyond the image, where no pixel is
    // covered.
    for (const bool ahead : {false, true}) {
        const std::size_t r = !down ? row : ahead ? row + reach : row - reach;
        const std::size_t c = down ? column : ahead ? column + reach : column - reach;
        if (!covered(r, c))
            continue;
        const Vector there = position(r, c);
        const double sign = ahead ? 1 : -1;
        const Vector step{sign * (there[0] - here[0]), sign * (there[1] - here[1]),
                          sign * (there[2] - here[2])};
        if (std::abs(step[1]) + std::abs(step[2]) > most_apart)
            continue;
        for (std::size_t k = 0; k < 3; ++k)
            sum[k] += step[k];
        found = true;
    }
    if (found)
        return sum;
    return down ? Vector{0, view_sin, -view_cos} : Vector{1, 0, 0}; // as if the surface faced the viewer
}

double Relief::light(std::size_t row, std::size_t column) const noexcept {
    Vector normal = cross(tangent(row, column, false), tangent(row, column, true));
    if (dot(normal, to_viewer) < 0)
        normal = {-normal[0], -normal[1], -normal[2]};
    const double length = std::sqrt(dot(normal, normal));
    return length > 0 ? std::max(0.0, dot(normal, to_light) / length) : 0;
}

std::vector<float> Relief::smooth_light() const {
    std::vector<float> sharp(heights_.size());
    for (std::size_t row = 0; row < height_; ++row)
        for (std::size_t column = 0; column < width_; ++column)
            if (covered(row, column))
                sharp[row * width_ + column] = static_cast<float>(light(row, column));
    std::vector<float> smooth(sharp.size());
    std::vector<float> counts(width_);
    const auto most_higher = static_cast<float>(most_apart / scale_);
    for (std::size_t row = 0; row < height_; ++row) {
        const std::size_t here = row * width_;
        std::fill(counts.begin(), counts.end(), 0.0F);
        for (std::size_t r = row - std::min(row, blur); r <= row + blur && r < height_; ++r)
            for (std::size_t shift = 0; shift <= 2 * blur; ++shift) { // shifts to the left come first
                const std::size_t left = blur - std::min(shift, blur);
                const std::size_t right = shift - std::min(shift, blur);
                if (left + right < width_)
                    add_near(&heights_[here + left], &heights_[r * width_ + right],
                             &sharp[r * width_ + right], most_higher, width_ - left - right,
                             &smooth[here + left], &counts[left]);
            }
        for (std::size_t column = 0; column < width_; ++column)
            smooth[here + column] = counts[column] > 0 ? smooth[here + column] / counts[column] : 0;
    }
    return smooth;
}

ColourImage Relief::image() const {
    const std::vector<float> lights = smooth_light();
    ColourImage image{width_, height_, std::vector<std::uint8_t>(std::size_t{4} * width_ * height_)};
    for (std::size_t row = 0; row < height_; ++row) {
        for (std::size_t column = 0; column < width_; ++column) {
            if (!covered(row, column))
                continue;
            const double brightness = ambient + (1 - ambient) * double{lights[row * width_ + column]};
            std::uint8_t* const pixel = &image.values[4 * (row * width_ + column)];
            for (std::size_t k = 0; k < 3; ++k)
                pixel[k] = static_cast<std::uint8_t>(std::min(255.0, 1.2 * brightness * colour[k] + 0.5));
            pixel[3] = 255;
        }
    }
    return image;
}

} // namespace lamella
