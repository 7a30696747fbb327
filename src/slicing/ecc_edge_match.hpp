#pragma once

// See ecc_edge_match.cpp for how it works, and docs/algorithms/ecc-edge-match.md for what it was made from.

#include "lamella/slicing/slice.hpp"

namespace lamella {

void run_ecc_edge_match(const SliceJob& job);

} // namespace lamella
