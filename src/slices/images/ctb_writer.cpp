// Chitubox's files: .ctb, versions 3 and 4, and the older .cbddlp and .photon, version 2. Places of all
// sections are in the head, so the previews, whose size is known only when the part is complete, stand at the
// end.

#include "lamella/core/version.hpp"

#include "slices/engine/layer_writers.hpp"
#include "slices/images/binary_fields.hpp"
#include "slices/images/ctb_format.hpp"
#include "slices/images/preview.hpp"
#include "slices/images/resin_file.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

namespace {

/// Any key but 0 will do, with which some printers refuse files. It is constant so that equal layers give
/// equal bytes.
constexpr std::uint32_t cipher_key = 0x4C616D65;

constexpr std::uint64_t header_bytes = 112;
constexpr std::uint64_t print_bytes = 60;
constexpr std::uint64_t slicer_bytes = 76;
constexpr std::uint64_t block4_bytes = 464;
constexpr std::uint64_t record_bytes = 84;

struct ChituboxKind {
    std::uint32_t magic;
    std::uint32_t version;
    std::uint32_t sets = 1; ///< of images in black and white, which add up to grey
    [[nodiscard]] bool ctb() const noexcept { return version > 2; }
};

ChituboxKind ctb_kind(const ResinPrinter& printer) {
    const bool fourth = printer.version == 4;
    return {fourth ? ctb4_magic : ctb_magic, fourth ? 4U : 3U};
}

/// Returns the kind with as many sets as levels of anti-aliasing, but a power of two, into which the values
/// of grey are divided, and at most 4: an empty image takes as much as its pixels, divided by 125.
ChituboxKind cbddlp_kind(const RasterOptions& raster) {
    constexpr std::uint32_t most_sets = 4;
    ChituboxKind kind{cbddlp_magic, 2};
    while (kind.sets < most_sets && 2 * kind.sets <= raster.antialias)
        kind.sets *= 2;
    return kind;
}

std::vector<RunCode> codes_of(const ChituboxKind& kind) {
    if (kind.ctb())
        return {ctb_runs()};
    if (kind.sets == 1)
        return {bit_runs(128)};
    std::vector<RunCode> codes;
    for (std::uint32_t set = kind.sets; set > 0; --set)
        codes.push_back(bit_runs(static_cast<std::uint8_t>(256 * set / kind.sets - 1)));
    return codes;
}

/// Places of the sections that precede the images.
struct ChituboxPlaces {
    std::uint64_t print = header_bytes;
    std::uint64_t slicer = 0; ///< 0 if there is none
    std::uint64_t name = 0;
    std::uint64_t block4 = 0;
    std::uint64_t table = 0;
    std::uint64_t end = 0;

    ChituboxPlaces(const ChituboxKind& kind, std::size_t name_size, std::uint64_t layers) {
        table = print + print_bytes;
        if (kind.ctb()) {
            slicer = table;
            name = slicer + slicer_bytes;
            table = name + name_size;
        }
        if (kind.version >= 4) {
            block4 = table;
            table = block4 + block4_bytes;
        }
        end = table + ctb_entry_bytes * layers * kind.sets;
    }
};

class ChituboxWriter final : public ResinFile {
  public:
    ChituboxWriter(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options,
                   const ChituboxKind& kind, const ResinPrinter& printer)
        : ResinFile(path, info, options,
                    {.name = kind.ctb() ? "a ctb file" : "a cbddlp file",
                     .own_exposures = true,
                     .stages = kind.version >= 4,
                     .mirror_y = false},
                    printer, codes_of(kind),
                    ChituboxPlaces(kind, machine_name_of(info, printer).size(), info.layers).end),
          kind_(kind), places_(kind, machine_name().size(), info.layers), tables_(kind.sets) {}

  private:
    /// Encrypts for the number that the layer will have if no index is left out.
    void finish_images(Images& images) const override {
        if (kind_.ctb())
            encrypt(*images.files.front(), images.index);
    }

    void encrypt(ByteBuffer& image, std::uint64_t number) const {
        apply_ctb_cipher(cipher_key, number, image.data(), image.view().size());
    }

