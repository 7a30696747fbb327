#pragma once

// What the writers of all formats check and count while planes pass by.

#include "lamella/write/layer_writer.hpp"

#include "contour/same_height.hpp"
#include "write/byte_buffer.hpp"
#include "write/left_out.hpp"

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace lamella {

/// Where a plane lies; its position is known when it is written.
struct PlanePlace {
    std::uint64_t position = 0; ///< 0 for the first of the file
    std::uint64_t index = 0;
    double z = 0;
    double bottom = 0;
    double top = 0;
};

/// Of what the layers of a plane have in common.
[[nodiscard]] PlanePlace plane_place(std::span<const Layer> parts);

/// Throws Error{usage} that names the first layer of a part which has not the heights of the first part's, by
/// which a plane is written.
void check_same_planes(std::span<const LayerStack> parts, const LayerFileInfo& info);

/// What must ascend from plane to plane.
enum class Ascending {
    z,
    z_and_index, ///< files are called after the indices of layers
};

/// The order of planes, checked as they are written: ascending, and as many planes and parts as were
/// announced.
class PlaneOrder {
  public:
    explicit PlaneOrder(const LayerFileInfo& info, Ascending ascending = Ascending::z);

    /// Throws Error{usage} when there is not one layer for each part, one has a length that is not finite, or
    /// half a hatch line.
    void check_parts(std::span<const Layer> parts) const;
    /// Tells the plane its position. Throws Error{usage} when it does not follow the one before.
    void next(PlanePlace& plane);
    /// Throws Error{usage} when there were more or fewer planes than announced.
    void end() const;
    /// Whether a plane's layer begins where that of the last one ends. Of a piece of a file
    /// this is for the writer of all pieces.
    [[nodiscard]] bool adjoins(const PlanePlace& plane) const noexcept {
        return is_piece_ || count_ == 0 || std::abs(plane.bottom - last_.top) <= same_height_mm;
    }
    /// Planes so far.
    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }

  private:
    bool is_piece_;
    bool known_finite_;
    std::uint64_t before_; ///< planes of the file that other pieces of it have
    std::uint64_t announced_;
    std::size_t parts_;
    Ascending ascending_;
    std::uint64_t count_ = 0;
    PlanePlace last_;
};

/// A writer that knows the order of its planes, and what it leaves out.
class OrderedWriter : public LayerWriter {
  public:
    [[nodiscard]] std::function<void()> prepare(std::span<const Layer> parts) final;
    void finish() final;
    [[nodiscard]] std::vector<std::string> warnings() const override { return left_out_.warnings(); }

  protected:
    /// What writes a plane that was formatted; called in order.
    using Write = std::function<void(const PlanePlace& place)>;

    OrderedWriter(const LayerFileInfo& info, Holds holds, Ascending ascending = Ascending::z)
        : order_(info, ascending),
          left_out_(holds, tells_of_parts(info) ? std::span(info.parts) : std::span<const PartInfo>()) {}

    /// Called from any threads.
    [[nodiscard]] virtual Write formatted(std::span<const Layer> parts) = 0;
    /// Ends the file and gives it its name. Called once, after the last plane.
    virtual void end_file() = 0;

    /// For the members that round.
    [[nodiscard]] RoundingLoss& rounding_loss() noexcept { return left_out_.rounding(); }
    /// For what is formatted.
    [[nodiscard]] std::shared_ptr<ByteBuffer> buffer() { return buffers_->take(); }

  private:
    /// Whether this writer warns about parts: of several pieces of a file only the first one does.
    static bool tells_of_parts(const LayerFileInfo& info) noexcept {
        return info.piece == nullptr || info.piece->before == 0;
    }

    PlaneOrder order_;
    LeftOut left_out_;
    std::shared_ptr<BufferPool> buffers_ = std::make_shared<BufferPool>();
};

} // namespace lamella
