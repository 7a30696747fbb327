#pragma once

// What all formats have in common whose layers follow one another in one file.

#include "lamella/write/layer_writer.hpp"

#include "core/atomic_file.hpp"
#include "write/byte_buffer.hpp"
#include "write/left_out.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lamella {

/// The order of layers, checked as they are written: ascending z, and as many layers and parts as were
/// announced.
class LayerOrder {
  public:
    explicit LayerOrder(const LayerFileInfo& info)
        : announced_(info.piece != nullptr ? info.piece->layers : info.layers), parts_(info.parts.size()) {}

    /// Throws Error{usage} when there is not one layer for each part.
    void check_parts(std::size_t parts) const;
    /// Throws Error{usage} when this layer does not lie above the one before.
    void next(double z);
    /// The same where files are called after the indices of layers: throws also when this one does not follow
    /// the one before.
    void next(double z, std::uint64_t index);
    /// Throws Error{usage} when there were more or fewer layers than announced.
    void end() const;
    /// Layers so far.
    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }

  private:
    std::uint64_t announced_;
    std::size_t parts_;
    std::uint64_t count_ = 0;
    double last_z_ = 0;
    std::uint64_t last_index_ = 0;
};

/// Rings by how they are listed in a file, with their signed areas: computed once, used for order, direction
/// and rounding.
struct MeasuredRing {
    std::size_t contour;
    double area;
};

/// All rings of a layer in its order.
[[nodiscard]] std::vector<MeasuredRing> measured_rings(const Layer& layer);

class SequentialWriter : public LayerWriter {
  public:
    [[nodiscard]] std::function<void()> prepare(std::span<const Layer> parts) final;
    void finish() final;
    [[nodiscard]] std::uint64_t bytes() const noexcept final { return file_ ? file_->bytes() : piece_bytes_; }
    [[nodiscard]] std::vector<std::string> warnings() const final { return left_out_.warnings(); }

  protected:
    /// Where a layer lies; known when it is written.
    struct Place {
        std::uint64_t position; ///< 0 for the first of the file
        std::uint64_t index;
        double z;
        double bottom;
        double top;
    };

    /// Creates the file and writes `head`.
    SequentialWriter(const std::string& path, const LayerFileInfo& info, std::string_view head, Holds holds);

    /// For the members that round.
    [[nodiscard]] RoundingLoss& rounding_loss() noexcept { return left_out_.rounding(); }
    /// To be called where a label cannot be written as it is.
    void note_label(std::string_view label, std::string_view written) {
        left_out_.note_label(label, written);
    }

    /// What stands before the contours of a layer. Called in order.
    [[nodiscard]] virtual std::string layer_head(const Place& place) = 0;
    /// Appends the contours of a layer, part by part, and what stands after them. Called from any threads.
    virtual void format(std::span<const Layer> parts, ByteBuffer& out) const = 0;
    /// What ends the file. Called once, after the last layer.
    [[nodiscard]] virtual std::string tail() { return {}; }

  private:
    void append_bytes(std::string_view bytes);

    std::optional<AtomicFile> file_; ///< or
    const LayerFilePiece* piece_;    ///< a piece of one
    std::uint64_t piece_bytes_ = 0;
    std::uint64_t file_layers_;
    LayerOrder order_;
    LeftOut left_out_;
    std::shared_ptr<BufferPool> buffers_ = std::make_shared<BufferPool>();
};

} // namespace lamella
