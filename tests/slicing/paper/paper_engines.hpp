#pragma once

// The engines of the EECC paper, as parameters of tests.

#include "lamella/slicing/slice.hpp"

#include "slicing/expect_layers.hpp"
#include "slicing/slice_job.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::test {

/// Returns the engines by name. All sort intersections into lists except "conventional", which sorts by
/// points.
inline const std::vector<std::string>& paper_engines() {
    static const std::vector<std::string> names{"conventional", "ecc", "ecc-edge-match", "eecc"};
    return names;
}
inline const std::vector<std::string>& list_engines() {
    static const std::vector<std::string> names{"ecc", "ecc-edge-match", "eecc"};
    return names;
}

/// Returns the name of a parameterised test, such as "ecc_edge_match".
inline std::string engine_test_name(const testing::TestParamInfo<std::string>& info) {
    std::string name = info.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

inline LayerStack slice_with(std::string_view name, const Mesh& mesh, const Plan& plan,
                             SliceReport* report = nullptr) {
    LayerStack stack;
    const SliceReport ours = slice_to(appending_to(stack), mesh, plan, {.engine = engine(name)});
    if (report != nullptr)
        *report = ours;
    return stack;
}

/// Slices with the engine alone: equal vertices stay distinct if the mesh lists them twice.
inline LayerStack slice_as_listed(std::string_view name, const Mesh& mesh, const Plan& plan,
                                  SliceReport* report = nullptr) {
    LayerStack stack;
    const LayerSink keep = appending_to(stack);
    const Execution execution;
    SliceReport ours;
    engine(name).slice({mesh, plan, keep, execution, 0, ours});
    if (report != nullptr)
        *report = ours;
    return stack;
}

inline MatchingCounts counts_of(std::string_view name, const Mesh& mesh, const Plan& plan) {
    SliceReport report;
    (void)slice_with(name, mesh, plan, &report);
    return report.matching.value();
}

/// Returns whether contours touch in a point, as in Fig. 2 of the paper. Sorting by points may then fail.
inline bool contours_touch(const Layer& layer) {
    std::set<Point2> points;
    return !std::all_of(layer.points.begin(), layer.points.end(),
                        [&](const Point2& p) { return points.insert(p).second; });
}

/// Expects the same layers, bit for bit, except those in which contours touch if the engine sorts by points.
inline void expect_same_where_it_can(std::string_view name, const LayerStack& found,
                                     const LayerStack& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        expect_sound(found[i]);
        EXPECT_EQ(found[i].index, expected[i].index);
        EXPECT_EQ(found[i].z, expected[i].z);
        EXPECT_EQ(found[i].bottom, expected[i].bottom);
        EXPECT_EQ(found[i].top, expected[i].top);
        if (name == "conventional" && contours_touch(expected[i]))
            continue;
        EXPECT_TRUE(same_contours(found[i], expected[i])) << name << ", layer " << i;
    }
}

} // namespace lamella::test
