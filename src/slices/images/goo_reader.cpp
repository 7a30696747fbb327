// The layers follow one another, each with the size of its image, so the index is found by going from one to
// the next.

#include "lamella/core/error.hpp"

#include "slices/engine/layer_readers.hpp"
#include "slices/images/binary_record.hpp"
#include "slices/images/goo_format.hpp"
#include "slices/images/image_reader.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

namespace {

struct GooImage {
    std::uint64_t offset;
    std::uint64_t size;
};

class GooStack final : public ImageStack {
  public:
    GooStack(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

    void add(const GooImage& image) { images_.push_back(image); }

    void decode(std::size_t layer, RunBuilder& image, ReadLimits& /*limits*/) const override {
        const auto& [offset, size] = images_[layer];
        decode_layer(decode_goo_runs,
                     bytes_.substr(static_cast<std::size_t>(offset), static_cast<std::size_t>(size)),
                     {name_, layer, offset}, image);
    }
    std::string place(std::size_t layer) const override {
        return fmt::format("byte {}", images_[layer].offset);
    }

  private:
    std::string_view bytes_;
    std::string name_;
    std::vector<GooImage> images_;
};

/// Reads the three waits of a layer, or of all layers.
void take_waits(BinaryRecord& record, PlateTravel& travel) {
    travel.wait_before_lift_s = record.f32();
    travel.wait_after_lift_s = record.f32();
    travel.wait_after_retract_s = record.f32();
}

void take_way(BinaryRecord& record, double& mm, double& mm_min) {
    mm = record.f32();
    mm_min = record.f32();
}

/// Reads the lifts and retracts of the head.
void take_travels(BinaryRecord& record, ResinSettings& settings) {
    PlateTravel& bottom = settings.bottom_travel;
    PlateTravel& normal = settings.travel;
    double first_retract_mm = 0; // follows from the others
    take_way(record, bottom.lift_mm, bottom.lift_mm_min);
    take_way(record, normal.lift_mm, normal.lift_mm_min);
    take_way(record, first_retract_mm, bottom.retract_mm_min);
    take_way(record, first_retract_mm, normal.retract_mm_min);
    take_way(record, bottom.lift2_mm, bottom.lift2_mm_min);
    take_way(record, normal.lift2_mm, normal.lift2_mm_min);
    take_way(record, bottom.retract2_mm, bottom.retract2_mm_min);
    take_way(record, normal.retract2_mm, normal.retract2_mm_min);
}

struct GooHead {
    ImageStackHead head;
    std::uint64_t layers = 0;
    bool own_settings = false;
};

void take_totals(BinaryRecord& record, GooHead& goo) {
    ResinJob& job = goo.head.job;
    job.settings.bottom_light_power = record.u16();
    job.settings.light_power = record.u16();
    goo.own_settings = record.u8() != 0;
    job.time_s = record.u32();
    job.volume_ml = record.f32() / 1000;
    job.mass_g = record.f32();
    job.price = record.f32();
    job.settings.currency = record.text(8);
    if (job.volume_ml > 0 && job.mass_g > 0)
        job.settings.density_g_ml = job.mass_g / job.volume_ml;
    if (job.volume_ml > 0 && job.price > 0)
        job.settings.price_per_litre = 1000 * job.price / job.volume_ml;
    const std::uint64_t at = record.at();
    if (const std::uint32_t first = record.u32(); first != goo_head_bytes)
        record.fail(at, fmt::format("the first layer at byte {}", first),
                    fmt::format("it begins at byte {}", goo_head_bytes));
    record.skip(1); // whether greys have 8 bits, which they have in either case
    job.settings.transition_layers = record.u16();
}

GooHead goo_head(BinaryRecord& record, const std::string& name) {
    GooHead goo;
    ResinJob& job = goo.head.job;
    goo.head.format = "goo";
    record.need(goo_head_bytes, "a header");
    job.version = record.text(4).substr(1);
    record.move_to(92);
    job.printer = record.text(32);
    record.move_to(188);
    job.antialias = record.u16();
    record.move_to(195310);
    goo.layers = record.u32();
    job.pixels.x = record.u16();
    job.pixels.y = record.u16();
    const bool mirror_x = record.u8() != 0;
    const bool mirror_y = record.u8() != 0;
    job.display_mm.x = record.f32();
    job.display_mm.y = record.f32();
    record.skip(8); // height of the machine, of a layer
    job.settings.exposure_s = record.f32();
    const bool waits = record.u8() != 0;
    const double light_off_s = record.f32();
    job.settings.light_off_s = waits ? 0 : light_off_s;
    take_waits(record, job.settings.bottom_travel);
    take_waits(record, job.settings.travel);
    job.settings.bottom_exposure_s = record.f32();
    job.settings.bottom_layers = record.u32();
    take_travels(record, job.settings);
    take_totals(record, goo);
    goo.head.grid = grid_of_display(name, job.pixels, job.display_mm, mirror_x, mirror_y);
    return goo;
}

void expect_goo_delimiter(BinaryRecord& record, std::size_t layer) {
    const std::uint64_t at = record.at();
    if (record.raw(goo_delimiter.size()) != goo_delimiter)
        record.fail(at, fmt::format("no line end in layer {}", layer), "0D 0A stands there");
}

} // namespace

bool is_goo(std::string_view bytes) {
    return bytes.size() > 12 && bytes.substr(4, goo_magic.size()) == goo_magic && bytes.front() == 'V';
}

LayerFile read_goo(std::string_view bytes, const std::string& name, ReadLimits& limits,
                   const Execution& execution) {
    BinaryRecord record(bytes, name, ByteOrder::big);
    GooHead goo = goo_head(record, name);
    check_layer_count(name, 195310, goo.layers, goo_layer_bytes, bytes.size());
    limits.add_bytes(goo.layers * (sizeof(GooImage) + 2 * sizeof(double)), "the header");
    const auto stack = std::make_shared<GooStack>(bytes, name);
    record.move_to(goo_head_bytes);
    for (std::size_t layer = 0; layer < goo.layers; ++layer) {
        record.need(goo_layer_bytes, fmt::format("the settings of layer {}", layer));
        record.skip(6); // a pause
        goo.head.tops_mm.push_back(record.f32());
        goo.head.job.exposures_s.push_back(record.f32());
        record.skip(50);
        expect_goo_delimiter(record, layer);
        const std::uint64_t size = record.u32();
        record.need(size, fmt::format("an image (layer {})", layer));
        stack->add({record.at(), size});
        record.skip(size);
        expect_goo_delimiter(record, layer);
    }
    const std::uint64_t at = record.at();
    if (record.span(at, goo_tail.size(), "the end mark") != goo_tail)
        record.fail(at, "no end mark behind the last layer", "the number of layers may be wrong");
    return read_images(std::move(goo.head), stack, name, limits, execution);
}

} // namespace lamella
