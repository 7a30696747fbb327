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

/// Layers on their way from the threads that make them to the one that wants them: a bounded number of them.
class LayerQueue {
  public:
    /// Waits for room. Throws Error{cancelled} once the queue is closed.
    void put(Layer&& layer);
    /// No more will come; `failure` says why, where it is no good reason.
    void end(std::exception_ptr failure);

    /// Nobody wants any more of them.
    void close();
    [[nodiscard]] const CancelFlag& closed() const noexcept { return closed_; }

    enum class Found { layer, nothing_yet, end };
    /// Waits for a moment. At the end throws the failure, where there was one.
    Found take(Layer& layer);

  private:
    std::mutex mutex_;
    std::condition_variable room_;
    std::condition_variable news_;
    std::deque<Layer> waiting_;
    std::size_t points_ = 0; ///< in those that wait
    CancelFlag closed_;
    bool ended_ = false;
    std::exception_ptr failure_;
};

/// A plan, and how it was made.
struct CutPlan {
    Plan plan;
    Layering layering;

    /// The same with these layers, as far as there are such.
    [[nodiscard]] Plan only(std::uint64_t begin, std::uint64_t end, const SourceMesh& mesh,
                            const Execution& execution) const;
};

/// Slices while somebody takes the layers, one by one and in ascending z.
class LayerStream {
  public:
    LayerStream(MeshPointer mesh, CutPlan cuts, const Engine& with, unsigned threads,
                pybind11::object listener);
    LayerStream(const LayerStream&) = delete;
    LayerStream& operator=(const LayerStream&) = delete;
    ~LayerStream(); // NOLINT(bugprone-exception-escape): see there

    /// Throws pybind11::stop_iteration after the last one and once the stream is closed.
    LayerPointer next();
    /// Stops slicing, and waits until it has stopped.
    void close();

    [[nodiscard]] const SourceMesh& mesh() const noexcept { return *mesh_; }
    [[nodiscard]] const Plan& plan() const noexcept { return cuts_.plan; }
    /// How many layers are to come.
    [[nodiscard]] std::size_t left() const noexcept { return closed_ ? 0 : plan().layers.size() - taken_; }
    /// Where the next one begins. Throws Error{usage} where none is left.
    [[nodiscard]] double bottom() const;

    /// So many layers right below the next one, and right above the last one, which the stream does not give:
    /// in ascending z, fewer where the part ends.
    using Beside = std::pair<std::vector<LayerPointer>, std::vector<LayerPointer>>;
    [[nodiscard]] Beside beside(std::uint64_t below, std::uint64_t above) const;

    /// Who hears of progress; None once the stream is closed or at its end.
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

/// The layers of the plan, each with points of its own.
[[nodiscard]] std::vector<LayerPointer> sliced(const Mesh& mesh, const Plan& plan, const Execution& execution,
                                               const Engine& engine);

} // namespace lamella::python
