#pragma once

#include "lamella/jobs/verify.hpp"
#include "lamella/scan/scan.hpp"
#include "lamella/slicing/slice.hpp"

#include "fixtures/layer_files.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace lamella::verify_vectors_cases {

using test::box_mesh;
using test::file_of;
using test::layer_of;
using test::rectangle;

/// Returns the number that JSON has by this key.
inline std::uint64_t number(const VectorVerification& found, std::string_view key) {
    for (const FindingNumber& one : found.findings.numbers(FindingOrigin::vectors))
        if (one.key == key)
            return std::get<std::uint64_t>(one.value);
    throw std::out_of_range(std::string(key));
}

/// The vectors of layers, as a file has them.
inline std::vector<LayerPart> scanned(const LayerStack& layers, const ScanStrategy& strategy,
                                      const std::string& part) {
    std::vector<LayerPart> parts;
    for (const Exposure& exposure : exposures(strategy, part))
        parts.push_back({.label = exposure.label(), .layers = {}, .exposure = exposure});
    for (std::size_t i = 0; i < layers.size(); ++i) {
        std::vector<ScanLayer> below(layers.begin(), layers.begin() + static_cast<std::ptrdiff_t>(i));
        std::reverse(below.begin(), below.end());
        const std::vector<ScanLayer> above(layers.begin() + static_cast<std::ptrdiff_t>(i) + 1, layers.end());
        Plane vectors = scan(layers[i], below, above, strategy).vectors;
        for (std::size_t k = 0; k < parts.size(); ++k) {
            parts[k].layers.push_back(std::move(vectors.polylines[k]));
            parts[k].hatches.push_back(std::move(vectors.hatches[k]));
        }
    }
    return parts;
}

/// A block of 20 x 10 x 1 mm in ten layers.
class VerifyVectors : public testing::Test {
  protected:
    VerifyVectors() {
        strategy_.contours.count = 2;
        strategy_.upskin.layers = 2;
        strategy_.downskin.layers = 2;
        plan_ = plan_uniform(0, 1, {.layer_height = 0.1});
        parts_ = scanned(slice(mesh_, plan_), strategy_, "block");
    }

    /// With the mesh and the strategy, with one of them, with none.
    VectorVerification with_all() const {
        return verify_vectors(file_of(parts_), {.mesh = mesh_, .strategy = strategy_});
    }
    VectorVerification with_strategy() const {
        return verify_vectors(file_of(parts_), {.strategy = strategy_});
    }
    VectorVerification with_mesh() const { return verify_vectors(file_of(parts_), {.mesh = mesh_}); }
    VectorVerification with_nothing() const { return verify_vectors(file_of(parts_)); }

    LayerPart& part(const std::string& name) {
        for (LayerPart& part : parts_)
            if (part.exposure->name() == name)
                return part;
        throw std::out_of_range(name);
    }
    /// Changes the hatches of a layer.
    template <class Change>
    void change_hatches(const std::string& name, std::size_t layer, const Change& change) {
        PointArray& hatches = part(name).hatches[layer];
        std::vector<Point2> points(hatches.begin(), hatches.end());
        change(points);
        hatches = PointArray(std::move(points));
    }

    Mesh mesh_ = box_mesh({0, 0, 0}, {20, 10, 1});
    Plan plan_;
    ScanStrategy strategy_;
    std::vector<LayerPart> parts_;
};

} // namespace lamella::verify_vectors_cases
