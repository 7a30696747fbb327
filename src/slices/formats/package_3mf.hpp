#pragma once

// Common base of writers of 3MF packages.

#include "lamella/core/point.hpp"

#include "container/deflate.hpp"
#include "container/zip_writer.hpp"
#include "slices/engine/ordered_writer.hpp"

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::package_3mf {

struct Chunk {
    std::string bytes;
    std::uint64_t size = 0;
    std::uint32_t crc = 0;

    [[nodiscard]] ZipChunk in_zip() const { return {bytes, size, crc}; }
};

class PackageWriter : public OrderedWriter {
  public:
    [[nodiscard]] std::uint64_t bytes() const noexcept override { return zip_.bytes(); }

  protected:
    /// Begins the package with the types of its parts: relationships, the model, and the elements in
    /// `more_types`.
    PackageWriter(const std::string& path, const LayerFileInfo& info, Holds holds,
                  std::string_view more_types = {});

    [[nodiscard]] ZipWriter& zip() noexcept { return zip_; }
    /// Compresses one of several chunks of a part. May be called by any number of threads at once.
    [[nodiscard]] Chunk compressed(std::string_view text);

  private:
    ZipWriter zip_;
    std::mutex mutex_;
    /// Reusable compressors of some hundred kilobytes each.
    std::vector<std::unique_ptr<Deflater>> idle_;
};

/// Returns a mesh that only marks the box of the part. The format requires a mesh for every object.
[[nodiscard]] std::string box_mesh(const Box3& box);

} // namespace lamella::package_3mf
