#pragma once

// Reads the parts of a 3MF package in which PrusaSlicer, SuperSlicer, OrcaSlicer, Bambu Studio and their
// relatives store the role of each volume of an object.

#include "container/zip_reader.hpp"
#include "meshes/body_selection.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

class Executor;
class ReadLimits;
class Remarks;

/// A component of an object.
struct SlicerPart {
    std::uint32_t object = 0; ///< id of the object that the component uses
    MeshRole role = MeshRole::part;
    std::string name = {};
};

struct SlicerObject {
    std::vector<VolumeRange> volumes; ///< volumes of its mesh, in files of PrusaSlicer and its relatives
    std::vector<SlicerPart> parts;    ///< its components, in files of OrcaSlicer and its relatives
};

/// Objects by their ids in the root model.
using SlicerConfig = std::map<std::uint32_t, SlicerObject>;

/// Reads Metadata/Slic3r_PE_model.config and similar parts, and Metadata/model_settings.config:
///
///     <config><object id="1"><volume firstid="0" lastid="11">
///       <metadata type="volume" key="volume_type" value="NegativeVolume"/></volume></object></config>
///     <config><object id="3"><part id="2" subtype="negative_part"/></object></config>
///
/// Returns an empty map if the package has no such part. A part that cannot be read and unknown types are
/// remarks.
[[nodiscard]] SlicerConfig read_slicer_config(const ZipReader& package, Remarks& remarks, ReadLimits& limits,
                                              Executor& executor);

/// Returns the role that slicers denote by a word such as "NegativeVolume" or "negative_part"; nullopt for
/// other words.
[[nodiscard]] std::optional<MeshRole> slicer_role(std::string_view word);

} // namespace lamella
