// A zip archive of images and their settings as JSON. Heights of layers are in micrometres. Of the two names
// of the options, the printer reads one and other programs the other, so both are written.

#include "lamella/contour/measure.hpp"
#include "lamella/core/version.hpp"

#include "container/quoted.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/images/resin_archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

namespace lamella {

namespace {

/// The columns and rows that contours touch, and the areas that outer contours enclose.
struct NanoLayer {
    double min_u = std::numeric_limits<double>::infinity();
    double min_v = min_u;
    double max_u = 0;
    double max_v = 0;
    double largest_mm2 = 0;
    double smallest_mm2 = min_u;
    std::size_t outer = 0;

    void add(const Layer& layer, const PixelGrid& grid) {
        for (std::size_t i = 0; i < layer.rings; ++i) {
            const double area = ring_area(layer.contour(i));
            if (area <= 0)
                continue;
            ++outer;
            largest_mm2 = std::max(largest_mm2, area);
            smallest_mm2 = std::min(smallest_mm2, area);
            for (const Point2& p : layer.contour(i)) {
                const double u = grid.ux * p.x + grid.uy * p.y + grid.u0;
                const double v = grid.vx * p.x + grid.vy * p.y + grid.v0;
                min_u = std::min(min_u, u);
                max_u = std::max(max_u, u);
                min_v = std::min(min_v, v);
                max_v = std::max(max_v, v);
            }
        }
    }
};

class NanoDlpWriter final : public ResinArchive {
  public:
    NanoDlpWriter(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options)
        : ResinArchive(path, info, options,
                       {.name = "a NanoDLP file", .own_heights = false, .own_exposures = false},
                       printer_for(info, options, "nanodlp")),
          box_(info.box) {}

  private:
    std::string image_name(const ResinLayer& layer) const override {
        return fmt::format("{}.png", layer.number + 1);
    }

    std::string described(std::span<const Layer> parts) const override {
        NanoLayer all;
        for (const Layer& layer : parts)
            all.add(layer, grid());
        if (all.outer == 0)
            all = {0, 0, 0, 0, 0, 0, 0};
        const auto pixel = [](double position, std::uint32_t size) {
            return static_cast<std::uint32_t>(std::clamp(position, 0.0, static_cast<double>(size)));
        };
        return fmt::format("\"LargestArea\": {:.9g}, \"SmallestArea\": {:.9g}, \"MinX\": {}, \"MinY\": {}, "
                           "\"MaxX\": {}, \"MaxY\": {}, \"AreaCount\": {}",
                           all.largest_mm2, all.smallest_mm2, pixel(all.min_u, grid().width),
                           pixel(all.min_v, grid().height), pixel(std::ceil(all.max_u), grid().width),
                           pixel(std::ceil(all.max_v), grid().height), all.outer);
    }

    void note(const ResinLayer& layer, const std::string& text) override {
        layers_ += fmt::format("{}\n  {{\"TotalSolidArea\": {:.9g}, {}}}", layers_.empty() ? "" : ",",
                               layer.area_mm2, text);
    }

    void add_entries(const ResinTotals& totals) override {
        add_text("info.json", fmt::format("[{}\n]\n", layers_));
        add_text(
            "meta.json",
            fmt::format("{{\"FormatVersion\": \"1\", \"Distro\": \"generic\", \"Program\": \"Lamella\", "
                        "\"Version\": \"{}\", \"OS\": \"\", \"Arch\": \"\", \"Profile\": \"default\"}}\n",
                        version()));
        const std::string text = options(totals);
        add_text("slicer.json", text);
        add_text("options.json", text);
        add_text("plate.json", plate(totals));
        add_text("profile.json", profile(totals));
        add_preview(preview(), "3d.png", 400, 400);
    }

    [[nodiscard]] std::string options(const ResinTotals& totals) const {
        return fmt::format(
            "{{\"PWidth\": {}, \"PHeight\": {}, \"XPixelSize\": {:.9g}, \"YPixelSize\": {:.9g}, "
            "\"Thickness\": {:.9g}, \"SupportLayerNumber\": {}, \"ImageMirror\": {}, "
            "\"DisplayController\": 0}}\n",
            grid().width, grid().height, display().pixel_mm.x, display().pixel_mm.y, 1000 * totals.layer_mm,
            plan().bottom_layers(), (display().mirror_x ? 1 : 0) + (display().mirror_y ? 2 : 0));
    }

    /// Returns the sizes of the part; the middle of the display is at 0.
    [[nodiscard]] std::string plate(const ResinTotals& totals) const {
        const double x = 0.5 * (box_.max.x - box_.min.x);
        const double y = 0.5 * (box_.max.y - box_.min.y);
        return fmt::format("{{\"PlateID\": 1, \"ProfileID\": 1, \"Processed\": true, \"LayersCount\": {}, "
                           "\"XMin\": {:.9g}, \"XMax\": {:.9g}, \"YMin\": {:.9g}, \"YMax\": {:.9g}, "
                           "\"ZMin\": 0, \"ZMax\": {:.9g}, \"TotalSolidArea\": {:.9g}, "
                           "\"CreatedDate\": {}}}\n",
                           totals.layers, -x, x, -y, y, totals.height_mm, 1000 * totals.volume_ml,
                           plan().settings().created_s);
    }

    [[nodiscard]] std::string profile(const ResinTotals& totals) const {
        const ResinSettings& settings = plan().settings();
        return fmt::format(
            "{{\"ProfileID\": 1, \"Title\": {}, \"Depth\": {:.9g}, \"CureTime\": {:.9g}, "
            "\"SupportCureTime\": {:.9g}, \"SupportLayerNumber\": {}, "
            "\"TransitionalLayer\": {}, \"ResinPrice\": {:.9g}}}\n",
            json_quoted(printer().name.empty() ? std::string_view(machine_name()) : printer().name),
            1000 * totals.layer_mm, plan().exposure_s(), plan().bottom_exposure_s(), plan().bottom_layers(),
            plan().transition_layers(), settings.price_per_litre);
    }

    Box3 box_;
    std::string layers_; ///< of info.json
};

} // namespace

std::unique_ptr<LayerWriter> open_nanodlp(const std::string& path, const LayerFileInfo& info,
                                          const LayerWriteOptions& options) {
    return std::make_unique<NanoDlpWriter>(path, info, options);
}

} // namespace lamella
