#pragma once

// Findings of content that a format cannot hold.

#include "lamella/contour/layer.hpp"
#include "lamella/slices/layer_writer.hpp"

#include "slices/engine/rounding_loss.hpp"

#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace lamella {

/// Content that a format can hold besides rings.
struct Holds {
    bool open_chains = true;
    bool hatches = false;
    bool gaps = true;        ///< between layers; false if readers assume that there are none
    bool parameters = false; ///< of scan vectors, such as power; the format then requires them for each part
    bool labels = true;      ///< of parts
    /// Returns the text of a label in the file; if null, the label is unchanged.
    std::string (*written_label)(std::string_view) = nullptr;
    /// True if readers take a part for scan vectors if its label is that of an exposure.
    bool labels_mark_vectors = false;
    /// True if the format marks supports, and for images, which do not distinguish parts. Supports among scan
    /// vectors are identified by their region.
    bool supports = false;
    /// Returns the parameters of a set that the format keeps; null if it keeps all of them. `not_kept` names
    /// the others in warnings.
    ParameterSet (*kept)(ParameterSet) = nullptr;
    std::string_view not_kept = {};
};

/// Returns whether findings of the kind are layers that were not cut at mid-height.
[[nodiscard]] bool is_cut(FindingKind kind) noexcept;

/// Returns the label of a part as the file has it. A label never changes what the part is: the label of
/// contours gets a further word if it would be that of an exposure, and a long label of an exposure keeps its
/// end.
[[nodiscard]] std::string label_in_file(const PartInfo& part, const Holds& holds);

/// Returns the content of a plane that some formats cannot hold, except gaps and rounding.
[[nodiscard]] WriteLosses losses_of_plane(const Plane& plane);

/// Counts content that a file leaves out. Planes must be added in ascending z.
class LeftOut {
  public:
    LeftOut(Holds holds, std::span<const PartInfo> parts);

    /// Adds the losses of a plane or of a range of planes.
    void add(const WriteLosses& above) { losses_.add(above); }
    /// Adds a loss of the next plane that only the format has, unless its count is 0.
    void add(Finding loss) {
        if (loss.count > 0)
            losses_.found.add(std::move(loss));
    }
    [[nodiscard]] WriteLosses losses() const;
    /// Returns the counter for writers that round.
    [[nodiscard]] RoundingLoss& rounding() noexcept { return rounding_; }
    /// Returns what the format cannot hold, except cuts, which are in its row of the table of formats.
    [[nodiscard]] Findings findings() const;

  private:
    /// Returns whether the format can hold content of this kind.
    [[nodiscard]] bool holds(FindingKind kind) const noexcept;

    Holds holds_;
    Findings parts_;     ///< losses of the parts
    WriteLosses losses_; ///< of all planes, except by rounding
    RoundingLoss rounding_;
};

} // namespace lamella
