#pragma once

// LayerLimits kept while a layer is worked on.

#include "lamella/core/error.hpp"
#include "lamella/core/layer_limits.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace lamella {

class LayerBudget {
  public:
    /// Without limits.
    LayerBudget() = default;
    /// `layer`: its index, and `z` its height in mm, for errors.
    LayerBudget(const LayerLimits& limits, std::uint64_t layer, double z) noexcept
        : limits_(limits), layer_(layer), z_(z) {}

    /// Cheap enough for inner loops. Throws Error{cancelled} once a stop was requested.
    void check() const {
        if (limits_.cancel != nullptr && limits_.cancel->requested())
            stop();
    }

    /// How many items of this size fit.
    [[nodiscard]] std::uint64_t room(std::uint64_t bytes_each) const noexcept {
        return limits_.memory == 0 ? std::numeric_limits<std::uint64_t>::max() : limits_.memory / bytes_each;
    }
    /// To be called before memory is asked for. Throws Error{limit} when the items do not fit. `items` says
    /// what they are, such as "scan vectors", and `cure` what makes fewer of them, if anything but more
    /// memory and fewer threads helps.
    void need(std::uint64_t count, std::uint64_t bytes_each, std::string_view items,
              std::string_view cure = {}) const {
        if (count > room(bytes_each))
            refuse(count, bytes_each, items, cure);
    }

    /// The layer, as errors begin: "layer 3 at z = 0.5 mm".
    [[nodiscard]] std::string layer() const;

    /// What is left for others while so many bytes are kept.
    [[nodiscard]] LayerBudget without(std::uint64_t bytes) const noexcept {
        LayerBudget left = *this;
        left.limits_ = limits_.without(bytes);
        return left;
    }
    [[nodiscard]] const LayerLimits& limits() const noexcept { return limits_; }

  private:
    [[noreturn]] static void stop();
    [[noreturn]] void refuse(std::uint64_t count, std::uint64_t bytes_each, std::string_view items,
                             std::string_view cure) const;

    LayerLimits limits_;
    std::uint64_t layer_ = 0;
    double z_ = 0;
};

} // namespace lamella
