// A zip archive of images and machine code. Comments at its beginning have the settings; the code of each
// layer has its height and its exposure.

#include "lamella/core/error.hpp"

#include "container/parse_number.hpp"
#include "slices/engine/layer_readers.hpp"
#include "slices/images/image_reader.hpp"
#include "slices/images/png_stack.hpp"
#include "slices/images/resin_job.hpp"
#include "slices/images/resin_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

namespace {

constexpr std::string_view code_name = "run.gcode";

/// Returns the number at the beginning of a text, if there is one.
std::optional<double> leading_number(std::string_view text) {
    const char* const end = text.data() + text.size();
    double number = 0;
    if (parse_number(text.data(), end, number) == text.data() || !std::isfinite(number))
        return std::nullopt;
    return number;
}

/// The settings in the comments of machine code, and its layers.
class MachineCode {
  public:
    MachineCode(std::string_view text, std::string name) : name_(std::move(name)) {
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            std::string_view line = text.substr(0, end);
            text.remove_prefix(std::min(end + 1, text.size()));
            if (line.ends_with('\r'))
                line.remove_suffix(1);
            take(line);
        }
    }

    [[nodiscard]] std::string text(const std::string& key) const {
        const auto found = values_.find(key);
        return found == values_.end() ? std::string() : found->second;
    }
    /// Returns a number that is not negative. Throws Error{input} if there is none, unless `otherwise` is
    /// given.
    [[nodiscard]] double number(const std::string& key, std::optional<double> otherwise = {}) const {
        const auto found = values_.find(key);
        if (found == values_.end() && otherwise)
            return *otherwise;
        const std::string value = found == values_.end() ? std::string() : found->second;
        const std::optional<double> number = leading_number(value);
        if (!number || !(*number >= 0) || *number > 1e12)
            throw Error(
                ErrorKind::input,
                fmt::format("{}: found {}; ;{}: and a number, 0 or more, are expected", name_,
                            found == values_.end() ? "no " + key : fmt::format("'{}'", printable(value, 60)),
                            key));
        return *number;
    }
    /// Returns the heights and the exposures in the code of the layers.
    [[nodiscard]] const std::vector<double>& tops_mm() const noexcept { return tops_mm_; }
    [[nodiscard]] const std::vector<double>& exposures_s() const noexcept { return exposures_s_; }

  private:
    void take(std::string_view line) {
        constexpr std::string_view height = ";currPos:";
        constexpr std::string_view layer = ";LAYER_START:";
        constexpr std::string_view light = "M106 S";
        constexpr std::string_view wait = "G4 P";
        if (line.starts_with(layer)) {
            in_layers_ = true;
            exposures_s_.push_back(0);
        } else if (line.starts_with(height) && in_layers_) {
            tops_mm_.push_back(leading_number(line.substr(height.size())).value_or(0));
        } else if (!in_layers_ && line.starts_with(';')) {
            const std::size_t colon = std::min(line.find(':'), line.size());
            if (colon < line.size())
                values_.try_emplace(std::string(line.substr(1, colon - 1)), line.substr(colon + 1));
        } else if (line.starts_with(light)) {
            is_lit_ = leading_number(line.substr(light.size())).value_or(0) > 0;
        } else if (line.starts_with(wait) && is_lit_ && in_layers_) {
            exposures_s_.back() += leading_number(line.substr(wait.size())).value_or(0) / 1000;
        }
    }

    std::string name_;
    std::map<std::string, std::string> values_; ///< of the comments before the first layer
    std::vector<double> tops_mm_;
    std::vector<double> exposures_s_;
    bool in_layers_ = false;
    bool is_lit_ = false;
};

std::uint32_t whole(double number) {
    return static_cast<std::uint32_t>(std::llround(std::clamp(number, 0.0, 1e9)));
}

ResinSettings settings_in(const MachineCode& code) {
    ResinSettings settings;
    settings.exposure_s = code.number("normalExposureTime", 0);
    settings.bottom_exposure_s =
        code.number("bottomLayerExposureTime", code.number("bottomLayExposureTime", 0));
    settings.bottom_layers = whole(code.number("bottomLayerCount", code.number("bottomLayCount", 0)));
    settings.transition_layers = 0;
    PlateTravel& travel = settings.travel;
    PlateTravel& bottom = settings.bottom_travel;
    travel.lift_mm = code.number("normalLayerLiftHeight", travel.lift_mm);
    travel.lift_mm_min = code.number("normalLayerLiftSpeed", travel.lift_mm_min);
    travel.retract_mm_min = bottom.retract_mm_min = code.number("normalDropSpeed", travel.retract_mm_min);
    travel.wait_after_retract_s = code.number("lightOffTime", travel.wait_after_retract_s);
    bottom.lift_mm = code.number("bottomLayerLiftHeight", bottom.lift_mm);
    bottom.lift_mm_min = code.number("bottomLayerLiftSpeed", bottom.lift_mm_min);
    bottom.wait_after_retract_s = code.number("bottomLightOffTime", bottom.wait_after_retract_s);
    return usable_settings(settings);
}

/// Puts in heights and exposures of the code, or else those that the settings give.
void put_layers(const MachineCode& code, std::size_t layers, ImageStackHead& head) {
    const double layer_mm = code.number("layerHeight");
    const bool heights = code.tops_mm().size() == layers;
    const bool exposures = code.exposures_s().size() == layers;
    const ResinPlan plan(head.job.settings, {});
    for (std::size_t i = 0; i < layers; ++i) {
        head.tops_mm.push_back(heights ? code.tops_mm()[i]
                                       : std::round(static_cast<double>(i + 1) * layer_mm * 1e6) / 1e6);
        head.job.exposures_s.push_back(exposures ? code.exposures_s()[i] : plan.exposure_s(i, 0));
    }
}

} // namespace

bool is_chitubox_zip(const ZipReader& archive) {
    return archive.find(code_name) != nullptr && archive.find("1.png") != nullptr;
}

LayerFile read_chitubox_zip(const ZipReader& archive, ReadLimits& limits, const Execution& execution) {
    const MachineCode code(text_of_entry(archive, code_name, limits),
                           fmt::format("{}, {}", archive.name(), code_name));
    std::vector<const ZipEntry*> images = numbered_images(archive, "", 1);
    ImageStackHead head;
    ResinJob& job = head.job;
    head.format = "chitubox-zip";
    job.printer = code.text("machineType");
    job.pixels = {whole(code.number("resolutionX")), whole(code.number("resolutionY"))};
    job.display_mm = {code.number("machineX"), code.number("machineY")};
    if (const double expected = code.number("totalLayer", static_cast<double>(images.size()));
        expected != static_cast<double>(images.size()))
        throw Error(ErrorKind::input, fmt::format("{}: found {} images; {} says that there are {}",
                                                  archive.name(), images.size(), code_name, expected));
    job.settings = settings_in(code);
    job.volume_ml = code.number("volume", 0);
    job.mass_g = code.number("weight", 0);
    job.price = code.number("price", 0);
    job.settings.currency.clear(); // the file does not say it
    job.time_s = code.number("estimatedPrintTime", 0);
    const ResinPrinter* const printer = known_printer(job.printer);
    head.grid = grid_of_display(archive.name(), job.pixels, job.display_mm, code.number("mirror", 1) == 1,
                                printer != nullptr && printer->mirror_y);
    put_layers(code, images.size(), head);
    return read_images(std::move(head), std::make_shared<PngStack>(archive, std::move(images)),
                       archive.name(), limits, execution);
}

} // namespace lamella
