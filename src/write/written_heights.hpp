#pragma once

// Heights of layers, as a file has them.

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace lamella {

/// They must ascend: readers take layers of one height for one layer.
class WrittenHeights {
  public:
    /// `precision`: that of the numbers in the file, such as "single precision".
    explicit WrittenHeights(std::string precision) : precision_(std::move(precision)) {}

    [[nodiscard]] bool empty() const noexcept { return last_ == -std::numeric_limits<double>::infinity(); }
    /// Takes the next one, which stands for `mm`. Throws Error{usage}, naming the layer and its `end`, "top"
    /// or "bottom", where it is not above the one before, or not finite.
    void add(double height, double mm, std::string_view end, std::uint64_t layer);

  private:
    std::string precision_;
    double last_ = -std::numeric_limits<double>::infinity();
};

} // namespace lamella
