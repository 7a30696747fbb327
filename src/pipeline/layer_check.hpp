#pragma once

// What is wrong with layers, and where first.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/contour/rounding.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lamella {

/// How often something occurs in a layer, and where first.
struct FaultCount {
    std::uint64_t count = 0;
    Point2 first;

    void add(std::uint64_t n, const Point2& at) {
        if (count == 0)
            first = at;
        count += n;
    }
};

struct LayerCheck {
    LayerMeasure measure;
    FaultCount open_chains;
    OpenGaps open_gaps;
    FaultCount crossings;
    FaultCount misoriented;
    FaultCount overlapping;
};

[[nodiscard]] LayerCheck check_layer(const Layer& layer, const Rounding& rounding);

/// "layer 12 (z 0.375 mm)"
[[nodiscard]] std::string where(const Layer& layer);

[[nodiscard]] double largest_coordinate(std::span<const Point2> points) noexcept;

/// Of one kind of finding, in the order of the layers.
struct Finding {
    std::uint64_t total = 0;
    std::string place; ///< of the first: "layer 12 (z 0.375 mm) at (1, 2)"

    void add(const Layer& layer, const FaultCount& found);
    void add(const Finding& other);
};

/// What findings say of the contours of layers.
struct ContourFindings {
    Finding open_chains;
    Finding crossings;
    Finding misoriented;
    Finding overlapping;

    void add(const Layer& layer, const LayerCheck& found);
    void add(const ContourFindings& other);
};
[[nodiscard]] std::string open_chains_text(const Finding& finding);
[[nodiscard]] std::string crossings_text(const Finding& finding);
[[nodiscard]] std::string misoriented_text(const Finding& finding);

} // namespace lamella
