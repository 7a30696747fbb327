#pragma once

// The inner loops of the sweep, which compute points from prepared edges. Each is written once in plain code
// and compiled for several vector widths; the widest one that the processor supports is chosen at run time.
// All versions give the same bits: they perform the operations of EdgeCut::at without fusing or reordering
// them.

#include "lamella/core/point.hpp"

#include <cstddef>
#include <span>
#include <string_view>

namespace lamella {

/// n edges in walk order, as six columns of doubles (see EdgeCut): z0, inverse_dz, x0, dx, y0, dy. Columns
/// start at multiples of 64 bytes and are padded to whole multiples; the content of the padding is arbitrary.
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

/// Properties of a contour on one plane, found while its points are computed.
struct CutSurvey {
    double least_x;
    /// Least squared distance between a point and the one before it (the last and the first are not
    /// compared): zero if two are equal or nearer than 1e-162.
    double closest;
};

struct PointKernels {
    /// Converts columns that hold the ends of edges (z, x and y of the base in the columns z0, x0 and y0,
    /// those of the far end in the columns inverse_dz, dx and dy) into prepared edges, like EdgeCut's
    /// constructor.
    void (*prepare)(EdgeColumns edges);
    /// Sets x[i], y[i] to the cut of edge i with the plane z, for i < edges.size. Writes up to padded(size)
    /// values. Requires edges.size >= 1, and x and y at multiples of 64 bytes.
    CutSurvey (*survey)(EdgeColumns edges, double z, double* x, double* y);
    /// Sets to[i - begin] to the cut of edge i with the plane z, for begin <= i < end.
    void (*cut)(EdgeColumns edges, std::size_t begin, std::size_t end, double z, Point2* to);
    /// Does the same as `cut`, but writes whole cache lines without fetching them first if the processor
    /// supports it. Faster for memory that is neither in the cache nor read soon, slower for memory in the
    /// cache.
    void (*cut_past_cache)(EdgeColumns edges, std::size_t begin, std::size_t end, double z, Point2* to);
    /// Returns the largest |values[i]|, i < n.
    double (*largest)(const double* values, std::size_t n);
    /// Returns the first i in [from, n) with x[i] <= value, or n.
    std::size_t (*find_not_above)(const double* x, std::size_t from, std::size_t n, double value);
};

/// The kernels of one instruction set.
struct PointKernelSet {
    std::string_view name;
    const PointKernels* kernels; ///< never null; they live as long as the program
};

/// Returns all sets that this processor can run, narrowest first: "plain" always, then "avx2", "avx512".
[[nodiscard]] std::span<const PointKernelSet> point_kernel_sets() noexcept;

/// Returns the widest of these sets.
[[nodiscard]] const PointKernels& point_kernels() noexcept;

} // namespace lamella
