#pragma once

#include "lamella/contour/layer.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include "naive_section.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

namespace lamella::test {

/// Checks the properties of every layer that an engine makes.
inline void expect_sound(const Layer& layer) {
    ASSERT_FALSE(layer.offsets.empty());
    EXPECT_EQ(layer.offsets.front(), 0U);
    EXPECT_EQ(layer.offsets.back(), layer.points.size());
    EXPECT_LE(layer.rings, layer.contours());
    EXPECT_TRUE(in_normal_form(layer));
    for (std::size_t i = 0; i < layer.contours(); ++i) {
        const std::span<const Point2> contour = layer.contour(i);
        ASSERT_GE(contour.size(), layer.closed(i) ? 3U : 2U);
        for (std::size_t k = 0; k + 1 < contour.size(); ++k)
            ASSERT_FALSE(contour[k] == contour[k + 1]) << "repeated point " << k << " of contour " << i;
        if (layer.closed(i)) {
            ASSERT_FALSE(contour.back() == contour.front()) << "contour " << i << " repeats its first point";
        }
    }
    for (const Point2& p : layer.points) {
        ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y));
        ASSERT_FALSE((p.x == 0 && std::signbit(p.x)) || (p.y == 0 && std::signbit(p.y))) << "minus zero";
    }
}

/// Expects the same layers, bit for bit, including numbers and heights.
inline void expect_same(const LayerStack& found, const LayerStack& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].index, expected[i].index);
        EXPECT_EQ(found[i].z, expected[i].z);
        EXPECT_EQ(found[i].bottom, expected[i].bottom);
        EXPECT_EQ(found[i].top, expected[i].top);
        ASSERT_TRUE(same_contours(found[i], expected[i])) << "layer " << i;
        ASSERT_EQ(content_hash(found[i]), content_hash(expected[i])) << "layer " << i;
    }
}

/// Compares every layer, segment by segment, with the cuts of the single triangles.
inline void expect_sections(const LayerStack& stack, std::span<const Triangle3f> triangles,
                            const Plan& plan) {
    ASSERT_EQ(stack.size(), plan.layers.size());
    for (std::size_t i = 0; i < stack.size(); ++i) {
        EXPECT_EQ(stack[i].index, plan.layers[i].index);
        EXPECT_EQ(stack[i].z, plan.layers[i].z);
        EXPECT_EQ(stack[i].bottom, plan.layers[i].bottom);
        EXPECT_EQ(stack[i].top, plan.layers[i].top);
        expect_sound(stack[i]);
        ASSERT_TRUE(net_flow(stack[i]) == net_flow(naive_section(triangles, plan.layers[i].z, plan.rule)))
            << "layer " << i << " at z = " << plan.layers[i].z;
    }
}

} // namespace lamella::test