    void put_layer(const ResinLayer& layer, const Images& images, Completions& after) override {
        if (kind_.ctb() && images.index != layer.number) {
            encrypt(*images.files.front(), images.index); // which decrypts it
            encrypt(*images.files.front(), layer.number);
        }
        std::string_view known;
        std::uint64_t place = 0;
        for (std::size_t set = 0; set < images.files.size(); ++set) {
            const std::string_view image = images.files[set]->view();
            const bool same = set > 0 && image == known;
            if (!same)
                place = bytes() + (kind_.ctb() ? record_bytes : 0);
            const std::string entry = entry_of(layer, place, image.size());
            tables_[set] += entry;
            if (same)
                continue;
            if (kind_.ctb())
                put(record_of(layer, entry, image.size()));
            put(images.files[set], after);
            known = image;
        }
    }

    [[nodiscard]] std::string entry_of(const ResinLayer& layer, std::uint64_t place,
                                       std::uint64_t size) const {
        const PlateTravel& travel = plan().travel(layer.number);
        BinaryFields entry(ByteOrder::little);
        entry.f32(layer.top_mm).f32(layer.exposure_s).f32(light_off_s(travel));
        entry.u32(place).u32(size).u32(place >> 32U);
        entry.u32(kind_.ctb() ? record_bytes : 0).zeros(8);
        return std::string(entry.view());
    }

    /// Returns the time without light in files of this version. The older format knows no waits.
    [[nodiscard]] double light_off_s(const PlateTravel& travel) const {
        return kind_.ctb() ? plan().settings().light_off_s : plan().rest_s(travel);
    }

    /// Returns a wait, which is 0 if the printer uses the time without light.
    [[nodiscard]] double wait(double seconds) const {
        return plan().settings().light_off_s > 0 ? 0 : seconds;
    }

    /// Returns the record before the image of a layer.
    [[nodiscard]] std::string record_of(const ResinLayer& layer, std::string_view entry,
                                        std::uint64_t size) const {
        const PlateTravel& travel = plan().travel(layer.number);
        BinaryFields record(ByteOrder::little);
        record.raw(entry).u32(record_bytes + size);
        record.f32(lift_mm_of(travel)).f32(travel.lift_mm_min);
        record.f32(travel.lift2_mm).f32(second_speed(travel.lift2_mm, travel.lift2_mm_min));
        record.f32(travel.retract_mm_min);
        record.f32(travel.retract2_mm).f32(second_speed(travel.retract2_mm, travel.retract2_mm_min));
        record.f32(wait(travel.wait_before_lift_s)).f32(wait(travel.wait_after_lift_s));
        // Version 3 has a number of unknown meaning instead of this wait.
        if (kind_.version >= 4)
            record.f32(wait(travel.wait_after_retract_s));
        else
            record.u32(28672);
        record.f32(plan().light_power(layer.number));
        return std::string(record.view());
    }

    static double second_speed(double mm, double mm_min) { return mm > 0 ? mm_min : 0; }

    std::string end_and_head(const ResinTotals& totals) override {
        const ColourImage whole = preview();
        const std::uint64_t large = put_preview(whole, 400, 300);
        const std::uint64_t small = put_preview(whole, 200, 125);
        BinaryFields head(ByteOrder::little);
        add_header(totals, large, small, head);
        add_print_parameters(totals, head);
        if (kind_.ctb())
            add_slicer(head);
        if (kind_.version >= 4)
            add_block4(totals, head);
        for (const std::string& table : tables_)
            head.raw(table);
        return std::string(head.view());
    }

    /// Returns the place of its header.
    std::uint64_t put_preview(const ColourImage& whole, std::uint32_t width, std::uint32_t height) {
        const std::string runs = preview_runs(whole, width, height);
        const std::uint64_t place = bytes();
        check_32_bits(place + 32);
        BinaryFields header(ByteOrder::little);
        header.u32(width).u32(height).u32(place + 32).u32(runs.size()).zeros(16);
        put(header.view());
        put(runs);
        return place;
    }

    void add_header(const ResinTotals& totals, std::uint64_t large, std::uint64_t small,
                    BinaryFields& head) const {
        const ResinSettings& settings = plan().settings();
        head.u32(kind_.magic).u32(kind_.version);
        head.f32(display().image_mm().x).f32(display().image_mm().y).f32(machine_mm()).zeros(8);
        head.f32(totals.height_mm).f32(totals.layer_mm);
        head.f32(plan().exposure_s()).f32(plan().bottom_exposure_s()).f32(light_off_s(settings.travel));
        head.u32(plan().bottom_layers()).u32(grid().width).u32(grid().height);
        head.u32(large).u32(places_.table).u32(totals.layers).u32(small);
        head.u32(static_cast<std::uint64_t>(std::llround(totals.print_time_s)));
        head.u32(display().mirror_x ? 1 : 0);
        head.u32(places_.print).u32(print_bytes).u32(kind_.sets);
        head.u16(settings.light_power).u16(settings.bottom_light_power);
        head.u32(kind_.ctb() ? cipher_key : 0);
        head.u32(places_.slicer).u32(kind_.ctb() ? slicer_bytes : 0);
    }

