#pragma once

// Slices triangles while they are read. They are never in memory all at once.

#include "lamella/mesh/triangle_soup.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include <cstdint>
#include <functional>

namespace lamella {

/// The triangles of a soup that is not in memory.
struct TriangleStream {
    /// Receives a chunk, from several threads at once and in any order. `first` is the number of its first
    /// triangle. The chunk is valid only during the call.
    using Sink = std::function<void(const TriangleSoup& chunk, std::uint64_t first)>;

    std::uint64_t triangles = 0;
    bool placed = false; ///< true if the chunks have a placement
    /// Passes all triangles to a sink once, from at most `threads` threads.
    std::function<void(unsigned threads, const Sink& sink)> pass;
};

/// Works as slice_to of a mesh, with the same result. Requires an engine that does not weld. Ignores the
/// visitor of the options.
SliceReport slice_to(const LayerSink& sink, const TriangleStream& stream, const Plan& plan,
                     const SliceOptions& options = {});

} // namespace lamella
