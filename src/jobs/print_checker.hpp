#pragma once

// The check of a print as a stage that planes pass; see check_print.

#include "lamella/contour/layer.hpp"
#include "lamella/core/commit.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/jobs/print_check.hpp"
#include "lamella/polygon/cells.hpp"
#include "lamella/slicing/plan.hpp"

#include "jobs/cell_history.hpp"
#include "jobs/plane_window.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lamella {

class PrintChecker {
  public:
    /// `planes` are the planes that will arrive. `supports` is true for each part that is a support.
    /// `rounding` is that of the coordinates.
    PrintChecker(const PrintCheckOptions& options, PlaneRange planes, std::vector<bool> supports,
                 const Rounding& rounding, const LayerLimits& limits);

    /// Adds the layers of all parts on a plane. May be called from any thread; see Commit.
    [[nodiscard]] Commit prepare(std::uint32_t plane, std::span<const Layer> parts);

    /// Returns the result after all planes were committed.
    [[nodiscard]] PrintCheck result() &&;

  private:
    struct CheckedPlane {
        LayerCells cells;
        Layer supports; ///< the material of supports
        std::uint64_t open_chains = 0;
    };
    struct PlaneFacts;

    [[nodiscard]] PlaneFacts facts_of(const PlaneNeighbours<CheckedPlane>& plane) const;
    void add_overhang(PlaneFacts& facts, const CheckedPlane& plane, const CheckedPlane& below) const;
    void mark_supports(PlaneFacts& facts, const CheckedPlane& plane) const;
    void add(PlaneFacts& facts);
    [[nodiscard]] Findings findings(const PrintCheck& check) const;

    PrintCheckOptions options_;
    std::vector<bool> supports_;
    Rounding rounding_;
    LayerLimits limits_;
    PlaneWindow<CheckedPlane> window_;
    CellHistory material_{RegionMeeting::ends};
    CellHistory space_{RegionMeeting::merges};
    bool on_plate_ = true; ///< no layer had material so far
    std::uint64_t overhangs_ = 0;
    PrintCheck result_;
};

} // namespace lamella
