#pragma once

// Builds the image of a layer from the runs of a file.

#include "lamella/contour/run_image.hpp"

#include "container/read_limits.hpp"

#include <cstdint>
#include <string_view>
#include <utility>

namespace lamella {

/// Collects runs. The memory of the runs counts before it is allocated, and until the builder is gone.
class RunBuilder {
  public:
    RunBuilder(std::uint32_t width, std::uint32_t height, ReadLimits& limits)
        : image_{width, height, {}}, left_(image_.pixels()), limits_(limits) {}
    RunBuilder(const RunBuilder&) = delete;
    RunBuilder& operator=(const RunBuilder&) = delete;
    ~RunBuilder() { limits_.give_back(0, capacity_ * sizeof(ImageRun)); }

    [[nodiscard]] std::uint32_t width() const noexcept { return image_.width; }
    [[nodiscard]] std::uint32_t height() const noexcept { return image_.height; }
    [[nodiscard]] std::uint64_t pixels() const noexcept { return image_.pixels(); }
    /// Returns the number of pixels that are still missing.
    [[nodiscard]] std::uint64_t left() const noexcept { return left_; }

    /// Appends pixels of one value, at most as many as are missing.
    void add(std::uint8_t value, std::uint64_t pixels) {
        if (pixels == 0)
            return;
        left_ -= pixels;
        if (image_.runs.empty() || image_.runs.back().value != value) {
            limits_.make_room(image_.runs, 1, [] { return std::string_view("the runs of an image"); });
            capacity_ = image_.runs.capacity();
            image_.runs.push_back({0, value});
        }
        image_.runs.back().end = image_.pixels() - left_;
    }

    /// Returns the image, to which no pixels may be missing. The builder cannot be used any more.
    [[nodiscard]] RunImage take() noexcept { return std::move(image_); }

  private:
    RunImage image_;
    std::uint64_t left_;
    std::uint64_t capacity_ = 0;
    ReadLimits& limits_;
};

} // namespace lamella
