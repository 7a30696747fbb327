#pragma once

// See eecc.cpp for how it works, and docs/algorithms/eecc.md for what it was made from.

#include "lamella/slicing/slice.hpp"

namespace lamella {

void run_eecc(const SliceJob& job);

} // namespace lamella
