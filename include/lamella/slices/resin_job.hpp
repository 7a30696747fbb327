#pragma once

// Jobs of resin printers as their files describe them.

#include "lamella/contour/layer.hpp"
#include "lamella/slices/image_options.hpp"
#include "lamella/slices/resin_settings.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// The job of a file with images. Numbers that the file does not have are 0.
struct ResinJob {
    std::string version = {}; ///< of the format; "" if it has none
    std::string printer = {}; ///< name of the printer; "" if the file has none
    /// Columns and rows of the images, and the size of the display along them.
    AlongXY<std::uint32_t> pixels{};
    AlongXY<double> display_mm{};
    /// Settings as far as the format has them; the others have their defaults.
    ResinSettings settings = {};
    unsigned antialias = 0;               ///< the level of anti-aliasing
    std::vector<double> exposures_s = {}; ///< of each layer
    double volume_ml = 0;
    double mass_g = 0;
    double price = 0;
    double time_s = 0;
};

/// Returns the settings by which a writer gives each layer the exposure of the job. Where the rule of bottom,
/// transition and other layers does not give it, a range of heights does. The planes are those of the file.
[[nodiscard]] ResinSettings settings_of(const ResinJob& job, std::span<const Layer> planes);

} // namespace lamella
LAMELLA_API_END
