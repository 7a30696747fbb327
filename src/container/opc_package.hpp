#pragma once

// Open Packaging Conventions, used by 3MF: parts in a zip archive, and relationships that define their
// purpose. Parts are named as in the archive, without a leading slash: "3D/3dmodel.model".

#include "container/zip_reader.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// A reference from a part or the package to another part, and its purpose.
struct OpcRelationship {
    std::string type;      ///< a URI
    std::string target;    ///< name of a part; if external, as written
    bool external = false; ///< the target is outside of the package
    std::size_t line = 0;
};

/// Returns the relationships of a part, or those of the package for "". Returns an empty list if the package
/// has no list of them.
[[nodiscard]] std::vector<OpcRelationship> opc_relationships(const ZipReader& package, std::string_view part);

/// Returns the name of the part that a reference in `part` refers to: absolute ("/3D/a.model") or relative to
/// its folder. The archive may have the name as written, or with "%20" and the like decoded.
[[nodiscard]] std::string opc_resolved(const ZipReader& package, std::string_view part,
                                       std::string_view reference);

} // namespace lamella
