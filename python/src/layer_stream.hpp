#pragma once

#include "lamella/contour/layer.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/slicing/layering.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include "made.hpp"
#include "run.hpp"
#include "shared_layer.hpp"
#include "source_mesh.hpp"

#include <pybind11/pybind11.h>

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace lamella::python {

/// A bounded queue of layers between the threads that slice them and the thread that takes them.
class LayerQueue {
  public:
    /// Adds a layer, and waits until there is space for it. Throws Error{cancelled} once the queue is closed.
    void put(Layer&& layer);
    /// Marks the end of the layers. If an error is the reason, `failure` is this error.
    void end(std::exception_ptr failure);

    /// Closes the queue. Must be called when no more layers will be taken.
    void close();
    [[nodiscard]] const CancelFlag& closed() const noexcept { return closed_; }

    enum class Found { layer, nothing_yet, end };
    /// Takes a layer; waits a moment if there is none. At the end, throws the failure if there was one.
    Found take(Layer& layer);

  private:
    std::mutex mutex_;
    std::condition_variable room_;
    std::condition_variable news_;
    std::deque<Layer> waiting_;
    std::size_t points_ = 0; ///< points of the waiting layers
    CancelFlag closed_;
    bool ended_ = false;
    std::exception_ptr failure_;
};

/// A plan, and the layering from which it was made.
struct CutPlan {
    Plan plan;
    Layering layering;

    /// Returns the plan restricted to the layers [begin, end) that exist.
    [[nodiscard]] Plan only(std::uint64_t begin, std::uint64_t end, const SourceMesh& mesh,
                            const Execution& execution) const;
};

/// Slices in the background, while the caller takes the layers one by one, in ascending z.
class LayerStream {
  public:
    LayerStream(MeshPointer mesh, CutPlan cuts, const Engine& with, unsigned threads,
                pybind11::object listener);
    LayerStream(const LayerStream&) = delete;
    LayerStream& operator=(const LayerStream&) = delete;
    ~LayerStream(); // NOLINT(bugprone-exception-escape): see there

    /// Returns the next layer. Throws pybind11::stop_iteration after the last one and once the stream is
    /// closed.
    LayerPointer next();
    /// Stops slicing, and waits until it has stopped.
    void close();

    [[nodiscard]] const SourceMesh& mesh() const noexcept { return *mesh_; }
    [[nodiscard]] const Plan& plan() const noexcept { return cuts_.plan; }
    /// Returns the number of remaining layers.
    [[nodiscard]] std::size_t left() const noexcept { return closed_ ? 0 : plan().layers.size() - taken_; }
    /// Returns the bottom of the next layer. Throws Error{usage} if none is left.
    [[nodiscard]] double bottom() const;

    /// Returns layers that the stream does not yield: those directly below its next layer, and those directly
    /// above its last one, in ascending z. There are fewer than requested at the ends of the part.
    using Beside = std::pair<std::vector<LayerPointer>, std::vector<LayerPointer>>;
    [[nodiscard]] Beside beside(std::uint64_t below, std::uint64_t above) const;

    /// Returns the listener for progress; None once the stream is closed or at its end.
    [[nodiscard]] const pybind11::object& listener() const noexcept { return listener_; }
    void forget_listener() { listener_ = pybind11::none(); }

  private:
    MeshPointer mesh_;
    CutPlan cuts_;
    const Engine& engine_;
    unsigned threads_;
    pybind11::object listener_;
    ProgressBox progress_;
    LayerQueue queue_;
    std::size_t taken_ = 0;
    bool closed_ = false;
    std::thread worker_;
};

/// Returns the layers of the plan, each with its own points.
[[nodiscard]] std::vector<LayerPointer> sliced(const Mesh& mesh, const Plan& plan, const Execution& execution,
                                               const Engine& engine);

} // namespace lamella::python
