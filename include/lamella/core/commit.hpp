#pragma once

// Work in two halves: the first in parallel, the second in order.

#include "lamella/core/api.hpp"

#include <functional>

LAMELLA_API_BEGIN
namespace lamella {

/// The second half of the work on a plane, such as writing it to a file. A function named `prepare` does the
/// first half, such as formatting, and returns the second. `prepare` may be called for several planes at
/// once, from any threads and in any order. The commits are called one at a time, in the order of the planes,
/// but not always from the same thread. An empty commit has nothing to do.
using Commit = std::function<void()>;

} // namespace lamella
LAMELLA_API_END
