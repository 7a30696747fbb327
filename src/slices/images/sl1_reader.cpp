// The jobs of Prusa's SL1 and SL1S: `config.ini` has what the printer reads. `prusaslicer.ini` has the
// display; if it is missing, the display is that of the printer.

#include "lamella/core/error.hpp"
#include "lamella/slices/resin_printer.hpp"

#include "container/parse_number.hpp"
#include "slices/engine/layer_readers.hpp"
#include "slices/images/display.hpp"
#include "slices/images/image_reader.hpp"
#include "slices/images/png_stack.hpp"
#include "slices/images/resin_job.hpp"
#include "slices/images/resin_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// The printers take this number of layers for those of the bottom.
constexpr std::uint32_t sl1_bottom_layers = 3;

std::string_view without_blanks(std::string_view text) {
    constexpr std::string_view blanks = " \t\r\n";
    const std::size_t begin = std::min(text.find_first_not_of(blanks), text.size());
    const std::size_t end = text.find_last_not_of(blanks);
    return end == std::string_view::npos ? std::string_view() : text.substr(begin, end + 1 - begin);
}

/// The `key = value` lines of a file.
class IniFile {
  public:
    IniFile(std::string_view text, std::string name) : name_(std::move(name)) {
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            const std::string_view line = text.substr(0, end);
            text.remove_prefix(std::min(end + 1, text.size()));
            const std::size_t equals = line.find('=');
            if (equals != std::string_view::npos && !line.starts_with('#') && !line.starts_with(';'))
                values_.try_emplace(std::string(without_blanks(line.substr(0, equals))),
                                    without_blanks(line.substr(equals + 1)));
        }
    }

    [[nodiscard]] std::string text(const std::string& key) const {
        const auto found = values_.find(key);
        return found == values_.end() ? std::string() : found->second;
    }
    /// Returns a number that is not negative, or `otherwise` if the file does not have it.
    [[nodiscard]] double number(const std::string& key, double otherwise) const {
        const auto found = values_.find(key);
        if (found == values_.end() || found->second.empty())
            return otherwise;
        const std::string& value = found->second;
        double number = 0;
        const char* const end = value.data() + value.size();
        if (parse_number(value.data(), end, number) != end || !(number >= 0) || !(number < 1e12))
            throw Error(ErrorKind::input, fmt::format("{}: found {} = '{}'; a number, 0 or more, is expected",
                                                      name_, key, printable(value, 60)));
        return number;
    }

  private:
    std::string name_;
    std::map<std::string, std::string> values_;
};

std::uint32_t count_of(double number) {
    return static_cast<std::uint32_t>(std::llround(std::min(number, 1e9)));
}

/// Returns the display of the profile, or that of the printer if there is no profile, for images of this
/// size.
Display sl1_display(const IniFile& profile, std::string_view format, AlongXY<std::uint32_t> image,
                    const std::string& name) {
    const std::span<const ResinPrinter> all = resin_printers();
    const auto printer =
        std::find_if(all.begin(), all.end(), [&](const ResinPrinter& one) { return one.format == format; });
    const std::string orientation = profile.text("display_orientation");
    Display display{.pixels = {count_of(profile.number("display_pixels_x", printer->pixels.x)),
                               count_of(profile.number("display_pixels_y", printer->pixels.y))},
                    .pixel_mm = {},
                    .portrait = orientation.empty() ? printer->portrait : orientation == "portrait",
                    .mirror_x = profile.number("display_mirror_x", printer->mirror_x ? 1 : 0) != 0,
                    .mirror_y = profile.number("display_mirror_y", printer->mirror_y ? 1 : 0) != 0};
    const AlongXY<std::uint32_t> along = display.portrait ? AlongXY<std::uint32_t>{image.y, image.x} : image;
    if (display.pixels.x != along.x || display.pixels.y != along.y)
        throw Error(ErrorKind::input,
                    fmt::format("{}: found images of {} x {} pixels; the display has {} x {}{}", name,
                                image.x, image.y, display.pixels.x, display.pixels.y,
                                display.portrait ? " (portrait)" : ""));
    const double width = profile.number("display_width", printer->display_mm.x);
    const double height = profile.number("display_height", printer->display_mm.y);
    if (!(width > 0 && width < 1e4 && height > 0 && height < 1e4))
        throw Error(ErrorKind::input, fmt::format("{}: found a display of {} x {} mm; positive numbers are "
                                                  "expected",
                                                  name, width, height));
    display.pixel_mm = {width / display.pixels.x, height / display.pixels.y};
    return display;
}

/// Puts in the exposures that the rule of bottom and transition layers gives.
void put_exposures(ImageStackHead& head) {
    const ResinPlan plan(head.job.settings, {});
    for (std::size_t i = 0; i < head.tops_mm.size(); ++i)
        head.job.exposures_s.push_back(plan.exposure_s(i, 0));
}

} // namespace

bool is_sl1(const ZipReader& archive) {
    const ZipEntry* const config = archive.find("config.ini");
    return config != nullptr &&
           std::any_of(archive.entries().begin(), archive.entries().end(),
                       [](const ZipEntry& entry) { return entry.name.ends_with("00000.png"); });
}

LayerFile read_sl1(const ZipReader& archive, ReadLimits& limits, const Execution& execution) {
    const IniFile config(text_of_entry(archive, "config.ini", limits), archive.name() + ", config.ini");
    const IniFile profile(text_of_entry(archive, "prusaslicer.ini", limits),
                          archive.name() + ", prusaslicer.ini");
    std::vector<const ZipEntry*> images = numbered_images(archive, config.text("jobDir"), 0);
    ImageStackHead head;
    ResinJob& job = head.job;
    head.format = config.text("printerModel") == "SL1S" ? "sl1s" : "sl1";
    job.printer = config.text("printerModel");
    const AlongXY<std::uint32_t> size = size_of_image(archive, *images.front());
    const Display display = sl1_display(profile, head.format, size, archive.name());
    job.pixels = size;
    job.display_mm = {display.width_mm(), display.height_mm()};
    if (display.portrait)
        std::swap(job.display_mm.x, job.display_mm.y);
    Box3 middle;
    middle.add(Point3{});
    head.grid = display.grid(middle);
    const double layer_mm = config.number("layerHeight", 0.05);
    const double first_mm = profile.number("initial_layer_height", layer_mm);
    for (std::size_t i = 0; i < images.size(); ++i)
        head.tops_mm.push_back(std::round((first_mm + static_cast<double>(i) * layer_mm) * 1e6) / 1e6);
    job.settings.exposure_s = config.number("expTime", 0);
    job.settings.bottom_exposure_s = config.number("expTimeFirst", 0);
    job.settings.bottom_layers = sl1_bottom_layers;
    job.settings.transition_layers = count_of(config.number("numFade", 0));
    job.settings = usable_settings(job.settings);
    job.volume_ml = config.number("usedMaterial", 0);
    job.time_s = config.number("printTime", 0);
    put_exposures(head);
    return read_images(std::move(head), std::make_shared<PngStack>(archive, std::move(images)),
                       archive.name(), limits, execution);
}

} // namespace lamella
