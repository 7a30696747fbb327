#pragma once

// The inner loops of the sweep: from prepared edges to points. Each exists once as plain code and is compiled
// for several vector widths; the widest one that the processor has is chosen at run time. All give the same
// bits: the operations of EdgeCut::at, none of them fused or reordered.

#include "lamella/core/point.hpp"

#include <cstddef>
#include <span>
#include <string_view>

namespace lamella {

/// n edges in walk order, as six columns of doubles (see EdgeCut): z0, inverse_dz, x0, dx, y0, dy. Columns
/// start at multiples of 64 bytes and are padded to whole multiples; the padding may hold anything.
struct EdgeColumns {
    double* data;
    std::size_t size;
    double snap = 0; ///< see EdgeCut

    static constexpr std::size_t columns = 6;
    static constexpr std::size_t lanes = 8; ///< doubles in 64 bytes

    [[nodiscard]] static constexpr std::size_t padded(std::size_t n) noexcept {
        return (n + lanes - 1) / lanes * lanes;
    }
    [[nodiscard]] std::size_t stride() const noexcept { return padded(size); }
};

/// What is learnt of a contour on one plane while its points are computed.
struct CutSurvey {
    double least_x;
    /// The least square of a distance between a point and the one before it (the last and the first are not
    /// compared): zero where two are equal, and where they are nearer than 1e-162.
    double closest;
};

struct PointKernels {
    /// Turns columns that hold the ends of edges (z, x and y of the base in the columns z0, x0 and y0, those
    /// of the far end in the columns inverse_dz, dx and dy) into prepared edges, as EdgeCut's constructor.
    void (*prepare)(EdgeColumns edges);
    /// x[i], y[i] = the cut of edge i with the plane z, for i < edges.size; up to padded(size) values are
    /// written. x and y start at multiples of 64 bytes. edges.size >= 1.
    CutSurvey (*survey)(EdgeColumns edges, double z, double* x, double* y);
    /// to[i - begin] = the cut of edge i with the plane z, for begin <= i < end.
    void (*cut)(EdgeColumns edges, std::size_t begin, std::size_t end, double z, Point2* to);
    /// The same for places that are not in the cache and are not read soon: where the processor can, it
    /// writes whole lines to memory without fetching them first. On lines that are in the cache it is slower.
    void (*cut_past_cache)(EdgeColumns edges, std::size_t begin, std::size_t end, double z, Point2* to);
    /// The largest |values[i]|, i < n.
    double (*largest)(const double* values, std::size_t n);
    /// The first i in [from, n) with x[i] <= value, else n.
    std::size_t (*find_not_above)(const double* x, std::size_t from, std::size_t n, double value);
};

/// The kernels of one instruction set.
struct PointKernelSet {
    std::string_view name;
    const PointKernels* kernels; ///< never null; they live as long as the program
};

/// All sets that this processor can run, the narrowest first: "plain" always, then "avx2" and "avx512".
[[nodiscard]] std::span<const PointKernelSet> point_kernel_sets() noexcept;

/// The widest of them.
[[nodiscard]] const PointKernels& point_kernels() noexcept;

} // namespace lamella
