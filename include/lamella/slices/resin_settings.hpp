#pragma once

// Settings of a print in resin: times of exposure, movements of the plate, and the resin itself.

#include "lamella/core/api.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Movements of the plate between the exposures of two layers: upwards in two stages, which add up, and back
/// down in two stages. A stage of 0 mm does not take place. Formats without stages get one movement of the
/// whole length, at the lower of the two speeds.
struct PlateTravel {
    double lift_mm = 5; ///< first stage, which peels the layer off
    double lift_mm_min = 65;
    double lift2_mm = 0;
    double lift2_mm_min = 150;
    double retract_mm_min = 150; ///< first stage: down to `retract2_mm` above the place of the next layer
    double retract2_mm = 0;
    double retract2_mm_min = 65;
    double wait_before_lift_s = 0;
    double wait_after_lift_s = 0;
    double wait_after_retract_s = 0.5;

    friend bool operator==(const PlateTravel&, const PlateTravel&) = default;
};

/// A range of heights above the plate with its own exposure time, from the bottom of the part upwards. A
/// layer belongs to the range if its middle does; if several ranges have it, to the last of them. Those of a
/// file do not overlap.
struct ExposureRange {
    double from_mm = 0;
    double to_mm = 0;
    double exposure_s = 0;
};

/// Options of the formats for resin printers. Values that are not given are those of the printer.
struct ResinSettings {
    /// Exposure times, in seconds.
    std::optional<double> exposure_s = {};
    std::optional<double> bottom_exposure_s = {};
    /// Number of layers with the exposure of the bottom, and of layers above them over which the time changes
    /// linearly to that of the other layers.
    std::optional<std::uint32_t> bottom_layers = {};
    std::optional<std::uint32_t> transition_layers = {};
    /// Exposures that apply instead of those above.
    std::vector<ExposureRange> ranges = {};

    PlateTravel bottom_travel = {};
    PlateTravel travel = {};
    /// Time without light before each exposure, for printers that are set by it. Above 0, it replaces the
    /// three waits.
    double light_off_s = 0;
    /// Power of the light, from 0 to 255.
    unsigned bottom_light_power = 255;
    unsigned light_power = 255;

    double density_g_ml = 1.1;
    double price_per_litre = 0;
    std::string currency = "$"; ///< at most 7 bytes; "" if it is not known

    /// Time of creation recorded in the file, in seconds since 1970. It is constant by default so that equal
    /// layers give equal bytes.
    std::int64_t created_s = 0;
};

/// Throws Error{usage} for settings that no printer could follow, such as an exposure of 0 s.
void check_resin_settings(const ResinSettings& settings);

/// Returns the environment variable SOURCE_DATE_EPOCH, in seconds since 1970, with which reproducible builds
/// set the time (reproducible-builds.org); 0 if it is not set. Throws Error{usage} if its value is not a
/// time.
[[nodiscard]] std::int64_t source_date();

} // namespace lamella
LAMELLA_API_END
