#include "container/parse_number.hpp"

// std::from_chars is not used, because libc++ has it for integers only, and because it returns the same code
// for overflow and underflow.
#include <fast_float/fast_float.h>

namespace lamella {

const char* parse_number(const char* from, const char* end, double& value) noexcept {
    return fast_float::from_chars(from, end, value).ptr;
}

const char* parse_number(const char* from, const char* end, float& value) noexcept {
    return fast_float::from_chars(from, end, value).ptr;
}

} // namespace lamella