    void add_print_parameters(const ResinTotals& totals, BinaryFields& head) const {
        const PlateTravel& bottom = plan().settings().bottom_travel;
        const PlateTravel& normal = plan().settings().travel;
        head.f32(lift_mm_of(bottom)).f32(bottom.lift_mm_min);
        head.f32(lift_mm_of(normal)).f32(normal.lift_mm_min).f32(normal.retract_mm_min);
        head.f32(totals.volume_ml).f32(totals.mass_g).f32(totals.price);
        head.f32(light_off_s(bottom)).f32(light_off_s(normal)).u32(plan().bottom_layers()).zeros(16);
    }

    void add_slicer(BinaryFields& head) const {
        const PlateTravel& bottom = plan().settings().bottom_travel;
        const PlateTravel& normal = plan().settings().travel;
        head.f32(bottom.lift2_mm).f32(second_speed(bottom.lift2_mm, bottom.lift2_mm_min));
        head.f32(normal.lift2_mm).f32(second_speed(normal.lift2_mm, normal.lift2_mm_min));
        head.f32(normal.retract2_mm).f32(second_speed(normal.retract2_mm, normal.retract2_mm_min));
        head.f32(kind_.version >= 4 ? wait(normal.wait_after_lift_s) : 0);
        head.u32(places_.name).u32(machine_name().size());
        head.u8(raster().antialias > 1 ? 0x0F : 0x07).u16(0);
        head.u8(std::uint64_t{kind_.version} << 4U); // each layer has its own settings
        head.u32(static_cast<std::uint64_t>(std::max<std::int64_t>(plan().settings().created_s, 0) / 60));
        head.u32(raster().antialias);
        head.u32(LAMELLA_VERSION_MAJOR << 24U | LAMELLA_VERSION_MINOR << 16U | LAMELLA_VERSION_PATCH << 8U);
        head.f32(wait(normal.wait_after_retract_s)).f32(wait(normal.wait_after_lift_s));
        head.u32(0).u32(places_.block4).zeros(8); // no transition by the printer
        head.raw(machine_name());
    }

    /// Appends the block of version 4. Numbers of unknown meaning are those of files that CHITUBOX writes.
    void add_block4(const ResinTotals& totals, BinaryFields& head) const {
        const PlateTravel& bottom = plan().settings().bottom_travel;
        const PlateTravel& normal = plan().settings().travel;
        head.f32(bottom.retract_mm_min).f32(second_speed(bottom.retract2_mm, bottom.retract2_mm_min));
        head.u32(0).f32(4).u32(0).f32(4);
        head.f32(wait(normal.wait_after_retract_s)).f32(wait(normal.wait_after_lift_s));
        head.f32(wait(normal.wait_before_lift_s)).f32(bottom.retract2_mm);
        head.f32(1553).u32(5126).u32(4).u32(std::max<std::uint64_t>(totals.layers, 1) - 1);
        head.zeros(16).zeros(12).zeros(380);
    }

    ChituboxKind kind_;
    ChituboxPlaces places_;
    std::vector<std::string> tables_; ///< one for each set of images
};

} // namespace

std::unique_ptr<LayerWriter> open_ctb(const std::string& path, const LayerFileInfo& info,
                                      const LayerWriteOptions& options) {
    const ResinPrinter printer = printer_for(info, options, "ctb");
    return std::make_unique<ChituboxWriter>(path, info, options, ctb_kind(printer), printer);
}

std::unique_ptr<LayerWriter> open_cbddlp(const std::string& path, const LayerFileInfo& info,
                                         const LayerWriteOptions& options) {
    const ResinPrinter printer = printer_for(info, options, "cbddlp");
    return std::make_unique<ChituboxWriter>(path, info, options,
                                            cbddlp_kind(raster_for(options.image, printer)), printer);
}

} // namespace lamella
