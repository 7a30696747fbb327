// The features of the processor, where __builtin_cpu_supports and target_clones of Clang look for them. Clang's and GCC's
// run-time libraries have these two symbols, but Zig's has not. Only features that the sources ask for are reported.

#include <cpuid.h>

struct {
    unsigned vendor, type, subtype, features[1];
} __cpu_model __attribute__((visibility("hidden")));

// The numbers of features by which Clang tests them.
enum { avx2 = 10, avx512f = 15, avx512vl = 20, avx512dq = 22 };

static unsigned saved_registers(void) {
    unsigned low, high;
    __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return low;
}

// Also called by the code that selects clones, which may run before the constructors.
__attribute__((visibility("hidden"), constructor(101))) int __cpu_indicator_init(void) {
    unsigned a, b, c, d;
    if (!__get_cpuid(1, &a, &b, &c, &d) || (c & bit_OSXSAVE) == 0)
        return 0;
    const unsigned of_avx = 0x06, of_avx512 = 0xe6, saved = saved_registers();
    if (!__get_cpuid_count(7, 0, &a, &b, &c, &d) || (saved & of_avx) != of_avx)
        return 0;
    unsigned features = (b & bit_AVX2) != 0 ? 1U << avx2 : 0;
    if ((saved & of_avx512) == of_avx512 && (b & bit_AVX512F) != 0) {
        features |= 1U << avx512f;
        features |= (b & bit_AVX512VL) != 0 ? 1U << avx512vl : 0;
        features |= (b & bit_AVX512DQ) != 0 ? 1U << avx512dq : 0;
    }
    __cpu_model.features[0] = features;
    return 0;
}
