#pragma once

// Positions of the hatch lines that a strategy prescribes.

#include "lamella/core/point.hpp"
#include "lamella/scan/strategy.hpp"

#include "core/executor.hpp"
#include "pipeline/exposure_groups.hpp"
#include "scan/hatch_lines.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// The lines that a strategy prescribes for a layer.
class PrescribedLines {
  public:
    /// `tolerance` applies to the ends of lines.
    PrescribedLines(const HatchRule& rule, std::uint64_t layer, double tolerance);

    /// Returns whether a line with these ends is one of them, or a part of one.
    [[nodiscard]] bool have(const Point2& a, const Point2& b) const;

  private:
    std::vector<LineFrame> frames_;
    double distance_;
    double phase_;
    double tolerance_;
};

/// Returns the number of layers of the plan below the first layer of the file. It is the number for which the
/// most lines of the lowest planes are at their expected positions.
[[nodiscard]] std::uint64_t layers_below(const LayerFile& file, std::span<const ExposureGroup> groups,
                                         const ScanStrategy& strategy, double tolerance,
                                         const Executor& executor);

} // namespace lamella
