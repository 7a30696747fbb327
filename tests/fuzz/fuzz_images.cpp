// Any bytes as rings on a small picture: rows that keep their promises and, without anti-aliasing, the pixels
// whose middles have a winding number that is not zero.

#include "promises.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace {

using lamella::fuzz::require;

using namespace lamella;

constexpr std::uint32_t width = 23;
constexpr std::uint32_t height = 17;

/// Pairs of numbers are points, in 64ths of a pixel; -32768 ends a ring.
Layer layer_of(const std::uint8_t* data, std::size_t size) {
    std::vector<Point2> points;
    Layer layer;
    const auto end_ring = [&] {
        if (points.size() > layer.offsets.back())
            layer.offsets.push_back(points.size());
    };
    for (std::size_t i = 0; i + 4 <= size; i += 4) {
        std::int16_t x = 0;
        std::int16_t y = 0;
        std::memcpy(&x, data + i, 2);
        std::memcpy(&y, data + i + 2, 2);
        if (x == INT16_MIN)
            end_ring();
        else
            points.push_back({x / 64.0, y / 64.0});
    }
    end_ring();
    layer.rings = layer.contours();
    layer.points = PointArray(std::move(points));
    return layer;
}

/// Exact: the coordinates are whole 64ths, and a place on an edge is to its right.
int winding_number(const Layer& layer, double x, double y) {
    int winding = 0;
    for (std::size_t r = 0; r < layer.rings; ++r) {
        const auto ring = layer.contour(r);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Point2& p = ring[i];
            const Point2& q = ring[(i + 1) % ring.size()];
            const auto side = [&](const Point2& a, const Point2& b) {
                return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
            };
            if (p.y <= y && y < q.y && side(p, q) <= 0)
                ++winding;
            else if (q.y <= y && y < p.y && side(q, p) <= 0)
                --winding;
        }
    }
    return winding;
}

/// Whether rounding may put the middle of a pixel on the other side of an edge: the crossing is computed.
bool close_to_an_edge(const Layer& layer, double x, double y) {
    for (std::size_t r = 0; r < layer.rings; ++r) {
        const auto ring = layer.contour(r);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Point2& p = ring[i];
            const Point2& q = ring[(i + 1) % ring.size()];
            if ((p.y <= y) != (q.y <= y) && std::abs(p.x + (y - p.y) * (q.x - p.x) / (q.y - p.y) - x) < 1e-9)
                return true;
        }
    }
    return false;
}

double covered(const Layer& layer, const RasterOptions& options) {
    std::uint32_t rows = 0;
    const RasterAreas areas =
        rasterise({&layer, 1}, {.width = width, .height = height}, options,
                  [&](std::span<const PixelRun> row, std::uint32_t times) {
                      require(times > 0 && !row.empty() && row.front().end > 0 && row.back().end == width);
                      for (std::size_t i = 1; i < row.size(); ++i)
                          require(row[i - 1].end < row[i].end && row[i - 1].value != row[i].value);
                      rows += times;
                  });
    require(rows == height);
    return areas.covered;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const Layer layer = layer_of(data, size);
    const GreyImage image = paint({&layer, 1}, {.width = width, .height = height}, {.antialias = 1});
    double middles = 0;
    for (std::uint32_t r = 0; r < height; ++r)
        for (std::uint32_t c = 0; c < width; ++c) {
            const bool inside = winding_number(layer, c + 0.5, r + 0.5) != 0;
            require((image.row(r)[c] == 255) == inside || close_to_an_edge(layer, c + 0.5, r + 0.5));
            middles += image.row(r)[c] / 255.0;
        }
    require(std::abs(covered(layer, {.antialias = 1}) - middles) < 1e-6);
    for (const unsigned antialias : {2U, 5U, 64U}) {
        const double area = covered(layer, {.antialias = antialias});
        require(area >= 0 && area <= width * height + 1e-6);
        require(!layer.points.empty() || area == 0);
        const double sum = covered(layer, {.antialias = antialias, .winds_once = true});
        require(sum >= 0 && sum <= width * height + 1e-6);
        // So few corners, and as many places at most where sides enter the picture from the left, that no row
        // is cut into strips: then the sweep is exact.
        require(2 * layer.points.size() > antialias || !winds_once({&layer, 1}) ||
                std::abs(sum - area) < 1e-6);
    }
    return 0;
}
