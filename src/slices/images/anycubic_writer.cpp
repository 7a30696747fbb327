// Anycubic's container. Its tables have fixed sizes, and all of them precede the images. Speeds are in mm/s.
//
// The two stages are bands of height: the printer moves through each of them upwards and downwards. So the
// second stage of the way back, which is the slow one, belongs to the first band.

#include "lamella/core/error.hpp"

#include "slices/engine/layer_writers.hpp"
#include "slices/images/binary_fields.hpp"
#include "slices/images/preview.hpp"
#include "slices/images/resin_file.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>

namespace lamella {

namespace {

constexpr unsigned most_shades = 16;
constexpr std::uint32_t preview_width = 224;
constexpr std::uint32_t preview_height = 168;
constexpr std::uint64_t table_head_bytes = 16; ///< name and length
constexpr std::uint64_t anycubic_entry_bytes = 32;
constexpr std::uint64_t preview_bytes = 12 + std::uint64_t{2} * preview_width * preview_height;
constexpr std::uint64_t grey_bytes = 28;
constexpr std::uint64_t extra_bytes = 56;
constexpr std::uint64_t machine_bytes = 156; ///< with name and length

/// Places of the tables.
struct AnycubicPlaces {
    std::uint64_t header;
    std::uint64_t preview;
    std::uint64_t grey;
    std::uint64_t layers;
    std::uint64_t extra;
    std::uint64_t machine;
    std::uint64_t images;

    AnycubicPlaces(bool older, std::uint64_t count)
        : header(older ? 48 : 52), preview(header + table_head_bytes + (older ? 80 : 84)),
          grey(preview + table_head_bytes + preview_bytes), layers(grey + grey_bytes),
          extra(layers + table_head_bytes + 4 + anycubic_entry_bytes * count),
          machine(extra + (older ? 0 : table_head_bytes + extra_bytes)),
          images(machine + (older ? 0 : machine_bytes)) {}
};

/// Version 515 has neither stages nor a table of the machine.
bool is_older(const ResinPrinter& printer) {
    return printer.version == 515;
}

class AnycubicWriter final : public ResinFile {
  public:
    AnycubicWriter(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options,
                   const ResinPrinter& printer)
        : ResinFile(path, info, options,
                    {.name = "an Anycubic file",
                     .stages = !is_older(printer),
                     .mirror_x = false,
                     .mirror_y = false},
                    printer, {pw0_runs()}, AnycubicPlaces(is_older(printer), info.layers).images),
          older_(is_older(printer)), places_(older_, info.layers), table_(ByteOrder::little) {}

  private:
    void put_layer(const ResinLayer& layer, const Images& images, Completions& after) override {
        const PlateTravel& travel = plan().travel(layer.number);
        check_32_bits(bytes());
        table_.u32(bytes()).u32(images.files.front()->view().size());
        table_.f32(lift_mm_of(travel)).f32(travel.lift_mm_min / 60);
        table_.f32(layer.exposure_s).f32(layer.thickness_mm).u32(images.lit).u32(0);
        put(images.files.front(), after);
    }

    std::string end_and_head(const ResinTotals& totals) override {
        BinaryFields head(ByteOrder::little);
        head.text("ANYCUBIC", 12).u32(older_ ? 515 : 516).u32(older_ ? 5 : 8);
        head.u32(places_.header).u32(0).u32(places_.preview).u32(places_.grey).u32(places_.layers);
        head.u32(older_ ? 0 : places_.extra);
        if (!older_)
            head.u32(places_.machine);
        head.u32(places_.images);
        add_header(totals, head);
        head.text("PREVIEW", 12).u32(table_head_bytes + preview_bytes);
        head.u32(preview_width).raw({"x\0\0\0", 4}).u32(preview_height);
        head.raw(preview_565(preview(), preview_width, preview_height, ByteOrder::little));
        head.u32(0).u32(16).raw(std::string(16, '\xff')).u32(0); // greys of a display without corrections
        head.text("LAYERDEF", 12).u32(4 + table_.view().size()).u32(totals.layers).raw(table_.view());
        if (!older_) {
            add_extra(head);
            add_machine(head);
        }
        return std::string(head.view());
    }

    void add_header(const ResinTotals& totals, BinaryFields& head) const {
        const ResinSettings& settings = plan().settings();
        const PlateTravel& travel = settings.travel;
        const bool own_settings = !settings.ranges.empty();
        head.text("HEADER", 12).u32(older_ ? 80 : 84);
        head.f32(1000 * display().pixel_mm.x).f32(totals.layer_mm);
        head.f32(plan().exposure_s()).f32(plan().rest_s(travel));
        head.f32(plan().bottom_exposure_s()).f32(plan().bottom_layers());
        head.f32(lift_mm_of(travel)).f32(travel.lift_mm_min / 60).f32(lower_retract_mm_s(travel));
        head.f32(totals.volume_ml)
            .u32(std::min(raster().antialias, most_shades))
            .u32(grid().width)
            .u32(grid().height);
        head.f32(totals.mass_g).f32(totals.price).text(settings.currency, 4);
        head.u32(own_settings ? 1 : 0);
        head.u32(static_cast<std::uint64_t>(std::llround(totals.print_time_s)));
        head.u32(own_settings ? 0 : plan().transition_layers()).u32(0);
        if (!older_)
            head.u32(settings.travel.lift2_mm > 0 || settings.bottom_travel.lift2_mm > 0 ? 1 : 0);
    }

    /// Returns the speed downwards in the lower band.
    static double lower_retract_mm_s(const PlateTravel& travel) {
        return (travel.retract2_mm > 0 ? travel.retract2_mm_min : travel.retract_mm_min) / 60;
    }

    void add_extra(BinaryFields& head) const {
        head.text("EXTRA", 12).u32(24);
        for (const PlateTravel* travel : {&plan().settings().bottom_travel, &plan().settings().travel}) {
            const bool two = travel->lift2_mm > 0;
            head.u32(2).f32(travel->lift_mm).f32(travel->lift_mm_min / 60);
            head.f32(two ? travel->retract_mm_min / 60 : 0);
            head.f32(travel->lift2_mm).f32(two ? travel->lift2_mm_min / 60 : 0);
            head.f32(lower_retract_mm_s(*travel));
        }
    }

    void add_machine(BinaryFields& head) const {
        head.text("MACHINE", 12).u32(machine_bytes).text(machine_name(), 96).text("pw0Img", 16);
        head.u32(most_shades).u32(7); // the second are the properties that files of Photon Workshop have
        head.f32(display().image_mm().x).f32(display().image_mm().y).f32(machine_mm());
        head.u32(516).u32(0x00634701);
    }

    bool older_;
    AnycubicPlaces places_;
    BinaryFields table_; ///< of the layers
};

} // namespace

std::unique_ptr<LayerWriter> open_anycubic(const std::string& path, const LayerFileInfo& info,
                                           const LayerWriteOptions& options) {
    return std::make_unique<AnycubicWriter>(path, info, options, printer_for(info, options, "anycubic"));
}

} // namespace lamella
