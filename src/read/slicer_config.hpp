#pragma once

// What PrusaSlicer, SuperSlicer, OrcaSlicer, Bambu Studio and their relatives write beside the models of a
// 3MF package: what each volume of an object is for.

#include "container/zip_reader.hpp"
#include "read/body_selection.hpp"

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
    std::vector<VolumeRange> volumes; ///< of its mesh: PrusaSlicer and its relatives
    std::vector<SlicerPart> parts;    ///< its components: OrcaSlicer and its relatives
};

/// By the ids of objects of the root model.
using SlicerConfig = std::map<std::uint32_t, SlicerObject>;

/// Reads Metadata/Slic3r_PE_model.config and the like, and Metadata/model_settings.config:
///
///     <config><object id="1"><volume firstid="0" lastid="11">
///       <metadata type="volume" key="volume_type" value="NegativeVolume"/></volume></object></config>
///     <config><object id="3"><part id="2" subtype="negative_part"/></object></config>
///
/// Empty where the package has none. A part that cannot be read, and types that are not known, are remarks.
[[nodiscard]] SlicerConfig read_slicer_config(const ZipReader& package, Remarks& remarks, ReadLimits& limits,
                                              Executor& executor);

/// The role that slicers mean by "NegativeVolume", "negative_part" and the like; nothing for other words.
[[nodiscard]] std::optional<MeshRole> slicer_role(std::string_view word);

} // namespace lamella
