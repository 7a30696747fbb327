// The formatting library, compiled into the program: distributions have it as a shared library only, which
// would load a shared standard library besides the one that is linked in (CMakeLists.txt).

#include <fmt/format-inl.h>

#ifndef FMT_HEADER_ONLY
FMT_BEGIN_NAMESPACE
namespace detail {
template FMT_API thousands_sep_result<char> thousands_sep_impl(locale_ref);
template FMT_API char decimal_point_impl(locale_ref);
} // namespace detail
FMT_END_NAMESPACE
#endif
