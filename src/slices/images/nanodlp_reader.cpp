// A zip archive of images, and of settings in several JSON documents: of those that have a setting, the first
// in this order counts: options, slicer, profile, plate.

#include "lamella/core/error.hpp"

#include "container/json_text.hpp"
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

/// The numbers and texts of the outermost objects of JSON documents.
class NanoSettings {
  public:
    explicit NanoSettings(std::string name) : name_(std::move(name)) {}

    void add(std::string_view text, const std::string& document) {
        if (text.empty())
            return;
        JsonText json(text, fmt::format("{}, {}", name_, document));
        json.object([&](const std::string& key) {
            json.skip_blanks();
            const char next = json.at() < text.size() ? text[json.at()] : '\0';
            if (next == '"')
                texts_.try_emplace(key, json.string());
            else if (next == '-' || (next >= '0' && next <= '9'))
                numbers_.try_emplace(key, json.number());
            else
                json.skip();
        });
    }

    [[nodiscard]] std::string text(const std::string& key) const {
        const auto found = texts_.find(key);
        return found == texts_.end() ? std::string() : found->second;
    }
    /// Returns a number that is not negative. Throws Error{input} if there is none, unless `otherwise` is
    /// given.
    [[nodiscard]] double number(const std::string& key, std::optional<double> otherwise = {}) const {
        std::optional<double> number;
        if (const auto found = numbers_.find(key); found != numbers_.end())
            number = found->second;
        else if (const std::string written = text(key); !written.empty()) {
            const char* const end = written.data() + written.size();
            double value = 0;
            if (parse_number(written.data(), end, value) == end)
                number = value;
        }
        if (!number && otherwise)
            return *otherwise;
        if (!number || !(*number >= 0) || !(*number < 1e12))
            throw Error(ErrorKind::input,
                        fmt::format("{}: found {}; the number {}, 0 or more, is expected", name_,
                                    number ? fmt::format("{}", *number) : "no " + key, key));
        return *number;
    }

  private:
    std::string name_;
    std::map<std::string, double> numbers_;
    std::map<std::string, std::string> texts_;
};

std::uint32_t whole_number(double number) {
    return static_cast<std::uint32_t>(std::llround(std::clamp(number, 0.0, 1e9)));
}

ImageStackHead nano_head(const NanoSettings& settings, const std::string& name, std::size_t layers) {
    ImageStackHead head;
    ResinJob& job = head.job;
    head.format = "nanodlp";
    job.version = settings.text("FormatVersion");
    job.printer = settings.text("Title");
    job.pixels = {whole_number(settings.number("PWidth")), whole_number(settings.number("PHeight"))};
    job.display_mm = {job.pixels.x * settings.number("XPixelSize", 0),
                      job.pixels.y * settings.number("YPixelSize", 0)};
    job.settings.exposure_s = settings.number("CureTime", 0);
    job.settings.bottom_exposure_s = settings.number("SupportCureTime", 0);
    job.settings.bottom_layers = whole_number(settings.number("SupportLayerNumber", 0));
    job.settings.transition_layers = whole_number(settings.number("TransitionalLayer", 0));
    job.settings.price_per_litre = settings.number("ResinPrice", 0);
    job.settings = usable_settings(job.settings);
    job.volume_ml = settings.number("TotalSolidArea", 0) / 1000;
    const std::uint32_t mirror = whole_number(settings.number("ImageMirror", 1));
    head.grid = grid_of_display(name, job.pixels, job.display_mm, (mirror & 1U) != 0, (mirror & 2U) != 0);
    const double layer_um = settings.number("Thickness", settings.number("Depth", 50));
    const ResinPlan plan(job.settings, {});
    for (std::size_t i = 0; i < layers; ++i) {
        head.tops_mm.push_back(std::round(static_cast<double>(i + 1) * layer_um * 1e3) / 1e6);
        job.exposures_s.push_back(plan.exposure_s(i, 0));
    }
    return head;
}

} // namespace

bool is_nanodlp(const ZipReader& archive) {
    return archive.find("plate.json") != nullptr && archive.find("1.png") != nullptr;
}

LayerFile read_nanodlp(const ZipReader& archive, ReadLimits& limits, const Execution& execution) {
    NanoSettings settings(archive.name());
    for (const std::string document :
         {"options.json", "slicer.json", "profile.json", "plate.json", "meta.json"})
        settings.add(text_of_entry(archive, document, limits), document);
    std::vector<const ZipEntry*> images = numbered_images(archive, "", 1);
    if (const double expected = settings.number("LayersCount", static_cast<double>(images.size()));
        expected != static_cast<double>(images.size()))
        throw Error(ErrorKind::input, fmt::format("{}: found {} images; plate.json says that there are {}",
                                                  archive.name(), images.size(), expected));
    ImageStackHead head = nano_head(settings, archive.name(), images.size());
    return read_images(std::move(head), std::make_shared<PngStack>(archive, std::move(images)),
                       archive.name(), limits, execution);
}

} // namespace lamella
