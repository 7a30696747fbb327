#pragma once

// Base of the writers of formats whose layers follow one another in one file.

#include "slices/engine/ordered_writer.hpp"
#include "system/atomic_file.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lamella {

/// If the path ends with ".gz", the header of the file, each layer header, each layer and the tail are
/// members of a gzip file.
class SequentialWriter : public OrderedWriter {
  public:
    [[nodiscard]] std::uint64_t bytes() const noexcept final { return file_ ? file_->bytes() : chunk_bytes_; }

  protected:
    /// Creates the file and writes `header`.
    SequentialWriter(const std::string& path, const LayerFileInfo& info, std::string_view header,
                     Holds holds);

    /// Returns the text before the contours of a layer. Called in the order of layers.
    [[nodiscard]] virtual std::string layer_header(const PlanePosition& place) = 0;
    /// Appends the contours of a layer, part by part, and the text after them. Called from any threads.
    virtual void format(const Plane& plane, ByteBuffer& out) const = 0;
    /// Returns the end of the file. Called once, after the last layer.
    [[nodiscard]] virtual std::string tail() { return {}; }

  private:
    [[nodiscard]] Write formatted(const Plane& plane) final;
    void end_file() final;
    void append_bytes(std::string_view bytes, std::shared_ptr<const void> owner, Completions& after);
    void append_bytes(std::string_view bytes);

    const bool compressed_;
    std::optional<AtomicFile> file_; ///< unset if chunk_ is set
    const LayerFileChunk* chunk_;    ///< a range of its layers
    std::uint64_t chunk_bytes_ = 0;
    std::uint64_t file_layers_;
};

} // namespace lamella
