// Layers follow one another, each with its own settings. The head says that these apply ("advance mode"), and
// leaves nothing to the printer, since whether it would compute the transition in the same way is not known.

#include "lamella/core/version.hpp"

#include "slices/engine/layer_writers.hpp"
#include "slices/images/binary_fields.hpp"
#include "slices/images/goo_format.hpp"
#include "slices/images/preview.hpp"
#include "slices/images/resin_file.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <string_view>

namespace lamella {

namespace {

constexpr std::uint32_t small_side = 116;
constexpr std::uint32_t big_side = 290;

class GooWriter final : public ResinFile {
  public:
    GooWriter(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options)
        : ResinFile(path, info, options, {.name = "a goo file"}, printer_for(info, options, "goo"),
                    {goo_runs()}, goo_head_bytes) {}

  private:
    /// Appends the waits, which are 0 if the printer uses the time without light.
    void add_waits(const PlateTravel& travel, BinaryFields& fields) const {
        const double used = plan().settings().light_off_s > 0 ? 0 : 1;
        fields.f32(used * travel.wait_before_lift_s)
            .f32(used * travel.wait_after_lift_s)
            .f32(used * travel.wait_after_retract_s);
    }

    void put_layer(const ResinLayer& layer, const Images& images, Completions& after) override {
        const PlateTravel& travel = plan().travel(layer.number);
        BinaryFields record(ByteOrder::big);
        record.u16(0).f32(layer.top_mm).f32(layer.top_mm).f32(layer.exposure_s);
        record.f32(plan().settings().light_off_s);
        add_waits(travel, record);
        record.f32(travel.lift_mm).f32(travel.lift_mm_min);
        record.f32(travel.lift2_mm).f32(travel.lift2_mm_min);
        record.f32(retract_mm_of(travel)).f32(travel.retract_mm_min);
        record.f32(travel.retract2_mm).f32(travel.retract2_mm_min);
        record.u16(plan().light_power(layer.number)).raw(goo_delimiter);
        record.u32(images.files.front()->view().size());
        put(record.view());
        put(images.files.front(), after);
        put(goo_delimiter);
    }

    std::string end_and_head(const ResinTotals& totals) override {
        put(goo_tail);
        BinaryFields head(ByteOrder::big);
        head.raw("V3.0").raw(goo_magic);
        head.text("Lamella", 32).text(version(), 24);
        head.text(utc_text(plan().settings().created_s, " "), 24);
        head.text(machine_name(), 32).text(machine_name(), 32).text("", 32);
        head.u16(raster().antialias).u16(0).u16(0);
        const ColourImage whole = preview();
        head.raw(preview_565(whole, small_side, small_side, ByteOrder::big)).raw(goo_delimiter);
        head.raw(preview_565(whole, big_side, big_side, ByteOrder::big)).raw(goo_delimiter);
        add_display(totals, head);
        add_times(head);
        add_travels(head);
        head.u16(plan().settings().bottom_light_power).u16(plan().settings().light_power);
        head.u8(1); // each layer has its own settings
        head.u32(static_cast<std::uint64_t>(std::llround(totals.print_time_s)));
        head.f32(totals.volume_ml * 1000).f32(totals.mass_g).f32(totals.price);
        head.text(plan().settings().currency, 8);
        head.u32(goo_head_bytes).u8(1).u16(0); // 8 bits of grey, no transition by the printer
        return std::string(head.view());
    }

    void add_display(const ResinTotals& totals, BinaryFields& head) const {
        head.u32(totals.layers).u16(grid().width).u16(grid().height);
        head.u8(display().mirror_x ? 1 : 0).u8(display().mirror_y ? 1 : 0);
        head.f32(display().image_mm().x).f32(display().image_mm().y).f32(machine_mm());
        head.f32(totals.layer_mm).f32(plan().exposure_s());
    }

    void add_times(BinaryFields& head) const {
        const ResinSettings& settings = plan().settings();
        head.u8(settings.light_off_s > 0 ? 0 : 1).f32(settings.light_off_s);
        add_waits(settings.bottom_travel, head);
        add_waits(settings.travel, head);
        head.f32(plan().bottom_exposure_s()).u32(plan().bottom_layers());
    }

    void add_travels(BinaryFields& head) const {
        const PlateTravel& bottom = plan().settings().bottom_travel;
        const PlateTravel& normal = plan().settings().travel;
        head.f32(bottom.lift_mm).f32(bottom.lift_mm_min).f32(normal.lift_mm).f32(normal.lift_mm_min);
        head.f32(retract_mm_of(bottom)).f32(bottom.retract_mm_min);
        head.f32(retract_mm_of(normal)).f32(normal.retract_mm_min);
        head.f32(bottom.lift2_mm).f32(bottom.lift2_mm_min).f32(normal.lift2_mm).f32(normal.lift2_mm_min);
        head.f32(bottom.retract2_mm).f32(bottom.retract2_mm_min);
        head.f32(normal.retract2_mm).f32(normal.retract2_mm_min);
    }
};

} // namespace

std::unique_ptr<LayerWriter> open_goo(const std::string& path, const LayerFileInfo& info,
                                      const LayerWriteOptions& options) {
    return std::make_unique<GooWriter>(path, info, options);
}

} // namespace lamella
