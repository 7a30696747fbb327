#include "slicing/point_kernels.hpp"

#include <cstring>

// GCC and clang vectors. The width is a template parameter; each instantiation is inlined into a function
// that is compiled for the instruction set of that width.

namespace lamella {

namespace {

template <int width>
struct Vector {
    typedef double Doubles __attribute__((vector_size(width * sizeof(double)), aligned(sizeof(double))));
    typedef long long Mask __attribute__((vector_size(width * sizeof(double)), aligned(sizeof(double))));
};

template <int width>
[[gnu::always_inline]] inline typename Vector<width>::Doubles load(const double* from) {
    typename Vector<width>::Doubles v;
    std::memcpy(&v, from, sizeof v);
    return v;
}

template <int width>
[[gnu::always_inline]] inline void cut(EdgeColumns edges, double z, double* x, double* y) {
    using V = typename Vector<width>::Doubles;
    const std::size_t n = edges.size;
    const double* z0 = edges.data;
    const double* inverse_dz = z0 + n;
    const double* x0 = inverse_dz + n;
    const double* dx = x0 + n;
    const double* y0 = dx + n;
    const double* dy = y0 + n;
    std::size_t i = 0;
    for (; i + width <= n; i += width) {
        const V one = V{} + 1.0;
        const V t = (z - load<width>(z0 + i)) * load<width>(inverse_dz + i);
        const V s = t < one ? t : one;
        const V px = load<width>(x0 + i) + s * load<width>(dx + i);
        const V py = load<width>(y0 + i) + s * load<width>(dy + i);
        std::memcpy(x + i, &px, sizeof px);
        std::memcpy(y + i, &py, sizeof py);
    }
    for (; i < n; ++i) {
        const double t = (z - z0[i]) * inverse_dz[i];
        const double s = t < 1.0 ? t : 1.0;
        x[i] = x0[i] + s * dx[i];
        y[i] = y0[i] + s * dy[i];
    }
}

template <int width>
[[gnu::always_inline]] inline double smallest(const double* x, std::size_t n) {
    using V = typename Vector<width>::Doubles;
    double least = x[0];
    std::size_t i = 0;
    if (n >= 4 * width) {
        V a = load<width>(x);
        V b = load<width>(x + width);
        for (i = 2 * width; i + 2 * width <= n; i += 2 * width) {
            const V c = load<width>(x + i);
            const V d = load<width>(x + i + width);
            a = c < a ? c : a;
            b = d < b ? d : b;
        }
        a = b < a ? b : a;
        for (int k = 0; k < width; ++k)
            least = a[k] < least ? a[k] : least;
    }
    for (; i < n; ++i)
        least = x[i] < least ? x[i] : least;
    return least;
}

template <int width>
[[gnu::always_inline]] inline std::size_t find(const double* x, std::size_t from, std::size_t n,
                                               double value) {
    using M = typename Vector<width>::Mask;
    std::size_t i = from;
    for (; i + 4 * width <= n; i += 4 * width) {
        M any = load<width>(x + i) == value;
        for (int k = 1; k < 4; ++k)
            any |= load<width>(x + i + k * width) == value;
        bool hit = false;
        for (int k = 0; k < width; ++k)
            hit |= any[k] != 0;
        if (hit)
            break;
    }
    for (; i < n; ++i)
        if (x[i] == value)
            return i;
    return n;
}

template <int width>
[[gnu::always_inline]] inline bool repeats(const double* x, const double* y, std::size_t n) {
    using M = typename Vector<width>::Mask;
    std::size_t i = 1;
    M any{};
    for (; i + width <= n; i += width)
        any |=
            (load<width>(x + i) == load<width>(x + i - 1)) & (load<width>(y + i) == load<width>(y + i - 1));
    for (int k = 0; k < width; ++k)
        if (any[k] != 0)
            return true;
    for (; i < n; ++i)
        if (x[i] == x[i - 1] && y[i] == y[i - 1])
            return true;
    return false;
}

[[gnu::always_inline]] inline void interleave(const double* x, const double* y, std::size_t n, Point2* to) {
    for (std::size_t i = 0; i < n; ++i)
        to[i] = {x[i], y[i]};
}

// One set of kernels, compiled for one instruction set.
#define LAMELLA_POINT_KERNELS(name, target, width)                                                           \
    struct name {                                                                                            \
        target static void cut(EdgeColumns e, double z, double* x, double* y) {                              \
            lamella::cut<width>(e, z, x, y);                                                                 \
        }                                                                                                    \
        target static double smallest(const double* x, std::size_t n) {                                      \
            return lamella::smallest<width>(x, n);                                                           \
        }                                                                                                    \
        target static std::size_t find(const double* x, std::size_t from, std::size_t n, double value) {     \
            return lamella::find<width>(x, from, n, value);                                                  \
        }                                                                                                    \
        target static bool repeats(const double* x, const double* y, std::size_t n) {                        \
            return lamella::repeats<width>(x, y, n);                                                         \
        }                                                                                                    \
        target static void interleave(const double* x, const double* y, std::size_t n, Point2* to) {         \
            lamella::interleave(x, y, n, to);                                                                \
        }                                                                                                    \
        static constexpr PointKernels kernels{cut, smallest, find, repeats, interleave};                     \
    }

LAMELLA_POINT_KERNELS(Plain, , 2);
#if defined(__x86_64__)
LAMELLA_POINT_KERNELS(Avx2, [[gnu::target("avx2")]], 4);
LAMELLA_POINT_KERNELS(Avx512, [[gnu::target("avx512f,avx512dq,avx512vl,prefer-vector-width=512")]], 8);
#endif
#undef LAMELLA_POINT_KERNELS

} // namespace

const PointKernels& plain_point_kernels() noexcept {
    return Plain::kernels;
}

const PointKernels& point_kernels() noexcept {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
        return Avx512::kernels;
    if (__builtin_cpu_supports("avx2"))
        return Avx2::kernels;
#endif
    return Plain::kernels;
}

} // namespace lamella
