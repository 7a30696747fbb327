#pragma once

// The default engine. See sweep.cpp for how it works.

#include "lamella/slicing/slice.hpp"

namespace lamella {

void run_sweep(const SliceJob& job);

} // namespace lamella
