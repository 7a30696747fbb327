#pragma once

// Checks of the heights of layers as they are written to a file.

#include "slices/engine/rounding_loss.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace lamella {

/// Checks that written heights ascend, because readers take layers of equal height for one layer.
class WrittenHeights {
  public:
    /// `precision` describes the numbers in the file, such as "single precision"; `unit_mm` is the length
    /// that the number 1 stands for. `loss` counts heights moved by rounding and must outlive this object.
    WrittenHeights(std::string precision, double unit_mm, RoundingLoss& loss)
        : precision_(std::move(precision)), unit_mm_(unit_mm), loss_(loss) {}

    [[nodiscard]] bool empty() const noexcept { return last_ == -std::numeric_limits<double>::infinity(); }
    /// Adds the next height, written for `mm`. Throws Error{usage}, naming the layer and its `end`, "top" or
    /// "bottom", if it is not above the previous one, or not finite.
    void add(double height, double mm, std::string_view end, std::uint64_t layer);

  private:
    std::string precision_;
    double unit_mm_;
    RoundingLoss& loss_;
    double last_ = -std::numeric_limits<double>::infinity();
};

} // namespace lamella
