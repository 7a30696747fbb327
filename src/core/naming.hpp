#pragma once

// Adds the name of a file or part to errors from code that does not know it.

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <string>

namespace lamella {

/// Returns the result of `work`. Prefixes its errors, except for cancellation, with the name, as in
/// "part.stl: the mesh ..."; an empty name adds nothing.
template <class Work>
auto naming(const std::string& name, const Work& work) -> decltype(work()) {
    try {
        return work();
    } catch (const Error& error) {
        if (name.empty() || error.kind() == ErrorKind::cancelled)
            throw;
        throw Error(error.kind(), fmt::format("{}: {}", name, error.what()), error.system_error());
    }
}

} // namespace lamella
