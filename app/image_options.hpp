#pragma once

// Options of image formats.

#include "lamella/slices/layer_file.hpp"
#include "lamella/slices/layer_writer.hpp"

#include "command.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lamella::app {

struct ImageArguments {
    std::string printer = {};
    std::string resin = {}; ///< path of a file of settings
    std::optional<AlongXY<double>> pixel_mm = {};
    std::optional<AlongXY<std::uint32_t>> pixels = {};
    std::optional<AlongXY<double>> display_mm = {};
    std::string orientation = {};
    std::string mirror = {};
    std::optional<std::uint32_t> antialias = {};
    std::optional<double> gamma = {};
    std::optional<GreyValues> grey_values = {};
    std::optional<std::vector<PartColour>> part_colours = {};
    std::optional<std::uint32_t> cuts = {}; ///< see FileJob::image_cuts
    std::optional<double> exposure_s = {};
    std::optional<double> first_exposure_s = {};
    std::optional<std::uint32_t> fade_layers = {};

    /// Applies the options. Throws Error{usage} if some do not apply to the format, or if SOURCE_DATE_EPOCH
    /// is not a time.
    void apply(const LayerFormat& format, LayerWriteOptions& options) const;
    /// Applies the options to the settings of a file that is converted: what is not given stays as it is in
    /// the file. Nothing happens if it is no job for a resin printer.
    void apply_to(const LayerFile& file, const LayerFormat& format, LayerFileInfo& info,
                  LayerWriteOptions& options) const;
    /// Returns a warning if the file is for a printer that does not read this format, and none is given.
    [[nodiscard]] std::optional<std::string> other_printer(const LayerFile& file,
                                                           const LayerFormat& format) const;

  private:
    /// Returns these settings, changed by the options.
    [[nodiscard]] ResinSettings settings_on(ResinSettings settings) const;
};

[[nodiscard]] OptionGroup image_options(ImageArguments& target);
/// Returns the option that sets `cuts`, which needs a mesh.
[[nodiscard]] Option z_antialias_option(ImageArguments& target);

} // namespace lamella::app
