#pragma once

#include "lamella/contour/close_gaps.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/slicing/layering.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include "made.hpp"
#include "run.hpp"
#include "shared_layer.hpp"
#include "source_plate.hpp"

#include <pybind11/pybind11.h>

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <utility>
#include <vector>

namespace lamella::python {

/// A layer of a plate, and what was mended in it.
struct MendedLayer {
    LayerPointer layer;
    std::size_t points = 0; ///< including those of its parts
    std::vector<GapJoin> joins;
    LayerChanges changes;
};

/// A bounded queue of layers between the threads that slice them and the thread that takes them.
class LayerQueue {
  public:
    /// Adds a layer, and waits until there is space for it. Throws Error{cancelled} once the queue is closed.
    void put(MendedLayer&& made);
    /// Marks the end of the layers. If an error is the reason, `failure` is this error.
    void end(std::exception_ptr failure);

    /// Closes the queue. Must be called when no more layers will be taken.
    void close();
    [[nodiscard]] const CancelFlag& closed() const noexcept { return closed_; }

    enum class Found { layer, nothing_yet, end };
    /// Takes a layer; waits a moment if there is none. At the end, throws the failure if there was one.
    Found take(MendedLayer& made);

  private:
    std::mutex mutex_;
    std::condition_variable room_;
    std::condition_variable news_;
    std::deque<MendedLayer> waiting_;
    std::size_t points_ = 0; ///< points of the waiting layers
    CancelFlag closed_;
    bool ended_ = false;
    std::exception_ptr failure_;
};

/// A plan, the layering from which it was made, and what is mended in the layers.
struct CutPlan {
    Plan plan;
    Layering layering;
    std::optional<double> close_gaps_mm = {};
    FillRule fill = FillRule::none;
    BottomInset bottom = {};

    /// Returns the layer of the plate with its own points, mended as the plan asks for it.
    [[nodiscard]] MendedLayer mended(std::span<const Layer> bodies, const SourcePlate& plate,
                                     const LayerLimits& limits) const;
    /// Adds what was mended in a layer; an empty one makes the figures of these repairs begin at 0.
    void add(Repairs& sum, const MendedLayer& layer) const;

    /// Returns the plan restricted to the layers [begin, end) that exist.
    [[nodiscard]] Plan only(std::uint64_t begin, std::uint64_t end, const SourcePlate& plate,
                            const Execution& execution) const;
};

/// Slices in the background, while the caller takes the layers one by one, in ascending z.
class LayerStream {
  public:
    LayerStream(PlatePointer plate, CutPlan cuts, const Engine& with, unsigned threads,
                pybind11::object listener);
    LayerStream(const LayerStream&) = delete;
    LayerStream& operator=(const LayerStream&) = delete;
    ~LayerStream(); // NOLINT(bugprone-exception-escape): see there

    /// Returns the next layer. Throws pybind11::stop_iteration after the last one and once the stream is
    /// closed; and Error{usage} in a process that was forked after the stream was made, because threads,
    /// which slice, stay in the process that started them.
    LayerPointer next();
    /// Stops slicing, and waits until it has stopped. Does not wait in a forked process.
    void close();

    [[nodiscard]] const SourcePlate& plate() const noexcept { return *plate_; }
    [[nodiscard]] const Plan& plan() const noexcept { return cuts_.plan; }
    /// Returns what was mended in the meshes and in the layers taken so far.
    [[nodiscard]] const Repairs& repairs() const noexcept { return repairs_; }
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
    PlatePointer plate_;
    CutPlan cuts_;
    const Engine& engine_;
    unsigned threads_;
    pybind11::object listener_;
    /// The state of the worker. A forked process never destroys it: there, nobody releases a lock that the
    /// worker held at the time of the fork, and a condition variable waits for those who waited for it.
    struct Shared {
        ProgressBox progress;
        LayerQueue queue;
    };
    [[nodiscard]] bool forked() const;

    long process_; ///< the one that made the stream
    std::unique_ptr<Shared> shared_ = std::make_unique<Shared>();
    std::size_t taken_ = 0;
    Repairs repairs_;
    bool closed_ = false;
    std::thread worker_;
};

/// Returns the layers of `plan`, which has layers of the cuts; each has its own points. Adds what was mended
/// in them to `repairs` if it is not null.
[[nodiscard]] std::vector<LayerPointer> sliced(const SourcePlate& plate, const CutPlan& cuts,
                                               const Plan& plan, const Execution& execution,
                                               const Engine& engine, Repairs* repairs);

} // namespace lamella::python
