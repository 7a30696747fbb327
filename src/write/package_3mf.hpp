#pragma once

// Common base of writers of 3MF packages.

#include "lamella/core/point.hpp"

#include "container/deflate.hpp"
#include "container/zip_writer.hpp"
#include "write/ordered_writer.hpp"

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
    /// Begins the package with the description of its parts: relationships, the model, and `more_types`, the
    /// elements for other types.
    PackageWriter(const std::string& path, const LayerFileInfo& info, Holds holds,
                  std::string_view more_types = {});

    [[nodiscard]] ZipWriter& zip() noexcept { return zip_; }
    /// Compresses one of several chunks that make up a part. For any number of threads.
    [[nodiscard]] Chunk compressed(std::string_view text);

  private:
    ZipWriter zip_;
    std::mutex mutex_;
    /// Reusable compressors; each has some hundred kilobytes.
    std::vector<std::unique_ptr<Deflater>> idle_;
};

/// Returns a mesh that only gives the position of the part; every object must have a mesh.
[[nodiscard]] std::string box_mesh(const Box3& box);

} // namespace lamella::package_3mf
