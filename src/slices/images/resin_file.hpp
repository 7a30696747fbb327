#pragma once

// Base of the writers of jobs in one file, with images as runs.

#include "slices/images/resin_writer.hpp"
#include "slices/images/run_codes.hpp"
#include "system/atomic_file.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// The file begins with a head of a known size, whose content is known only at the end: totals, and the
/// places of the images. It is written then, so the output waits for the end if it is a pipe.
class ResinFile : public ResinWriter {
  public:
    std::uint64_t bytes() const noexcept final { return file_.bytes(); }

  protected:
    /// The image of a layer in each of the codes.
    struct Images {
        std::vector<std::shared_ptr<ByteBuffer>> files;
        std::uint64_t lit = 0;   ///< pixels that are not black in the first of them
        std::uint64_t index = 0; ///< of the layer; see ResinWriter::drawn
    };

    ResinFile(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options,
              const ResinJobKind& kind, const ResinPrinter& printer, std::vector<RunCode> codes,
              std::uint64_t head_bytes);

    /// Changes the images after they are encoded. Called from any threads.
    virtual void finish_images(Images& /*images*/) const {}
    /// Appends a layer to the file by `put`. Called in order.
    virtual void put_layer(const ResinLayer& layer, const Images& images, Completions& after) = 0;
    /// Appends what follows the layers, and returns the head.
    [[nodiscard]] virtual std::string end_and_head(const ResinTotals& totals) = 0;

    void put(std::string_view bytes) { file_.append(bytes); }
    void put(const std::shared_ptr<ByteBuffer>& image, Completions& after) {
        file_.append(image->view(), image, after);
    }
    /// Throws Error{limit} unless a position in the file has 32 bits.
    void check_32_bits(std::uint64_t position) const;

  private:
    std::uint8_t read_back(std::uint8_t value) const noexcept final;
    DrawnLayer drawn(const Plane& plane, std::uint64_t index) final;
    void end_job(const ResinTotals& totals) final;

    std::vector<RunCode> codes_;
    std::uint64_t head_bytes_;
    AtomicFile file_;
};

} // namespace lamella
