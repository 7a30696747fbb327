#pragma once

// See conventional.cpp for how it works, and docs/algorithms/conventional.md for what it was made from.

#include "lamella/slicing/slice.hpp"

namespace lamella {

void run_conventional(const SliceJob& job);

} // namespace lamella
