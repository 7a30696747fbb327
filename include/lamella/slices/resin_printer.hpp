#pragma once

// Resin printers: their displays and files.

#include "lamella/slices/image_options.hpp"

#include <cstdint>
#include <span>
#include <string_view>

LAMELLA_API_BEGIN
namespace lamella {

/// A printer that exposes images of layers.
struct ResinPrinter {
    std::string_view name = {};      ///< name in help and in files; "" for no printer
    std::string_view format = {};    ///< name of the format that it reads; "" for any
    std::string_view extension = {}; ///< of its files, with the dot
    std::uint32_t version = 0;       ///< of the format; 0 for the usual one
    AlongXY<std::uint32_t> pixels{};
    AlongXY<double> display_mm{};
    /// Orientation, as in ImageOptions.
    bool portrait = false;
    bool mirror_x = false;
    bool mirror_y = false;
    double height_mm = 0; ///< the largest height of a part; 0 if unknown
    bool grey = true;     ///< false if the display shows only black and white

    // Settings for layers of 0.05 mm, if there are none in ResinSettings.
    double exposure_s = 2.5;
    double bottom_exposure_s = 30;
    std::uint32_t bottom_layers = 5;
    std::uint32_t transition_layers = 5;

    /// Printers that tilt the vat: a layer is large if it covers more than this fraction of the display. The
    /// pauses are the times without exposure for small and for large layers. Other printers lift the plate,
    /// and the pauses are 0.
    double large_area = 0.5;
    double small_pause_s = 0;
    double large_pause_s = 0;
};

/// Returns all printers whose files can be written, in the order of their names.
[[nodiscard]] std::span<const ResinPrinter> resin_printers() noexcept;

/// Returns the printer of this name, in any case of letters. The name may lack the maker, and any part of a
/// name will do if no other name has it. Throws Error{usage}, which lists the printers that may be meant.
[[nodiscard]] const ResinPrinter& find_resin_printer(std::string_view text);

} // namespace lamella
LAMELLA_API_END
