// A zip archive of images and the machine code that shows them, which the printer runs line by line.

#include "slices/engine/layer_writers.hpp"
#include "slices/images/resin_archive.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <string_view>

namespace lamella {

namespace {

/// Returns the number of milliseconds, for the command that waits.
long long milliseconds(double seconds) {
    return std::llround(1000 * seconds);
}

class ChituboxZipWriter final : public ResinArchive {
  public:
    ChituboxZipWriter(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options)
        : ResinArchive(path, info, options, {.name = "a Chitubox zip", .mirror_y = false},
                       printer_for(info, options, "chitubox-zip")) {}

  private:
    std::string image_name(const ResinLayer& layer) const override {
        return fmt::format("{}.png", layer.number + 1);
    }

    void note(const ResinLayer& layer, const std::string& /*text*/) override {
        const PlateTravel& travel = plan().travel(layer.number);
        code_ += fmt::format("\n;LAYER_START:{}\n;currPos:{:.4f}\nM6054 \"{}\";show image\n", layer.number,
                             layer.top_mm, image_name(layer));
        wait(travel.wait_before_lift_s);
        move(top_mm_ + travel.lift_mm, travel.lift_mm_min, travel.lift_mm);
        move(top_mm_ + lift_mm_of(travel), travel.lift2_mm_min, travel.lift2_mm);
        wait(travel.wait_after_lift_s);
        move(layer.top_mm + travel.retract2_mm, travel.retract_mm_min, retract_mm_of(travel));
        move(layer.top_mm, travel.retract2_mm_min, travel.retract2_mm);
        code_ += fmt::format("G4 P{};\nM106 S{};light on\nG4 P{};\nM106 S0;light off\n;LAYER_END\n",
                             milliseconds(plan().rest_s(travel)), plan().light_power(layer.number),
                             milliseconds(layer.exposure_s));
        top_mm_ = layer.top_mm;
    }

    /// Adds a movement to a height, unless its stage has no length.
    void move(double to_mm, double mm_min, double length_mm) {
        if (length_mm > 0)
            code_ += fmt::format("G0 Z{:.4f} F{:.9g};\n", to_mm, mm_min);
    }

    void wait(double seconds) {
        if (seconds > 0 && plan().settings().light_off_s == 0)
            code_ += fmt::format("G4 P{};\n", milliseconds(seconds));
    }

    void add_entries(const ResinTotals& totals) override {
        const std::string begin = ";START_GCODE_BEGIN\nG21;\nG90;\nM106 S0;\nG28 Z0;\n;START_GCODE_END\n";
        const std::string end = fmt::format(
            "\n;END_GCODE_BEGIN\nM106 S0;\nG1 Z{:.4f} F25;\nM18;\n;END_GCODE_END\n", machine_mm());
        add_text("run.gcode", header(totals) + begin + code_ + end);
        const ColourImage whole = preview();
        add_preview(whole, "preview.png", 400, 300);
        add_preview(whole, "preview_cropping.png", 200, 125);
    }

    [[nodiscard]] std::string header(const ResinTotals& totals) const {
        const ResinSettings& settings = plan().settings();
        std::string text;
        const auto add = [&text](std::string_view key, const auto& value) {
            text += fmt::format(";{}:{}\n", key, value);
        };
        const auto add_number = [&text](std::string_view key, double value) {
            text += fmt::format(";{}:{:.9g}\n", key, value);
        };
        add("fileName", "layers");
        add("machineType", printer().name.empty() ? std::string_view(machine_name()) : printer().name);
        add("estimatedPrintTime", std::llround(totals.print_time_s));
        add_number("volume", totals.volume_ml);
        add("resin", "default");
        add_number("weight", totals.mass_g);
        add_number("price", totals.price);
        add_number("layerHeight", totals.layer_mm);
        add("resolutionX", grid().width);
        add("resolutionY", grid().height);
        add_number("machineX", display().image_mm().x);
        add_number("machineY", display().image_mm().y);
        add_number("machineZ", machine_mm());
        add("projectType", "mirror_LCD");
        add_number("normalExposureTime", plan().exposure_s());
        add_number("bottomLayExposureTime", plan().bottom_exposure_s());
        add_number("bottomLayerExposureTime", plan().bottom_exposure_s());
        add_number("normalDropSpeed", settings.travel.retract_mm_min);
        add_number("normalLayerLiftHeight", lift_mm_of(settings.travel));
        add_number("zSlowUpDistance", 0);
        add_number("normalLayerLiftSpeed", settings.travel.lift_mm_min);
        add("bottomLayCount", plan().bottom_layers());
        add("bottomLayerCount", plan().bottom_layers());
        add("mirror", display().mirror_x ? 1 : 0);
        add("totalLayer", totals.layers);
        add_number("bottomLayerLiftHeight", lift_mm_of(settings.bottom_travel));
        add_number("bottomLayerLiftSpeed", settings.bottom_travel.lift_mm_min);
        add_number("bottomLightOffTime", plan().rest_s(settings.bottom_travel));
        add_number("lightOffTime", plan().rest_s(settings.travel));
        return text + '\n';
    }

    std::string code_;  ///< of the layers
    double top_mm_ = 0; ///< of the previous layer
};

} // namespace

std::unique_ptr<LayerWriter> open_chitubox_zip(const std::string& path, const LayerFileInfo& info,
                                               const LayerWriteOptions& options) {
    return std::make_unique<ChituboxZipWriter>(path, info, options);
}

} // namespace lamella
