#pragma once

// Progress of parts of a computation.

#include "lamella/core/execution.hpp"

#include <optional>
#include <utility>

namespace lamella {

/// Returns an execution that reports translate(progress), a std::optional<Progress>, instead of each
/// progress; nothing if that is nullopt. The given execution must outlive it.
template <class Translate>
[[nodiscard]] Execution with_progress(const Execution& execution, Translate translate) {
    Execution part = execution;
    if (execution.progress)
        part.progress = [&execution, translate = std::move(translate)](const Progress& progress) {
            if (const std::optional<Progress> translated = translate(progress))
                execution.progress(*translated);
        };
    return part;
}

/// Returns an execution that reports no progress.
[[nodiscard]] inline Execution without_progress(Execution execution) {
    execution.progress = nullptr;
    return execution;
}

} // namespace lamella
