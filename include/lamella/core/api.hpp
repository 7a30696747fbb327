#pragma once

// What a shared library shows: the names of the public headers, and nothing else.

#if defined(__GNUC__)
#define LAMELLA_API [[gnu::visibility("default")]]
#else
#define LAMELLA_API
#endif
