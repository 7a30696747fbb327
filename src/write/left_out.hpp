#pragma once

// What a format cannot hold is said, not lost in silence.

#include "lamella/contour/layer.hpp"
#include "lamella/write/layer_writer.hpp"

#include "write/rounding_loss.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// What a format holds besides rings.
struct Holds {
    bool open_chains = true;
    bool hatches = false;
    bool parameters = false; ///< of scan vectors, which it wants of each part
};

/// How many of a kind there are, and where the lowest of them lie.
struct Extras {
    std::uint64_t count = 0;
    double z = 0;
};

/// Open chains and hatches.
struct PlaneExtras {
    Extras open_chains;
    Extras hatches;
};

[[nodiscard]] PlaneExtras extras_of(std::span<const Layer> parts);

/// Counts what a file leaves out. Planes are noted in ascending z.
class LeftOut {
  public:
    LeftOut(Holds holds, std::span<const PartInfo> parts);

    void note(const PlaneExtras& plane);
    /// For what rounds.
    [[nodiscard]] RoundingLoss& rounding() noexcept { return rounding_; }
    /// A label and what became of it in the file.
    void note_label(std::string_view label, std::string_view written);
    /// One line for each kind.
    [[nodiscard]] std::vector<std::string> warnings() const;

  private:
    Holds holds_;
    std::uint64_t unexposed_; ///< parts without parameters
    PlaneExtras noted_;       ///< of all planes
    RoundingLoss rounding_;
    std::uint64_t changed_labels_ = 0;
    std::string first_label_; ///< of those, and
    std::string first_written_;
};

} // namespace lamella
