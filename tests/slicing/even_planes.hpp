#pragma once

#include "lamella/slicing/plan.hpp"

#include <vector>

namespace lamella::test {

/// Returns `count` planes, each in the middle of one of as many equal parts of a height.
inline Plan even_planes(double from, double to, int count, SliceAt at = SliceAt::bottom) {
    std::vector<double> z;
    for (int i = 0; i < count; ++i)
        z.push_back(from + (to - from) * (i + 0.5) / count);
    return plan_listed(z, at);
}

/// Returns planes through a body from z = -10 to 10, such as test::rugged_drum.
inline Plan even_planes(int count) {
    return even_planes(-10, 10, count, SliceAt::middle);
}

} // namespace lamella::test
