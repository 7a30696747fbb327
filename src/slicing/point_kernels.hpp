#pragma once

// The inner loops of the sweep: from prepared edges to points. Each exists once as plain code and is compiled
// for several vector widths; the widest one that the processor has is chosen when the program starts. All
// give the same bits: the operations of EdgeCut::at, none of them fused or reordered.

#include "lamella/core/point.hpp"

#include <cstddef>

namespace lamella {

/// n edges in walk order as six arrays of n doubles behind one another (see EdgeCut): z0, inverse_dz, x0, dx,
/// y0, dy.
struct EdgeColumns {
    const double* data;
    std::size_t size;

    static constexpr std::size_t columns = 6;
};

struct PointKernels {
    /// x[i], y[i] = the cut of edge i with the plane z.
    void (*cut)(EdgeColumns edges, double z, double* x, double* y);
    /// The smallest x. n >= 1.
    double (*smallest)(const double* x, std::size_t n);
    /// The first i in [from, n) with x[i] == value, else n.
    std::size_t (*find)(const double* x, std::size_t from, std::size_t n, double value);
    /// Whether any point equals the one before it (not: the first the last).
    bool (*repeats)(const double* x, const double* y, std::size_t n);
    /// to[i] = (x[i], y[i]).
    void (*interleave)(const double* x, const double* y, std::size_t n, Point2* to);
};

/// The kernels for this processor.
[[nodiscard]] const PointKernels& point_kernels() noexcept;

/// The plain ones, for tests of equality.
[[nodiscard]] const PointKernels& plain_point_kernels() noexcept;

} // namespace lamella
