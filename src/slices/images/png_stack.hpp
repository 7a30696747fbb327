#pragma once

// The images of an archive of PNG files, one for each layer.

#include "container/read_limits.hpp"
#include "container/zip_reader.hpp"
#include "slices/images/image_reader.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// The archive must live as long.
class PngStack final : public ImageStack {
  public:
    PngStack(const ZipReader& archive, std::vector<const ZipEntry*> images);

    void decode(std::size_t layer, RunBuilder& image, ReadLimits& limits) const override;
    std::string place(std::size_t layer) const override;
    std::uint64_t decoding_bytes() const override { return decoding_bytes_; }

  private:
    const ZipReader& archive_;
    std::vector<const ZipEntry*> images_;
    std::uint64_t decoding_bytes_ = 0;
};

/// Returns the entries whose names are this beginning, a number of digits, and `.png`, in the order of the
/// numbers, which must be consecutive from `first` on. Throws Error{input} if one is missing or if there are
/// none.
[[nodiscard]] std::vector<const ZipEntry*> numbered_images(const ZipReader& archive, std::string_view begin,
                                                           std::uint64_t first);

/// Returns the columns and rows of an image of an archive.
[[nodiscard]] AlongXY<std::uint32_t> size_of_image(const ZipReader& archive, const ZipEntry& image);

/// Returns the text of an entry, or "" if there is no entry of this name.
[[nodiscard]] std::string text_of_entry(const ZipReader& archive, std::string_view name, ReadLimits& limits);

} // namespace lamella
