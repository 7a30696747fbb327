#pragma once

// Scan vectors of existing layers, written to a file or kept in memory.

#include "lamella/contour/plane_source.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/jobs/file_result.hpp"
#include "lamella/scan/strategy.hpp"
#include "lamella/slices/layer_writer.hpp"

#include <cstdint>
#include <string>

LAMELLA_API_BEGIN
namespace lamella {

/// Returns the header of a slice file for scan vectors. Each part is replaced by its exposures, whose labels
/// are the label of the part followed by the name of the exposure, such as "bracket core hatch".
[[nodiscard]] LayerFileInfo with_exposures(const LayerFileInfo& info, const ScanStrategy& strategy);

/// Computes the scan vectors of the layers of all parts and writes them. Existing hatch lines are ignored.
/// `max_memory` is the limit of the whole job (see layer_limits). Uses as many threads as
/// PlaneSource::for_planes permits. Each thread holds the vectors of one plane; layers also wait for their
/// neighbours if skins need them.
///
/// Returns the figures that `slice_file` returns with FileJob::scan and `layer_statistics`, without those of
/// meshes. There is one input, so all `findings` are those of file 0. Throws the errors of
/// PlaneSource::plane, `scan` and `write_layers`, and, with LayerWriteOptions::strict, Error{defect} for the
/// first finding that is at least a warning.
[[nodiscard]] FileResult scan_layers(const std::string& path, const LayerFormat& format,
                                     const PlaneSource& source, const ScanStrategy& strategy,
                                     const LayerWriteOptions& options = {}, const Execution& execution = {},
                                     std::uint64_t max_memory = 0);

/// The scan vectors of layers, and the figures that `scan_layers` returns.
struct ScannedLayers {
    PlaneSource vectors; ///< one part for each exposure, as in `with_exposures`
    FileResult figures;
};

/// Computes the scan vectors of the layers of all parts, like `scan_layers`, and keeps those of all planes in
/// memory. Throws the errors of PlaneSource::plane and `scan`.
[[nodiscard]] ScannedLayers scan_layers(const PlaneSource& source, const ScanStrategy& strategy,
                                        const Execution& execution = {}, std::uint64_t max_memory = 0);

} // namespace lamella
LAMELLA_API_END
