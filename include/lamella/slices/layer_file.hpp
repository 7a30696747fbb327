#pragma once

// Slice files as they are read.

#include "lamella/contour/plane_source.hpp"
#include "lamella/slices/resin_job.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

struct LayerReadOptions {
    /// Largest number of bytes that the decompressed file and the layers may take; otherwise Error{limit} is
    /// thrown before they are allocated. 0: three quarters of the available memory.
    std::uint64_t max_memory = 0;
    /// Bytes of `max_memory` that previously read files still take (see PlaneSource::bytes).
    std::uint64_t held = 0;
    KeptPlanes kept = KeptPlanes::all;
};

/// The planes of a slice file, which has at least one part. Coordinates are in millimetres.
struct LayerFile : PlaneSource {
    std::string format = {};                ///< name of the format as in `layer_formats`, such as "cli"
    double units_mm = 0;                    ///< millimetres per coordinate unit of the file
    std::vector<std::string> warnings = {}; ///< one line each: the irregularity, and how the reader treated
                                            ///< it
    /// The warning that the heights in the file are interpreted as bottoms of layers although the format
    /// defines them as tops; empty unless the reader guessed so.
    std::string guess = {};
    std::optional<ResinJob> resin = {}; ///< the job, if the file is for a resin printer
};

} // namespace lamella
LAMELLA_API_END
