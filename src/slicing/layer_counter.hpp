#pragma once

// Counts the layers that pass to a sink.

#include "lamella/contour/layer.hpp"
#include "lamella/slicing/slice.hpp"

#include <atomic>
#include <cassert>
#include <cstdint>
#include <utility>

namespace lamella {

/// Passes layers to a sink and counts their content.
class LayerCounter {
  public:
    /// `sink` must outlive the counter.
    explicit LayerCounter(const LayerSink& sink) : sink_(sink) { assert(sink.prepare); }

    /// Counts a layer and passes it on. May be called from any thread.
    [[nodiscard]] Commit prepare(Layer&& layer) {
        assert(layer.offsets.back() == layer.points.size());
        layers_.fetch_add(1, std::memory_order_relaxed);
        contours_.fetch_add(layer.contours(), std::memory_order_relaxed);
        open_chains_.fetch_add(layer.open_chains(), std::memory_order_relaxed);
        points_.fetch_add(layer.points.size(), std::memory_order_relaxed);
        return sink_.prepare(std::move(layer));
    }

    /// Sets the counts of the report.
    void set_counts(SliceReport& report) const noexcept {
        report.layers = layers_;
        report.contours = contours_;
        report.open_chains = open_chains_;
        report.points = points_;
    }

  private:
    const LayerSink& sink_;
    std::atomic<std::uint64_t> layers_{0};
    std::atomic<std::uint64_t> contours_{0};
    std::atomic<std::uint64_t> open_chains_{0};
    std::atomic<std::uint64_t> points_{0};
};

} // namespace lamella
