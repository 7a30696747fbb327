#pragma once

// Checks and counters that the writers of all formats share.

#include "lamella/slices/layer_writer.hpp"

#include "container/byte_buffer.hpp"
#include "slices/engine/left_out.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>

namespace lamella {

/// Heights and index of a plane, and its position in the file. The position is known when the plane is
/// written.
struct PlanePosition {
    std::uint64_t position = 0; ///< 0 for the first of the file
    std::uint64_t index = 0;
    double z = 0;
    double bottom = 0;
    double top = 0;
};

/// Returns the values that the layers of a plane have in common.
[[nodiscard]] PlanePosition plane_position(const Plane& plane);

/// The values that must ascend from plane to plane.
enum class Ascending {
    z,
    z_and_index, ///< files are named after the indices of layers
};

/// Checks the planes as they are written: they must ascend, and the numbers of planes and parts must be the
/// announced ones.
class PlaneOrder {
  public:
    explicit PlaneOrder(const LayerFileInfo& info, Ascending ascending = Ascending::z);

    /// Throws Error{usage} if the plane has another number of parts, or, unless LayerFileInfo::known_finite
    /// is set, as `check` does.
    void check_parts(const Plane& plane) const;
    /// Sets the position of the plane. Throws Error{usage} if it does not follow the previous plane.
    void next(PlanePosition& plane);
    /// Throws Error{usage} if there were more or fewer planes than announced.
    void end() const;
    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }

  private:
    bool known_finite_;
    std::uint64_t before_; ///< number of planes of the file below this range
    std::uint64_t announced_;
    std::size_t parts_;
    Ascending ascending_;
    std::uint64_t count_ = 0;
    PlanePosition last_;
};

/// Base of writers that check the order of planes and report what they leave out.
class OrderedWriter : public LayerWriter {
  public:
    [[nodiscard]] Commit prepare(const Plane& plane) final;
    void finish() final;
    [[nodiscard]] Findings findings() const override { return left_out_.findings(); }
    [[nodiscard]] WriteLosses losses() const final { return left_out_.losses(); }
    void add_losses(const WriteLosses& above) final { left_out_.add(above); }

  protected:
    /// Appends a formatted plane to the file, or leaves that to completions. Called in order.
    using Write = std::function<void(const PlanePosition& offset, Completions& after)>;

    OrderedWriter(const LayerFileInfo& info, Holds holds, Ascending ascending = Ascending::z)
        : order_(info, ascending),
          left_out_(holds, names_parts(info) ? std::span(info.parts) : std::span<const PartInfo>()) {}

    /// Formats a plane. Called from any threads.
    [[nodiscard]] virtual Write formatted(const Plane& plane) = 0;
    /// Ends the file and gives it its name. Called once, after the last plane.
    virtual void end_file() = 0;

    /// Adds a loss of a plane that only the format has; called in order.
    void add_loss(Finding loss) { left_out_.add(std::move(loss)); }
    /// Returns the counter of losses by rounding.
    [[nodiscard]] RoundingLoss& rounding_loss() noexcept { return left_out_.rounding(); }
    [[nodiscard]] std::shared_ptr<ByteBuffer> buffer() { return buffers_->take(); }

  private:
    /// Returns whether this writer warns about parts: among the ranges of a file, only the first one does.
    static bool names_parts(const LayerFileInfo& info) noexcept {
        return info.chunk == nullptr || info.chunk->before == 0;
    }

    PlaneOrder order_;
    LeftOut left_out_;
    std::shared_ptr<BufferPool> buffers_ = std::make_shared<BufferPool>();
};

} // namespace lamella
