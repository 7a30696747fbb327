#pragma once

// GCC and clang vectors, for kernels that are compiled for the instruction sets of several processors. They
// are passed by reference only, because the calling convention for values depends on the instruction set.

namespace lamella {

template <int width>
struct Vector {
    typedef double Doubles __attribute__((vector_size(width * sizeof(double)), may_alias));
    typedef float Floats __attribute__((vector_size(width * sizeof(float)), may_alias));
    typedef long long Words __attribute__((vector_size(width * sizeof(long long)), may_alias));
    /// An unaligned vector. (Clang 14 drops a lower alignment of the vector type itself in templates.)
    struct __attribute__((packed, may_alias)) Anywhere {
        Doubles v;
    };
    struct __attribute__((packed, may_alias)) FloatsAnywhere {
        Floats v;
    };
    struct __attribute__((packed, may_alias)) WordsAnywhere {
        Words v;
    };
};

template <int width>
[[gnu::always_inline]] inline const typename Vector<width>::Anywhere& at(const double* from) {
    return *reinterpret_cast<const typename Vector<width>::Anywhere*>(from);
}

template <int width>
[[gnu::always_inline]] inline void store(const typename Vector<width>::Doubles& v, double* to) {
    reinterpret_cast<typename Vector<width>::Anywhere*>(to)->v = v;
}

} // namespace lamella
