#pragma once

// Heights of layers, as a file has them.

#include "write/rounding_loss.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace lamella {

/// They must ascend: readers take layers of one height for one layer.
class WrittenHeights {
  public:
    /// `precision`: that of the numbers in the file, such as "single precision"; `unit_mm`: what 1 stands
    /// for; `loss`: what is told of heights that rounding moves. It must outlive this.
    WrittenHeights(std::string precision, double unit_mm, RoundingLoss& loss)
        : precision_(std::move(precision)), unit_mm_(unit_mm), loss_(loss) {}

    [[nodiscard]] bool empty() const noexcept { return last_ == -std::numeric_limits<double>::infinity(); }
    /// Takes the next one, which stands for `mm`. Throws Error{usage}, naming the layer and its `end`, "top"
    /// or "bottom", where it is not above the one before, or not finite.
    void add(double height, double mm, std::string_view end, std::uint64_t layer);

  private:
    std::string precision_;
    double unit_mm_;
    RoundingLoss& loss_;
    double last_ = -std::numeric_limits<double>::infinity();
};

} // namespace lamella
