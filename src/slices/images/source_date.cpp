#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/slices/resin_settings.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <system_error>

namespace lamella {

std::int64_t source_date() {
    const char* const name = "SOURCE_DATE_EPOCH";
    const char* const text = std::getenv(name);
    if (text == nullptr || *text == '\0')
        return 0;
    constexpr std::int64_t last = 253402300799; // of the year 9999
    std::int64_t seconds = 0;
    const char* const end = text + std::strlen(text);
    const auto [read_to, failure] = std::from_chars(text, end, seconds);
    if (failure != std::errc() || read_to != end || seconds < 0 || seconds > last)
        throw Error(ErrorKind::usage,
                    fmt::format("{} is \"{}\", and not a number of seconds since 1970", name, excerpt(text)));
    return seconds;
}

} // namespace lamella
