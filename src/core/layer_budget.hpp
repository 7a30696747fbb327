#pragma once

// Enforces LayerLimits during the work on a layer.

#include "lamella/core/error.hpp"
#include "lamella/core/layer_limits.hpp"

#include <cassert>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace lamella {

class LayerBudget {
  public:
    /// Sets no limits.
    LayerBudget() = default;
    /// `layer` is the index of the layer and `z` its height in mm, for error messages.
    LayerBudget(const LayerLimits& limits, std::uint64_t layer, double z) noexcept
        : limits_(limits), layer_(layer), z_(z) {}

    /// Throws Error{cancelled} once a stop has been requested. Cheap enough for inner loops.
    void check() const {
        if (limits_.cancel != nullptr && limits_.cancel->requested())
            stop();
    }

    /// Returns the number of items of `bytes_each` bytes that fit into the budget.
    [[nodiscard]] std::uint64_t room(std::uint64_t bytes_each) const noexcept {
        assert(bytes_each > 0);
        return limits_.memory == 0 ? std::numeric_limits<std::uint64_t>::max() : limits_.memory / bytes_each;
    }
    /// Throws Error{limit} if the items do not fit. Must be called before memory is allocated. `items` is
    /// their name in the error, such as "scan vectors". `cure` describes how to reduce their number, if there
    /// is a remedy other than more memory and fewer threads.
    void need(std::uint64_t count, std::uint64_t bytes_each, std::string_view items,
              std::string_view cure = {}) const {
        if (count > room(bytes_each))
            refuse(count, bytes_each, items, cure);
    }

    /// Returns the name of the layer that errors begin with: "layer 3 at z = 0.5 mm".
    [[nodiscard]] std::string layer() const;

    /// Returns the remaining budget while `bytes` bytes are in use.
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
