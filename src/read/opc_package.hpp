#pragma once

// Open Packaging Conventions: parts in a zip archive, and relationships that say what they are for. 3MF files
// are such packages. Parts are named as in the archive: "3D/3dmodel.model", without a slash in front.

#include "container/zip_reader.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// What a part (or the package) refers to another part for.
struct OpcRelationship {
    std::string type;      ///< a URI
    std::string target;    ///< name of a part; of an external one, as written
    bool external = false; ///< somewhere outside of the package
    std::size_t line = 0;
};

/// The relationships of a part, or those of the package for "". None when it has no list of them.
[[nodiscard]] std::vector<OpcRelationship> opc_relationships(const ZipReader& package, std::string_view part);

/// What a reference that stands in `part` means: absolute ("/3D/a.model") or relative to its folder. The
/// archive may have it as it is written, with "%20" and the like, or without.
[[nodiscard]] std::string opc_resolved(const ZipReader& package, std::string_view part,
                                       std::string_view reference);

} // namespace lamella
