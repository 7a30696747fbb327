// The formatting library, compiled into the program. Distributions have it only as a shared library, which
// would load a shared standard library in addition to the one that is linked in (CMakeLists.txt).

#include <fmt/format-inl.h>

#ifndef FMT_HEADER_ONLY
FMT_BEGIN_NAMESPACE
namespace detail {
template FMT_API thousands_sep_result<char> thousands_sep_impl(locale_ref);
template FMT_API char decimal_point_impl(locale_ref);
} // namespace detail
FMT_END_NAMESPACE
#endif
