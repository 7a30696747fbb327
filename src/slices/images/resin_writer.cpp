#include "slices/images/resin_writer.hpp"

#include "lamella/core/error.hpp"

#include "contour/same_height.hpp"
#include "slices/images/image_reader.hpp"
#include "slices/images/layer_images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace lamella {

namespace {

/// The side of the preview, from which those of all sizes are made.
constexpr std::uint32_t relief_side = 640;

ResinSettings settings_for(const ResinJobKind& kind, const LayerWriteOptions& options) {
    ResinSettings settings = options.resin;
    if (!kind.own_exposures && options.resin_of_file)
        settings.ranges.clear();
    if (!kind.own_exposures && !settings.ranges.empty())
        throw Error(
            ErrorKind::usage,
            fmt::format("{} has one exposure for all layers above the first ones; leave out the ranges "
                        "with their own exposure",
                        kind.name));
    if (!kind.stages) {
        settings.bottom_travel = in_one_stage(settings.bottom_travel);
        settings.travel = in_one_stage(settings.travel);
    }
    return settings;
}

} // namespace

ResinPrinter printer_for(const LayerFileInfo& info, const LayerWriteOptions& options,
                         std::string_view format) {
    if (options.printer != nullptr) {
        const ResinPrinter& printer = *options.printer;
        if (printer.format.empty() || printer.format == format)
            return printer;
        throw Error(ErrorKind::usage, fmt::format("the {} reads files of the format {} ({}), not {}",
                                                  printer.name, printer.format, printer.extension, format));
    }
    const ImageOptions& image = options.image;
    if (info.grid)
        return {};
    if (!image.pixels && !(image.pixel_mm && image.display_mm))
        throw Error(
            ErrorKind::usage,
            fmt::format("{} is for a printer, which has a certain display: give `printer`, or `pixels` "
                        "and `display_mm`",
                        format));
    return {.mirror_x = true};
}

std::string machine_name_of(const LayerFileInfo& info, const ResinPrinter& printer) {
    if (printer.name.empty())
        return info.printer;
    constexpr std::string_view elegoo = "Elegoo ";
    const std::string_view name = printer.name;
    return name.starts_with(elegoo) ? fmt::format("ELEGOO {}", name.substr(elegoo.size()))
                                    : std::string(name);
}

ResinWriter::ResinWriter(const LayerFileInfo& info, const LayerWriteOptions& options,
                         const ResinJobKind& kind, const ResinPrinter& printer, const DisplayGrid& display)
    : OrderedWriter(info, {.open_chains = false, .supports = true}), kind_(kind), printer_(printer),
      display_(display.display), machine_name_(machine_name_of(info, printer)),
      drawing_(display.grid, raster_for(options.image, printer), info.grid),
      plan_(settings_for(kind, options), printer), relief_(info.box, relief_side, relief_side),
      bottom_(info.bottom), part_mm_(info.box.max.z - info.bottom) {
    if (!kind.own_exposures && options.resin_of_file && !options.resin.ranges.empty())
        leave_out("exposures of single layers");
    if (options.resin_of_file)
        check_mirroring();
}

/// Counts mirroring of which readers of the file would not know.
void ResinWriter::check_mirroring() {
    const ResinPrinter* const known = known_printer(machine_name_);
    if (!kind_.mirror_x && display_.mirror_x != (known == nullptr || known->mirror_x))
        leave_out("mirroring along x");
    if (!kind_.mirror_y && display_.mirror_y != (known != nullptr && known->mirror_y))
        leave_out("mirroring along y");
}

