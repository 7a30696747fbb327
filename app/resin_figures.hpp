#pragma once

// Figures of jobs for resin printers.

#include "lamella/slices/layer_file.hpp"

#include "figures.hpp"

namespace lamella::app {

/// Returns the figures of the job; none if the file is not for a resin printer.
[[nodiscard]] Figures resin_figures(const LayerFile& file);

} // namespace lamella::app
