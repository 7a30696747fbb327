#pragma once

// Base of the writers of jobs that are zip archives of PNG images.

#include "container/zip_writer.hpp"
#include "slices/images/layer_images.hpp"
#include "slices/images/resin_writer.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace lamella {

class ResinArchive : public ResinWriter {
  public:
    std::uint64_t bytes() const noexcept final { return archive_.bytes(); }

  protected:
    ResinArchive(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options,
                 const ResinJobKind& kind, const ResinPrinter& printer)
        : ResinWriter(info, options, kind, printer), images_(drawing()),
          archive_(path, Overwriting::no, info.memory) {}

    /// Returns the name of the image of a layer.
    [[nodiscard]] virtual std::string image_name(const ResinLayer& layer) const = 0;
    /// Returns text about the contours of a layer for `note`. Called from any threads.
    [[nodiscard]] virtual std::string described(std::span<const Layer> /*parts*/) const { return {}; }
    /// Notes a layer for the end of the archive. Called in order.
    virtual void note(const ResinLayer& /*layer*/, const std::string& /*text*/) {}
    /// Adds the entries after the images.
    virtual void add_entries(const ResinTotals& totals) = 0;

    void add_text(std::string_view name, std::string_view text) {
        archive_.add(name, text, ZipMethod::deflated);
    }
    /// Adds a preview of this size.
    void add_preview(const ColourImage& whole, std::string_view name, std::uint32_t width,
                     std::uint32_t height);

  private:
    DrawnLayer drawn(const Plane& plane, std::uint64_t index) final;
    void end_job(const ResinTotals& totals) final;

    LayerImages images_;
    ZipWriter archive_;
};

} // namespace lamella
