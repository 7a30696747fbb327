#pragma once

// The exports of a shared library: exactly the declarations of public headers between these two macros.
//
// A pragma marks each declaration. An attribute of the namespace would not work: clang looks for it where a
// function is defined.

#if defined(__GNUC__)
#define LAMELLA_API_BEGIN _Pragma("GCC visibility push(default)")
#define LAMELLA_API_END _Pragma("GCC visibility pop")
#else
#define LAMELLA_API_BEGIN
#define LAMELLA_API_END
#endif
