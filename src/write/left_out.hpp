#pragma once

// Warnings about content that a format cannot hold.

#include "lamella/contour/layer.hpp"
#include "lamella/write/layer_writer.hpp"

#include "write/plane_view.hpp"
#include "write/rounding_loss.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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

/// Returns the label of a part as the file has it. A label never changes what the part is: the label of
/// contours gets a further word if it would be that of an exposure, and a long label of an exposure keeps its
/// end.
[[nodiscard]] std::string label_in_file(const PartInfo& part, const Holds& holds);

/// Returns counts of the content of a plane that some formats cannot hold, except gaps and rounding.
[[nodiscard]] WriteLosses losses_of_plane(const PlaneView& plane);

/// Counts content that a file leaves out. Planes must be added in ascending z.
class LeftOut {
  public:
    LeftOut(Holds holds, std::span<const PartInfo> parts);

    /// Adds the losses of a plane or of a range of planes.
    void add(const WriteLosses& above);
    [[nodiscard]] WriteLosses losses() const;
    /// Returns the counter for writers that round.
    [[nodiscard]] RoundingLoss& rounding() noexcept { return rounding_; }
    /// Returns one line for each kind.
    [[nodiscard]] std::vector<std::string> warnings() const;

  private:
    Holds holds_;
    std::uint64_t known_ = 0;         ///< parts with parameters of scan vectors
    std::uint64_t unknown_ = 0;       ///< parts without parameters of scan vectors
    std::uint64_t supports_ = 0;      ///< support parts that are not marked otherwise
    std::uint64_t labelled_ = 0;      ///< parts whose labels differ from the default
    std::string first_labelled_;      ///< first label of these
    std::uint64_t changed_parts_ = 0; ///< parts that lose a parameter that differs from its default
    WriteLosses losses_;              ///< of all planes, except by rounding
    RoundingLoss rounding_;
    std::uint64_t changed_labels_ = 0;
    std::string first_label_; ///< first changed label, and its text in the file
    std::string first_written_;
};

} // namespace lamella