/// Returns the pixels of an image that the file or the display changes.
Finding ResinWriter::changed_pixels(const Plane& plane) const {
    Finding found{.kind = FindingKind::changed_pixels};
    if (!plane.image)
        return found;
    std::uint64_t from = 0;
    for (const ImageRun& run : plane.image->runs) {
        const bool black_and_white = raster().antialias == 1;
        const std::uint8_t drawn = black_and_white ? (run.value >= bright_from ? 255 : 0) : run.value;
        const int change = std::abs(int{read_back(drawn)} - int{run.value});
        found.count += change > 0 ? run.end - from : 0;
        found.largest = std::max(found.largest, static_cast<double>(change));
        from = run.end;
    }
    if (found.count > 0) {
        found.layers = 1;
        found.first_z = plane.polylines.front().z;
    }
    return found;
}

void ResinWriter::leave_out(std::string setting) {
    add_loss({.kind = FindingKind::unwritten_settings, .count = 1, .place = std::move(setting)});
}

double ResinWriter::machine_mm() const noexcept {
    return printer_.height_mm > 0 ? printer_.height_mm : part_mm_;
}

OrderedWriter::Write ResinWriter::formatted(const Plane& plane) {
    return [this, changed = changed_pixels(plane), image = drawn(plane, plane.polylines.front().index),
            seen = relief_.spans(plane.polylines)](const PlanePosition& offset, Completions& after) {
        relief_.add(seen);
        check_heights(offset);
        const ResinLayer layer = counted(offset, image.areas.covered * display_.pixel_mm2());
        add_loss(unseen_material(offset.z, image.areas, display_.pixel_mm2()));
        add_loss(changed);
        image.write(layer, after);
    };
}

/// Throws unless the layer lies on the previous one and has a thickness that the format can store.
void ResinWriter::check_heights(const PlanePosition& offset) {
    const double thickness = offset.top - offset.bottom;
    if (offset.position == 0)
        totals_.first_layer_mm = thickness;
    if (offset.position <= 1)
        totals_.layer_mm = thickness;
    const double slack = totals_.layer_mm / 100 + same_height_mm; // heights of the input may be rounded
    if (!kind_.own_heights && std::abs(thickness - totals_.layer_mm) > slack)
        throw Error(
            ErrorKind::usage,
            fmt::format("{} has one layer height, but for the first layer: layer {} is {:.6g} mm thick, the "
                        "one before {:.6g} mm",
                        kind_.name, offset.index, thickness, totals_.layer_mm));
    if (offset.position > 0 && std::abs(offset.bottom - top_) > slack)
        throw Error(ErrorKind::usage,
                    fmt::format("layers of {} lie on one another: layer {} begins at {:.6g} mm, the one "
                                "before ends at {:.6g} mm",
                                kind_.name, offset.index, offset.bottom, top_));
    top_ = offset.top;
}

ResinLayer ResinWriter::counted(const PlanePosition& offset, double area_mm2) {
    ResinLayer layer{.number = offset.position,
                     .top_mm = offset.top - bottom_,
                     .thickness_mm = offset.top - offset.bottom,
                     .area_mm2 = area_mm2};
    layer.exposure_s = plan_.exposure_s(layer.number, layer.top_mm - 0.5 * layer.thickness_mm);
    const bool large = area_mm2 > printer_.large_area * display_.width_mm() * display_.height_mm();
    ++(large ? totals_.large_layers : totals_.small_layers);
    ++totals_.layers;
    totals_.height_mm = layer.top_mm;
    totals_.print_time_s += plan_.layer_time_s(layer.number, layer.exposure_s, large);
    volume_mm3_ += area_mm2 * layer.thickness_mm;
    return layer;
}

void ResinWriter::end_file() {
    totals_.volume_ml = volume_mm3_ / 1000;
    totals_.mass_g = plan_.mass_g(totals_.volume_ml);
    totals_.price = plan_.price(totals_.volume_ml);
    job_ = {.printer = machine_name_,
            .pixels = {grid().width, grid().height},
            .settings = plan_.settings(),
            .volume_ml = totals_.volume_ml,
            .mass_g = totals_.mass_g,
            .price = totals_.price,
            .time_s = totals_.print_time_s};
    end_job(totals_);
}

} // namespace lamella
