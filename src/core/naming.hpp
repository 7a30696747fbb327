#pragma once

// Errors that do not know the file or the part that they are about, and get it from who does.

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <string>

namespace lamella {

/// What `work` returns. Its errors get the name in front, "part.stl: the mesh ...", but for a stop that
/// somebody asked for; with an empty name, nothing.
template <class Work>
auto naming(const std::string& name, const Work& work) -> decltype(work()) {
    try {
        return work();
    } catch (const Error& error) {
        if (name.empty() || error.kind() == ErrorKind::cancelled)
            throw;
        throw Error(error.kind(), fmt::format("{}: {}", name, error.what()));
    }
}

} // namespace lamella
