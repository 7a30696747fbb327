#include "lamella/core/error.hpp"

#include "container/zip_writer.hpp"
#include "contour/same_height.hpp"
#include "raster/relief.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/engine/ordered_writer.hpp"
#include "slices/images/display.hpp"
#include "slices/images/layer_images.hpp"
#include "slices/images/png.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

namespace lamella {

namespace {

// The displays are those of Prusa's printers; the exposures are Prusa's values for its Orange Tough resin in
// layers of 0.05 mm.
constexpr ImagePrinter original_sl1{.name = "SL1",
                                    .pixels = {2560, 1440},
                                    .display_mm = {120.96, 68.04},
                                    .portrait = true,
                                    .mirror_x = true,
                                    .normal_s = 7.5,
                                    .first_s = 35,
                                    .large_area = 0.5,
                                    .small_pause_s = 5,
                                    .large_pause_s = 8};
constexpr ImagePrinter speed_sl1s{.name = "SL1S",
                                  .pixels = {2560, 1620},
                                  .display_mm = {128, 81},
                                  .portrait = true,
                                  .mirror_x = true,
                                  .normal_s = 2,
                                  .first_s = 25,
                                  .large_area = 0.45,
                                  .small_pause_s = 2.5,
                                  .large_pause_s = 5};

constexpr std::uint64_t first_layers = 3;

/// Sizes of the preview images of a job in printers and programs.
constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 2> thumbnail_sizes{{{400, 400}, {800, 480}}};
constexpr std::uint32_t relief_side = 640;

/// `key = value` lines in the order of the keys.
using Settings = std::map<std::string, std::string>;

std::string text_of(const Settings& settings) {
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

std::string time_text(std::int64_t seconds) {
    using namespace std::chrono;
    const sys_seconds time{std::chrono::seconds(seconds)};
    const sys_days day = floor<days>(time);
    const year_month_day date(day);
    const hh_mm_ss clock(time - day);
    return fmt::format("{:04}-{:02}-{:02} at {:02}:{:02}:{:02} UTC", static_cast<int>(date.year()),
                       static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                       clock.hours().count(), clock.minutes().count(), clock.seconds().count());
}

double exposure(const std::optional<double>& given, double common, std::string_view what) {
    const double seconds = given.value_or(common);
    if (!(seconds > 0) || !std::isfinite(seconds))
        throw Error(ErrorKind::usage, fmt::format("{} of {} s: choose a positive number", what, seconds));
    return seconds;
}

class Sl1Writer final : public OrderedWriter {
  public:
    Sl1Writer(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options,
              const ImagePrinter& printer)
        : OrderedWriter(info, {.open_chains = false, .supports = true}), printer_(printer),
          display_(display_for(info.box, options.image, printer)),
          images_(display_.grid(info.box), options.image.raster), relief_(info.box, relief_side, relief_side),
          normal_s_(exposure(options.exposure.normal_s, printer.normal_s, "an exposure")),
          first_s_(exposure(options.exposure.first_s, printer.first_s, "a first exposure")),
          fade_layers_(options.exposure.fade_layers), created_(time_text(options.exposure.created_s)),
          job_(job_name(info.memory == nullptr ? path : "")), archive_(path, Overwriting::no, info.memory) {}

    std::uint64_t bytes() const noexcept override { return archive_.bytes(); }

  private:
    Write formatted(const Plane& plane) override {
        return [this, image = images_.image(plane.polylines),
                seen = relief_.spans(plane.polylines)](const PlanePosition& offset, Completions& after) {
            relief_.add(seen);
            count(offset, image.areas.covered * display_.pixel_mm2());
            add_loss(unseen_material(offset.z, image.areas, display_.pixel_mm2()));
            archive_.add_ready(fmt::format("{}{:05}.png", job_, offset.position), ZipMethod::stored,
                               image.in_zip(), image.file, after);
        };
    }

    void end_file() override {
        archive_.add("config.ini", text_of(job()), ZipMethod::deflated);
        archive_.add("prusaslicer.ini", text_of(profile()), ZipMethod::deflated);
        add_thumbnails();
        archive_.finish();
    }

    void add_thumbnails() {
        const ColourImage whole = relief_.image();
        for (const auto& [width, height] : thumbnail_sizes) {
            ByteBuffer file;
            append_png(fitted(whole, width, height), file);
            archive_.add(fmt::format("thumbnail/thumbnail{}x{}.png", width, height), file.view());
        }
    }

    /// Adds the figures of a layer. Throws unless the layer lies on the previous one and has its thickness:
    /// the printer has a single layer height, except for the first layer.
    void count(const PlanePosition& offset, double area_mm2) {
        const double thickness = offset.top - offset.bottom;
        if (offset.position == 0)
            first_thickness_ = thickness;
        if (offset.position <= 1)
            thickness_ = thickness;
        const double slack = thickness_ / 100 + same_height_mm; // heights of the input may be rounded
        if (std::abs(thickness - thickness_) > slack)
            throw Error(
                ErrorKind::usage,
                fmt::format("an SL1 job has one layer height, but for the first layer: layer {} is {:.6g} "
                            "mm thick, the one before {:.6g} mm",
                            offset.index, thickness, thickness_));
        if (offset.position > 0 && std::abs(offset.bottom - top_) > slack)
            throw Error(ErrorKind::usage,
                        fmt::format("layers of an SL1 job lie on one another: layer {} begins at {:.6g} mm, "
                                    "the one before ends at {:.6g} mm",
                                    offset.index, offset.bottom, top_));
        top_ = offset.top;
        volume_mm3_ += area_mm2 * thickness;
        const bool large = area_mm2 > printer_.large_area * display_.width_mm() * display_.height_mm();
        ++(large ? large_layers_ : small_layers_);
        const double faded =
            offset.position < first_layers ? 0 : static_cast<double>(offset.position - first_layers + 1);
        const double to_normal = std::min(1.0, faded / (fade_layers_ + 1.0));
        time_s_ += first_s_ + to_normal * (normal_s_ - first_s_) +
                   (large ? printer_.large_pause_s : printer_.small_pause_s);
    }

    /// Returns the settings that the printer reads.
    [[nodiscard]] Settings job() const {
        return {{"action", "print"},
                {"expTime", number(normal_s_)},
                {"expTimeFirst", number(first_s_)},
                {"expUserProfile", "0"},
                {"fileCreationTimestamp", created_},
                {"hollow", "0"},
                {"jobDir", job_},
                {"layerHeight", number(thickness_)},
                {"materialName", ""},
                {"numFade", fmt::to_string(fade_layers_)},
                {"numFast", fmt::to_string(small_layers_)},
                {"numSlow", fmt::to_string(large_layers_)},
                {"printProfile", ""},
                {"printTime", fmt::format("{:.6f}", time_s_)},
                {"printerModel", std::string(printer_.name)},
                {"printerProfile", fmt::format("Original Prusa {}", printer_.name)},
                {"printerVariant", "default"},
                {"prusaSlicerVersion", "Lamella"},
                {"usedMaterial", fmt::format("{:.6f}", volume_mm3_ / 1000)}};
    }

    /// Returns the settings for programs that show the job or extract its layers.
    [[nodiscard]] Settings profile() const {
        const auto flag = [](bool on) {
            return std::string(on ? "1" : "0");
        };
        const std::string width = number(display_.width_mm());
        const std::string height = number(display_.height_mm());
        return {{"area_fill", number(printer_.large_area * 100)},
                {"bed_shape", fmt::format("0x0,{0}x0,{0}x{1},0x{1}", width, height)},
                {"display_height", height},
                {"display_mirror_x", flag(display_.mirror_x)},
                {"display_mirror_y", flag(display_.mirror_y)},
                {"display_orientation", display_.portrait ? "portrait" : "landscape"},
                {"display_pixels_x", fmt::to_string(display_.pixels.x)},
                {"display_pixels_y", fmt::to_string(display_.pixels.y)},
                {"display_width", width},
                {"exposure_time", number(normal_s_)},
                {"faded_layers", fmt::to_string(fade_layers_)},
                {"fast_tilt_time", number(printer_.small_pause_s)},
                {"gamma_correction", number(images_.options().gamma)},
                {"initial_exposure_time", number(first_s_)},
                {"initial_layer_height", number(first_thickness_)},
                {"layer_height", number(thickness_)},
                {"printer_model", std::string(printer_.name)},
                {"printer_technology", "SLA"},
                {"printer_variant", "default"},
                {"slow_tilt_time", number(printer_.large_pause_s)}};
    }

    ImagePrinter printer_;
    Display display_;
    LayerImages images_;
    Relief relief_;
    double normal_s_;
    double first_s_;
    std::uint32_t fade_layers_;
    std::string created_;
    std::string job_;
    double first_thickness_ = 0;
    double thickness_ = 0; ///< of the second layer, once there is one
    double top_ = 0;       ///< of the previous layer
    double volume_mm3_ = 0;
    double time_s_ = 0;
    std::uint64_t small_layers_ = 0;
    std::uint64_t large_layers_ = 0;
    ZipWriter archive_;
};

} // namespace

std::unique_ptr<LayerWriter> open_sl1(const std::string& path, const LayerFileInfo& info,
                                      const LayerWriteOptions& options) {
    return std::make_unique<Sl1Writer>(path, info, options, original_sl1);
}

std::unique_ptr<LayerWriter> open_sl1s(const std::string& path, const LayerFileInfo& info,
                                       const LayerWriteOptions& options) {
    return std::make_unique<Sl1Writer>(path, info, options, speed_sl1s);
}

} // namespace lamella
