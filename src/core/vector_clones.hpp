#pragma once

// Loops compiled for several processors.

/// Written before the definition of a function, LAMELLA_VECTOR_CLONES compiles it for wider vectors, too. The
/// widest version that the processor supports is selected when the program starts. Operations are neither
/// fused nor reordered, so all versions give the same bits. Disabled for Clang, which forgets functions that
/// only clones call, and under sanitizers, which are not initialised when the selection is made.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define LAMELLA_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LAMELLA_SANITIZED
#endif
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && !defined(LAMELLA_SANITIZED)
#define LAMELLA_VECTOR_CLONES [[gnu::target_clones("default", "avx2", "avx512f")]]
#else
#define LAMELLA_VECTOR_CLONES
#endif
