#include "slicing/sweep/point_kernels.hpp"

#include "core/vectors.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

// The width of the vectors is a template parameter. Each instantiation is inlined into a function that is
// compiled for the instruction set of that width.

namespace lamella {

namespace {

/// Returns whether a column starts at a multiple of 64 bytes.
[[maybe_unused]] bool is_aligned(const double* column) {
    return reinterpret_cast<std::uintptr_t>(column) % 64 == 0;
}

/// Computes EdgeCut::shortened.
template <int width>
[[gnu::always_inline]] inline void shorten(const typename Vector<width>::Doubles& from,
                                           typename Vector<width>::Doubles& to) {
    using V = typename Vector<width>::Doubles;
    const V one = V{} + 1.0;
    const V d = to - from;
    const V reached = from + d;
    const V excess = d >= V{} ? reached - to : to - reached;
    to = d * (excess > V{} ? one - 0x1p-53 : one);
}

template <int width>
[[gnu::always_inline]] inline void prepare(const EdgeColumns& edges) {
    using V = typename Vector<width>::Doubles;
    assert(is_aligned(edges.data));
    const std::size_t stride = edges.stride();
    for (std::size_t i = 0; i < edges.size; i += width) { // the last lanes compute on padding
        double* column = edges.data + i;
        V v = at<width>(column + stride).v;
        v = 1.0 / (v - at<width>(column).v);
        store<width>(v, column + stride);
        for (std::size_t base = 2; base < EdgeColumns::columns; base += 2) {
            V from = at<width>(column + base * stride).v;
            v = at<width>(column + (base + 1) * stride).v;
            shorten<width>(from, v);
            from = from + 0.0;
            store<width>(from, column + base * stride);
            store<width>(v, column + (base + 1) * stride);
        }
    }
}

/// Computes the cuts of `width` edges from edge i on. `snaps` must be true if edges.snap is above 0.
template <int width, bool snaps>
[[gnu::always_inline]] inline void cut_some(const EdgeColumns& edges, std::size_t i, double z,
                                            typename Vector<width>::Doubles& x,
                                            typename Vector<width>::Doubles& y) {
    using V = typename Vector<width>::Doubles;
    const double* column = edges.data + i;
    const std::size_t stride = edges.stride();
    const V one = V{} + 1.0;
    const V h = z - at<width>(column).v;
    const V t = h * at<width>(column + stride).v;
    V s = t < one ? t : one;
    if constexpr (snaps) {
        s = s > V{} ? s : V{};
        s = (h < V{} ? -h : h) > V{} + edges.snap ? s : V{};
    }
    x = at<width>(column + 2 * stride).v + s * at<width>(column + 3 * stride).v;
    y = at<width>(column + 4 * stride).v + s * at<width>(column + 5 * stride).v;
}

/// Computes (before[last], v[0], ..., v[last - 1]).
template <int width, std::size_t... k>
[[gnu::always_inline]] inline void
shift_in(const typename Vector<width>::Doubles& before, const typename Vector<width>::Doubles& v,
         typename Vector<width>::Doubles& shifted, std::index_sequence<k...>) {
    shifted = __builtin_shufflevector(before, v, (width - 1 + static_cast<int>(k))...);
}

template <int width, bool snaps>
[[gnu::always_inline]] inline CutSurvey survey(const EdgeColumns& edges, double z, double* x, double* y) {
    assert(edges.size > 0 && is_aligned(edges.data) && is_aligned(x) && is_aligned(y));
    using V = typename Vector<width>::Doubles;
    constexpr auto lanes = std::make_index_sequence<width>{};
    const std::size_t n = edges.size;

    constexpr double infinity = std::numeric_limits<double>::infinity();
    V least = V{} + infinity;
    V closest = V{} + infinity;
    // The first point has no predecessor: NaN is not less than anything.
    V x_before = V{} + std::numeric_limits<double>::quiet_NaN();
    V y_before = x_before;
    std::size_t i = 0;
    for (; i + width <= n; i += width) {
        V px;
        V py;
        V qx;
        V qy;
        cut_some<width, snaps>(edges, i, z, px, py);
        store<width>(px, x + i);
        store<width>(py, y + i);
        shift_in<width>(x_before, px, qx, lanes);
        shift_in<width>(y_before, py, qy, lanes);
        const V gap = (px - qx) * (px - qx) + (py - qy) * (py - qy);
        closest = gap < closest ? gap : closest;
        least = px < least ? px : least;
        x_before = px;
        y_before = py;
    }
    CutSurvey result{infinity, infinity};
    for (int k = 0; k < width; ++k) {
        result.least_x = least[k] < result.least_x ? least[k] : result.least_x;
        result.closest = closest[k] < result.closest ? closest[k] : result.closest;
    }
    if (i < n) {
        V px;
        V py;
        cut_some<width, snaps>(edges, i, z, px, py); // the lanes beyond n compute on padding
        store<width>(px, x + i);
        store<width>(py, y + i);
        for (; i < n; ++i) {
            result.least_x = x[i] < result.least_x ? x[i] : result.least_x;
            if (i == 0)
                continue;
            const double gap = (x[i] - x[i - 1]) * (x[i] - x[i - 1]) + (y[i] - y[i - 1]) * (y[i] - y[i - 1]);
            result.closest = gap < result.closest ? gap : result.closest;
        }
    }
    return result;
}

/// Computes (x[0], y[0], x[1], y[1], ...) in two vectors.
template <int width, std::size_t... k>
[[gnu::always_inline]] inline void
interleave(const typename Vector<width>::Doubles& x, const typename Vector<width>::Doubles& y,
           typename Vector<width>::Doubles& first, typename Vector<width>::Doubles& second,
           std::index_sequence<k...>) {
    first = __builtin_shufflevector(x, y, (k % 2 * width + k / 2)...);
    second = __builtin_shufflevector(x, y, (k % 2 * width + k / 2 + width / 2)...);
}

/// Stores past the cache. `to` must be a multiple of the vector's size.
template <int width>
[[gnu::always_inline]] inline void stream(const typename Vector<width>::Doubles& v, double* to) {
    [[maybe_unused]] auto& position = *reinterpret_cast<typename Vector<width>::Doubles*>(to);
#if defined(__clang__)
    __builtin_nontemporal_store(v, &position);
#elif defined(__x86_64__)
    // GCC has no such builtin, and the intrinsics cannot be called from here.
    if constexpr (width == 2)
        asm("movntpd %1, %0" : "=m"(position) : "x"(v));
    else
        asm("vmovntpd %1, %0" : "=m"(position) : "v"(v));
#else
    store<width>(v, to);
#endif
}

/// Makes the streamed data visible before any later store of this thread.
[[gnu::always_inline]] inline void end_stream() {
#if defined(__x86_64__)
    asm volatile("sfence" : : : "memory");
#endif
}

template <bool snaps>
[[gnu::always_inline]] inline Point2 cut_one(const EdgeColumns& edges, std::size_t i, double z) {
    const double* column = edges.data + i;
    const std::size_t stride = edges.stride();
    const double t = (z - column[0]) * column[stride];
    double s = t < 1.0 ? t : 1.0;
    if constexpr (snaps)
        s = std::abs(z - column[0]) > edges.snap && s > 0 ? s : 0;
    return {column[2 * stride] + s * column[3 * stride], column[4 * stride] + s * column[5 * stride]};
}

template <int width, bool past_cache, bool snaps>
[[gnu::always_inline]] inline void cut(const EdgeColumns& edges, std::size_t begin, std::size_t end, double z,
                                       Point2* to) {
    using V = typename Vector<width>::Doubles;
    constexpr auto lanes = std::make_index_sequence<width>{};
    constexpr std::uintptr_t line = 64; // only whole lines are worth writing past the cache
    assert(begin <= end && end <= edges.size);
    std::size_t i = begin;
    if constexpr (past_cache)
        for (; i < end && reinterpret_cast<std::uintptr_t>(to) % line != 0; ++i, ++to)
            *to = cut_one<snaps>(edges, i, z);
    for (; i + width <= end; i += width, to += width) {
        V px;
        V py;
        V first;
        V second;
        cut_some<width, snaps>(edges, i, z, px, py);
        interleave<width>(px, py, first, second, lanes);
        if constexpr (past_cache) {
            stream<width>(first, &to->x);
            stream<width>(second, &to->x + width);
        } else {
            store<width>(first, &to->x);
            store<width>(second, &to->x + width);
        }
    }
    for (; i < end; ++i, ++to)
        *to = cut_one<snaps>(edges, i, z);
    if constexpr (past_cache)
        end_stream();
}

template <int width>
[[gnu::always_inline]] inline double largest(const double* values, std::size_t n) {
    using V = typename Vector<width>::Doubles;
    V most{};
    std::size_t i = 0;
    for (; i + width <= n; i += width) {
        V v = at<width>(values + i).v;
        v = v < V{} ? -v : v;
        most = v > most ? v : most;
    }
    double result = 0;
    for (int k = 0; k < width; ++k)
        result = most[k] > result ? most[k] : result;
    for (; i < n; ++i)
        result = std::max(result, std::abs(values[i]));
    return result;
}

template <int width>
[[gnu::always_inline]] inline std::size_t find_not_above(const double* x, std::size_t from, std::size_t n,
                                                         double value) {
    using V = typename Vector<width>::Doubles;
    constexpr std::size_t step =
        16 * width; // reading single lanes of a vector is as slow as many comparisons
    assert(from <= n);
    std::size_t i = from;
    for (; i + step <= n; i += step) {
        V least = at<width>(x + i).v;
        for (std::size_t k = width; k < step; k += width)
            least = at<width>(x + i + k).v < least ? at<width>(x + i + k).v : least;
        bool hit = false;
        for (int k = 0; k < width; ++k)
            hit |= least[k] <= value;
        if (hit)
            break;
    }
    while (i < n && x[i] > value)
        ++i;
    return i;
}

// One set of kernels, compiled for one instruction set.
// NOLINTBEGIN(bugprone-macro-parentheses): a name and an attribute cannot stand in parentheses.
#define LAMELLA_POINT_KERNELS(name, target, width)                                                           \
    struct name {                                                                                            \
        target static void prepare(EdgeColumns edges) { lamella::prepare<width>(edges); }                    \
        target static CutSurvey survey(EdgeColumns edges, double z, double* x, double* y) {                  \
            return edges.snap > 0 ? lamella::survey<width, true>(edges, z, x, y)                             \
                                  : lamella::survey<width, false>(edges, z, x, y);                           \
        }                                                                                                    \
        target static void cut(EdgeColumns edges, std::size_t begin, std::size_t end, double z,              \
                               Point2* to) {                                                                 \
            if (edges.snap > 0)                                                                              \
                lamella::cut<width, false, true>(edges, begin, end, z, to);                                  \
            else                                                                                             \
                lamella::cut<width, false, false>(edges, begin, end, z, to);                                 \
        }                                                                                                    \
        target static void cut_past_cache(EdgeColumns edges, std::size_t begin, std::size_t end, double z,   \
                                          Point2* to) {                                                      \
            if (edges.snap > 0)                                                                              \
                lamella::cut<width, true, true>(edges, begin, end, z, to);                                   \
            else                                                                                             \
                lamella::cut<width, true, false>(edges, begin, end, z, to);                                  \
        }                                                                                                    \
        target static double largest(const double* values, std::size_t n) {                                  \
            return lamella::largest<width>(values, n);                                                       \
        }                                                                                                    \
        target static std::size_t find_not_above(const double* x, std::size_t from, std::size_t n,           \
                                                 double value) {                                             \
            return lamella::find_not_above<width>(x, from, n, value);                                        \
        }                                                                                                    \
        static constexpr PointKernels kernels{                                                               \
            prepare, survey, cut, cut_past_cache, largest, find_not_above};                                  \
    }
// NOLINTEND(bugprone-macro-parentheses)

LAMELLA_POINT_KERNELS(Plain, , 2);
#if defined(__x86_64__)
LAMELLA_POINT_KERNELS(Avx2, [[gnu::target("avx2")]], 4);
LAMELLA_POINT_KERNELS(Avx512, [[gnu::target("avx512f,avx512dq,avx512vl")]], 8);
#endif
#undef LAMELLA_POINT_KERNELS

} // namespace

std::span<const PointKernelSet> point_kernel_sets() noexcept {
    static constexpr std::array sets {
        PointKernelSet{"plain", &Plain::kernels},
#if defined(__x86_64__)
            PointKernelSet{"avx2", &Avx2::kernels}, PointKernelSet{"avx512", &Avx512::kernels},
#endif
    };
    std::size_t runnable = 1;
#if defined(__x86_64__)
    const bool avx2 = __builtin_cpu_supports("avx2");
    const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                        __builtin_cpu_supports("avx512vl");
    runnable += (avx2 ? 1 : 0) + (avx512 ? 1 : 0);
#endif
    return std::span(sets).first(runnable);
}

const PointKernels& point_kernels() noexcept {
    return *point_kernel_sets().back().kernels;
}

} // namespace lamella
