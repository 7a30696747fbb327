#pragma once

// See ecc.cpp for how it works, and docs/algorithms/ecc.md for what it was made from.

#include "lamella/slicing/slice.hpp"

namespace lamella {

void run_ecc(const SliceJob& job);

} // namespace lamella
