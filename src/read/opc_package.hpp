#pragma once

// Open Packaging Conventions: parts in a zip archive, and relationships that say what they are for. 3MF files
// are such packages.

#include "container/zip_reader.hpp"
#include "core/byte_source.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// What a part (or the package) refers to another part for.
struct OpcRelationship {
    std::string type;      ///< a URI
    std::string target;    ///< name of a part (see OpcPackage); of an external one, as written
    bool external = false; ///< somewhere outside of the package
    std::size_t line = 0;
};

/// A package. Parts are named as in the archive: "3D/3dmodel.model", without a slash in front.
class OpcPackage {
  public:
    /// Opens the archive; see ZipReader.
    OpcPackage(const ByteSource& source, std::uint64_t max_unpacked) : zip_(source, max_unpacked) {}

    [[nodiscard]] const ZipReader& zip() const noexcept { return zip_; }

    /// The relationships of a part, or those of the package for "". None when it has no list of them.
    [[nodiscard]] std::vector<OpcRelationship> relationships(std::string_view part) const;

    /// What a reference that stands in `part` means: absolute ("/3D/a.model") or relative to its folder.
    [[nodiscard]] static std::string resolve(std::string_view part, std::string_view reference);

  private:
    ZipReader zip_;
};

} // namespace lamella
