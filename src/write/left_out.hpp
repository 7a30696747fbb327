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
    bool gaps = true;        ///< between layers: false where a layer is read as if it began on the one before
    bool parameters = false; ///< of scan vectors: power, speed; such a format expects them for each part
    bool labels = true;      ///< of parts
    /// What a label becomes in the file; unless given, it stays as it is.
    std::string (*written_label)(std::string_view) = nullptr;
    /// Which parts are supports. True of pictures, too, which do not tell parts apart. Scan vectors are of a
    /// region that says it.
    bool supports = false;
    /// What it keeps of a set of parameters where that is not all, and what it does not keep, in words.
    ParameterSet (*kept)(ParameterSet) = nullptr;
    std::string_view not_kept = {};
};

/// How many of a kind there are, and where the lowest of them lie.
struct Extras {
    std::uint64_t count = 0;
    double z = 0;
};

/// What some formats have no place for.
struct PlaneExtras {
    Extras open_chains;
    Extras hatches;
    Extras gaps; ///< one, where the plane's layer does not begin where the one before it ends
};

/// All but gaps.
[[nodiscard]] PlaneExtras extras_of(std::span<const Layer> parts);

/// Counts what a file leaves out. Planes are noted in ascending z.
class LeftOut {
  public:
    LeftOut(Holds holds, std::span<const PartInfo> parts);

    void note(const PlaneExtras& plane);
    /// For what rounds.
    [[nodiscard]] RoundingLoss& rounding() noexcept { return rounding_; }
    /// One line for each kind.
    [[nodiscard]] std::vector<std::string> warnings() const;

  private:
    Holds holds_;
    std::uint64_t known_ = 0;         ///< parts with parameters of scan vectors
    std::uint64_t unknown_ = 0;       ///< and without
    std::uint64_t supports_ = 0;      ///< parts that are, and do not say so otherwise
    std::uint64_t labelled_ = 0;      ///< parts whose labels are not the usual one
    std::string first_labelled_;      ///< of those
    std::uint64_t changed_parts_ = 0; ///< those of whose parameters a number is lost that
                                      ///< is not as by default
    PlaneExtras noted_;               ///< of all planes
    RoundingLoss rounding_;
    std::uint64_t changed_labels_ = 0;
    std::string first_label_; ///< of those, and
    std::string first_written_;
};

} // namespace lamella
