#include "lamella/core/error.hpp"

#include "slices/engine/layer_writers.hpp"
#include "slices/images/resin_archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace lamella {

namespace {

/// The printers take the first layers for those of the bottom, without reading how many there are.
constexpr std::uint32_t first_layers = 3;

/// Sizes of the preview images of a job in printers and programs.
constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 2> thumbnail_sizes{{{400, 400}, {800, 480}}};

/// `key = value` lines in the order of the keys.
using IniSettings = std::map<std::string, std::string>;

std::string text_of(const IniSettings& settings) {
    std::string text;
    for (const auto& [key, value] : settings)
        text += fmt::format("{} = {}\n", key, value);
    return text;
}

std::string number(double value) {
    return fmt::format("{:.9g}", value);
}

/// Returns the name of the job and its images. It is the name of the file in characters that every reader
/// accepts.
std::string job_name(const std::string& path) {
    std::string name = path == "-" ? "" : std::filesystem::path(path).stem().string();
    for (char& c : name) {
        const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
        c = plain || c == '-' || c == '.' ? c : '_';
    }
    // Readers ignore images whose names contain this word.
    constexpr std::string_view passed_over = "thumbnail";
    for (std::size_t at = name.find(passed_over); at != std::string::npos; at = name.find(passed_over, at))
        name.replace(at, passed_over.size(), "thumb_nail");
    return name.empty() ? "layers" : name;
}

/// Returns the printer of the options, or else the one that the format is named after.
ResinPrinter sl1_printer(const LayerFileInfo& info, const LayerWriteOptions& options,
                         std::string_view format) {
    if (options.printer != nullptr)
        return printer_for(info, options, format);
    const std::span<const ResinPrinter> all = resin_printers();
    return *std::find_if(all.begin(), all.end(),
                         [&](const ResinPrinter& printer) { return printer.format == format; });
}

constexpr std::string_view maker = "Original Prusa ";

/// Returns the options with the number of bottom layers that the printers assume, if it is another one in a
/// file that is converted.
LayerWriteOptions with_first_layers(LayerWriteOptions options) {
    if (options.resin_of_file)
        options.resin.bottom_layers = first_layers;
    return options;
}

class Sl1Writer final : public ResinArchive {
  public:
    Sl1Writer(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options,
              std::string_view format)
        : ResinArchive(path, info, with_first_layers(options),
                       {.name = "an SL1 job", .own_heights = false, .own_exposures = false},
                       sl1_printer(info, options, format)),
          job_(job_name(info.memory == nullptr ? path : "")) {
        if (options.resin_of_file && options.resin.bottom_layers.value_or(first_layers) != first_layers)
            leave_out(fmt::format("{} bottom layers", *options.resin.bottom_layers));
        if (plan().bottom_layers() != first_layers)
            throw Error(ErrorKind::usage,
                        fmt::format("an SL1 job has {} bottom layers, not {}: leave out their number",
                                    first_layers, plan().bottom_layers()));
        const std::string_view name = printer().name;
        model_ = name.starts_with(maker) ? name.substr(maker.size()) : name;
    }

  private:
    std::string image_name(const ResinLayer& layer) const override {
        return fmt::format("{}{:05}.png", job_, layer.number);
    }

    void add_entries(const ResinTotals& totals) override {
        add_text("config.ini", text_of(job(totals)));
        add_text("prusaslicer.ini", text_of(profile(totals)));
        const ColourImage whole = preview();
        for (const auto& [width, height] : thumbnail_sizes)
            add_preview(whole, fmt::format("thumbnail/thumbnail{}x{}.png", width, height), width, height);
    }

    /// Returns the settings that the printer reads.
    [[nodiscard]] IniSettings job(const ResinTotals& totals) const {
        return {{"action", "print"},
                {"expTime", number(plan().exposure_s())},
                {"expTimeFirst", number(plan().bottom_exposure_s())},
                {"expUserProfile", "0"},
                {"fileCreationTimestamp", utc_text(plan().settings().created_s, " at ") + " UTC"},
                {"hollow", "0"},
                {"jobDir", job_},
                {"layerHeight", number(totals.layer_mm)},
                {"materialName", ""},
                {"numFade", fmt::to_string(plan().transition_layers())},
                {"numFast", fmt::to_string(totals.small_layers)},
                {"numSlow", fmt::to_string(totals.large_layers)},
                {"printProfile", ""},
                {"printTime", fmt::format("{:.6f}", totals.print_time_s)},
                {"printerModel", model_},
                {"printerProfile", std::string(maker) + model_},
                {"printerVariant", "default"},
                {"prusaSlicerVersion", "Lamella"},
                {"usedMaterial", fmt::format("{:.6f}", totals.volume_ml)}};
    }

    /// Returns the settings for programs that show the job or extract its layers.
    [[nodiscard]] IniSettings profile(const ResinTotals& totals) const {
        const auto flag = [](bool on) {
            return std::string(on ? "1" : "0");
        };
        const std::string width = number(display().width_mm());
        const std::string height = number(display().height_mm());
        return {{"area_fill", number(printer().large_area * 100)},
                {"bed_shape", fmt::format("0x0,{0}x0,{0}x{1},0x{1}", width, height)},
                {"display_height", height},
                {"display_mirror_x", flag(display().mirror_x)},
                {"display_mirror_y", flag(display().mirror_y)},
                {"display_orientation", display().portrait ? "portrait" : "landscape"},
                {"display_pixels_x", fmt::to_string(display().pixels.x)},
                {"display_pixels_y", fmt::to_string(display().pixels.y)},
                {"display_width", width},
                {"exposure_time", number(plan().exposure_s())},
                {"faded_layers", fmt::to_string(plan().transition_layers())},
                {"fast_tilt_time", number(printer().small_pause_s)},
                {"gamma_correction", number(raster().gamma)},
                {"initial_exposure_time", number(plan().bottom_exposure_s())},
                {"initial_layer_height", number(totals.first_layer_mm)},
                {"layer_height", number(totals.layer_mm)},
                {"printer_model", model_},
                {"printer_technology", "SLA"},
                {"printer_variant", "default"},
                {"slow_tilt_time", number(printer().large_pause_s)}};
    }

    std::string job_;
    std::string model_;
};

} // namespace

std::unique_ptr<LayerWriter> open_sl1(const std::string& path, const LayerFileInfo& info,
                                      const LayerWriteOptions& options) {
    return std::make_unique<Sl1Writer>(path, info, options, "sl1");
}

std::unique_ptr<LayerWriter> open_sl1s(const std::string& path, const LayerFileInfo& info,
                                       const LayerWriteOptions& options) {
    return std::make_unique<Sl1Writer>(path, info, options, "sl1s");
}

} // namespace lamella
