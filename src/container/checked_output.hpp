#pragma once

// Checks of files that are written.

#include "lamella/core/error.hpp"
#include "lamella/findings/findings.hpp"

#include "system/atomic_file.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace lamella {

/// Throws Error{limit} if a file takes more bytes than it may; 0: no limit.
inline void check_bytes(const std::string& path, std::uint64_t bytes, std::uint64_t most) {
    if (most != 0 && bytes > most)
        throw Error(
            ErrorKind::limit,
            fmt::format("{}: would take more than the {} bytes that it may; choose higher layers, another "
                        "format or a larger limit",
                        name_of_output(path), most));
}

/// Throws Error{defect}, with the first finding that is at least a warning, if there is any.
inline void check_strictly(const std::string& path, const Findings& findings) {
    if (const Finding* const found = findings.first(Severity::warning); found != nullptr)
        throw Error(ErrorKind::defect, fmt::format("{}: {}", name_of_output(path), found->text()));
}

} // namespace lamella
