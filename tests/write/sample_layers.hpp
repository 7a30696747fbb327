#pragma once

// Layers for tests of writers.

#include "lamella/contour/layer.hpp"
#include "lamella/write/layer_writer.hpp"

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <random>
#include <string>
#include <string_view>

namespace lamella {

/// Replaces the viewer of the program.
inline constexpr std::string_view test_viewer = "<title>before</title><!--lamella-data--><p>after</p>";

/// Returns options with which any format can be written.
inline LayerWriteOptions options_for_any() {
    LayerWriteOptions options;
    options.page.viewer = test_viewer;
    return options;
}

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

inline void add_contour(LayerBuilder& builder, std::initializer_list<Point2> points, bool closed = true) {
    builder.add_contour(points, closed);
}

/// Returns two layers of 0.5 mm: a square of 10 mm with a square hole of 2 mm; 96 mm^2.
inline LayerStack square_with_hole() {
    LayerStack layers;
    for (std::uint64_t i = 0; i < 2; ++i) {
        LayerBuilder builder;
        add_contour(builder, {{2, 2}, {2, 4}, {4, 4}, {4, 2}});
        add_contour(builder, {{0, 0}, {10, 0}, {10, 10}, {0, 10}});
        const double bottom = 0.5 * static_cast<double>(i);
        layers.push_back(builder.finish(i, bottom + 0.25, bottom, bottom + 0.5));
    }
    return layers;
}

inline LayerFileInfo info_of(const LayerStack& layers) {
    LayerFileInfo info{
        .box = {}, .layers = layers.size(), .bottom = layers.empty() ? 0 : layers.front().bottom};
    for (const Layer& layer : layers) {
        for (const Point2& p : layer.points) {
            info.box.add(Point3{p.x, p.y, layer.bottom});
            info.box.add(Point3{p.x, p.y, layer.top});
        }
    }
    if (info.box.empty())
        info.box.add(Point3{0, 0, info.bottom});
    return info;
}

/// Returns star-shaped rings of both directions, and with `chains` some open ones, in a field of `size` mm
/// around `centre`; the heights are no decimal fractions.
inline LayerStack random_layers(std::uint64_t seed, std::size_t count, double size, Point2 centre,
                                bool chains) {
    std::mt19937_64 random(seed);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1p-53;
    };
    LayerStack layers;
    double bottom = uniform(0, 1);
    for (std::size_t i = 0; i < count; ++i) {
        LayerBuilder builder;
        const std::size_t contours = random() % 6;
        for (std::size_t c = 0; c < contours; ++c) {
            const Point2 middle{centre.x + uniform(-size, size) / 2, centre.y + uniform(-size, size) / 2};
            const std::size_t points = 3 + random() % 60;
            const double turn = random() % 2 == 0 ? 1 : -1;
            for (std::size_t p = 0; p < points; ++p) {
                const double angle =
                    turn * 2 * std::numbers::pi * static_cast<double>(p) / static_cast<double>(points);
                const double radius = size * uniform(0.05, 0.4);
                builder.add_point({middle.x + radius * std::cos(angle), middle.y + radius * std::sin(angle)});
            }
            builder.end_contour(!chains || random() % 3 != 0);
        }
        const double top = bottom + uniform(0.02, 0.2);
        layers.push_back(builder.finish(i, 0.5 * (bottom + top), bottom, top));
        bottom = top;
    }
    return layers;
}

} // namespace lamella
