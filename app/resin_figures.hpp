#pragma once

// Figures of jobs for resin printers.

#include "lamella/slices/layer_file.hpp"

#include "figures.hpp"

namespace lamella::app {

/// Returns the amount of resin, its mass and its price, and the time of the print, as far as they are known.
[[nodiscard]] Figures amount_figures(const ResinJob& job);

/// Returns the figures of the job; none if the file is not for a resin printer.
[[nodiscard]] Figures resin_figures(const LayerFile& file);

} // namespace lamella::app
