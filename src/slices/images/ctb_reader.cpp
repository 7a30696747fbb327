// Files of Chitubox: places of all sections are in the head. The table of layers is there once for each set
// of images in black and white, which add up to grey.

#include "lamella/core/error.hpp"

#include "slices/engine/layer_readers.hpp"
#include "slices/images/binary_record.hpp"
#include "slices/images/ctb_format.hpp"
#include "slices/images/image_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

namespace {

constexpr std::uint32_t uniformation_magic = 0xFF220810;
constexpr std::uint32_t encrypted_magic = 0x12FD0107;
constexpr std::uint64_t oldest_header_bytes = 108; // version 1 has no slicer section
constexpr std::uint32_t most_sets = 16;

std::uint32_t magic_of(std::string_view bytes) {
    return bytes.size() < oldest_header_bytes ? 0 : BinaryRecord(bytes, "", ByteOrder::little).u32();
}

struct ChituboxImage {
    std::uint64_t offset;
    std::uint64_t size;
};

class ChituboxStack final : public ImageStack {
  public:
    ChituboxStack(std::string_view bytes, std::string name, bool grey, std::uint32_t key, std::uint32_t sets)
        : bytes_(bytes), name_(std::move(name)), grey_(grey), key_(key), sets_(sets) {}

    /// Adds the image of the next layer; with several sets, those of all layers of a set follow one another.
    void add(const ChituboxImage& image) {
        images_.push_back(image);
        largest_ = std::max(largest_, image.size);
    }

    void decode(std::size_t layer, RunBuilder& image, ReadLimits& limits) const override {
        if (grey_)
            decode_grey(layer, image, limits);
        else if (sets_ == 1)
            decode_set(layer, layer, image);
        else
            decode_sets(layer, image, limits);
    }
    std::string place(std::size_t layer) const override {
        return fmt::format("byte {}", images_[layer].offset);
    }
    std::uint64_t decoding_bytes() const override {
        return largest_ * (grey_ ? 1 : sets_ * sizeof(ImageRun));
    }

  private:
    void decode_grey(std::size_t layer, RunBuilder& image, ReadLimits& limits) const {
        const auto& [offset, size] = images_[layer];
        limits.add_bytes(size, "the image of a layer");
        std::string code(bytes_.substr(static_cast<std::size_t>(offset), static_cast<std::size_t>(size)));
        apply_ctb_cipher(key_, layer, code.data(), code.size());
        decode_layer(decode_ctb_runs, code, {name_, layer, offset}, image);
        limits.give_back(0, size);
    }

    void decode_set(std::size_t entry, std::size_t layer, RunBuilder& image) const {
        const auto& [offset, size] = images_[entry];
        decode_layer(decode_bit_runs,
                     bytes_.substr(static_cast<std::size_t>(offset), static_cast<std::size_t>(size)),
                     {name_, layer, offset}, image);
    }

    void decode_sets(std::size_t layer, RunBuilder& image, ReadLimits& limits) const {
        std::vector<RunImage> sets;
        const std::size_t layers = images_.size() / sets_;
        for (std::uint32_t set = 0; set < sets_; ++set) {
            const std::size_t entry = set * layers + layer;
            RunBuilder one(image.width(), image.height(), limits);
            decode_set(entry, layer, one);
            sets.push_back(whole_set(one, {name_, layer, images_[entry].offset}));
        }
        add_sets(sets, image);
    }

    std::string_view bytes_;
    std::string name_;
    bool grey_;
    std::uint32_t key_;
    std::uint32_t sets_;
    std::vector<ChituboxImage> images_;
    std::uint64_t largest_ = 0;
};

class ChituboxFile {
  public:
    ChituboxFile(std::string_view bytes, const std::string& name)
        : bytes_(bytes), record_(bytes, name, ByteOrder::little) {}

    LayerFile read(ReadLimits& limits, const Execution& execution) {
        take_header();
        if (version_ >= 2)
            take_print_parameters();
        if (slicer_ != 0)
            take_slicer();
        const ResinPrinter* const printer = known_printer(head_.job.printer);
        head_.grid = grid_of_display(record_.name(), head_.job.pixels, head_.job.display_mm, mirrored_,
                                     printer != nullptr && printer->mirror_y);
        check_layer_count(record_.name(), 0x44, layers_, ctb_entry_bytes * sets_, bytes_.size());
        limits.add_bytes(layers_ * (std::uint64_t{sets_} * sizeof(ChituboxImage) + 2 * sizeof(double)),
                         "the header");
        const auto stack = std::make_shared<ChituboxStack>(bytes_, record_.name(), grey_, cipher_key_, sets_);
        take_table(*stack);
        return read_images(std::move(head_), stack, record_.name(), limits, execution);
    }

  private:
    void take_header() {
        ResinJob& job = head_.job;
        record_.need(oldest_header_bytes, "a header");
        const std::uint32_t magic = record_.u32();
        grey_ = magic != cbddlp_magic;
        head_.format = grey_ ? "ctb" : "cbddlp";
        version_ = record_.u32();
        if (version_ < 1 || version_ > 5 || (!grey_ && version_ > 2))
            record_.fail(4, fmt::format("version {}", version_),
                         grey_ ? "versions up to 5 are read" : "versions 1 and 2 are read");
        job.version = std::to_string(version_);
        job.display_mm.x = record_.f32();
        job.display_mm.y = record_.f32();
        record_.move_to(0x20);
        layer_mm_ = record_.f32();
        job.settings.exposure_s = record_.f32();
        job.settings.bottom_exposure_s = record_.f32();
        job.settings.light_off_s = record_.f32();
        job.settings.bottom_layers = record_.u32();
        job.settings.transition_layers = 0;
        job.pixels.x = record_.u32();
        job.pixels.y = record_.u32();
        record_.skip(4); // the large preview
        table_ = record_.u32();
        layers_ = record_.u32();
        record_.skip(4); // the small preview
        job.time_s = record_.u32();
        const bool mirrored = record_.u32() != 0;
        print_ = record_.u32();
        record_.skip(4);
        const std::uint32_t sets = record_.u32();
        if (version_ >= 2) {
            job.settings.light_power = record_.u16();
            job.settings.bottom_light_power = record_.u16();
            cipher_key_ = record_.u32();
            slicer_ = record_.u32();
        }
        sets_ = !grey_ && version_ >= 2 ? std::max<std::uint32_t>(sets, 1) : 1;
        if (sets_ > most_sets)
            record_.fail(0x5C, fmt::format("{} images for each layer", sets_),
                         fmt::format("{} are the most", most_sets));
        job.antialias = sets_;
        if (sets_ > 1)
            head_.bright_from = bright_from_of_sets;
        head_.may_lack_pixel = !grey_ && sets_ == 1;
        mirrored_ = mirrored;
    }

    void take_print_parameters() {
        if (print_ == 0)
            return;
        ResinJob& job = head_.job;
        ResinSettings& settings = job.settings;
        record_.move_to(print_);
        record_.need(44, "the print parameters");
        settings.bottom_travel.lift_mm = record_.f32();
        settings.bottom_travel.lift_mm_min = record_.f32();
        settings.travel.lift_mm = record_.f32();
        settings.travel.lift_mm_min = record_.f32();
        settings.bottom_travel.retract_mm_min = settings.travel.retract_mm_min = record_.f32();
        settings.bottom_travel.wait_after_retract_s = settings.travel.wait_after_retract_s = 0;
        job.volume_ml = record_.f32();
        job.mass_g = record_.f32();
        job.price = record_.f32();
        settings.currency.clear(); // the file does not say it
        if (job.volume_ml > 0 && job.mass_g > 0)
            settings.density_g_ml = job.mass_g / job.volume_ml;
        if (job.volume_ml > 0 && job.price > 0)
            settings.price_per_litre = 1000 * job.price / job.volume_ml;
    }

    void take_slicer() {
        ResinJob& job = head_.job;
        PlateTravel& bottom = job.settings.bottom_travel;
        PlateTravel& normal = job.settings.travel;
        record_.move_to(slicer_);
        record_.need(76, "the section of the slicer");
        bottom.lift2_mm = record_.f32();
        bottom.lift2_mm_min = record_.f32();
        normal.lift2_mm = record_.f32();
        normal.lift2_mm_min = record_.f32();
        normal.retract2_mm = record_.f32();
        normal.retract2_mm_min = record_.f32();
        bottom.lift_mm = std::max(bottom.lift_mm - bottom.lift2_mm, 0.0); // the file has their sum
        normal.lift_mm = std::max(normal.lift_mm - normal.lift2_mm, 0.0);
        record_.skip(4);
        const std::uint64_t name = record_.u32();
        const std::uint64_t name_bytes = record_.u32();
        record_.move_to(slicer_ + 0x2C);
        job.antialias = record_.u32();
        record_.skip(4);
        normal.wait_after_retract_s = bottom.wait_after_retract_s = record_.f32();
        normal.wait_after_lift_s = bottom.wait_after_lift_s = record_.f32();
        job.settings.transition_layers = record_.u32();
        const std::uint64_t block4 = record_.u32();
        record_.move_to(name);
        if (constexpr std::uint64_t longest = 1024; name_bytes <= longest)
            job.printer = record_.text(name_bytes);
        if (version_ >= 4 && block4 != 0)
            take_block4(block4);
    }

    void take_block4(std::uint64_t place) {
        PlateTravel& bottom = head_.job.settings.bottom_travel;
        PlateTravel& normal = head_.job.settings.travel;
        record_.move_to(place);
        record_.need(40, "the section of version 4");
        bottom.retract_mm_min = record_.f32();
        bottom.retract2_mm_min = record_.f32();
        record_.skip(16);
        normal.wait_after_retract_s = bottom.wait_after_retract_s = record_.f32();
        normal.wait_after_lift_s = bottom.wait_after_lift_s = record_.f32();
        normal.wait_before_lift_s = bottom.wait_before_lift_s = record_.f32();
        bottom.retract2_mm = record_.f32();
    }

    void take_table(ChituboxStack& stack) {
        record_.move_to(table_);
        record_.need(layers_ * sets_ * ctb_entry_bytes, "the table of layers");
        for (std::uint64_t entry = 0; entry < layers_ * sets_; ++entry) {
            const double z = record_.f32();
            const double exposure = record_.f32();
            if (entry < layers_) {
                head_.tops_mm.push_back(z);
                head_.job.exposures_s.push_back(exposure);
            }
            record_.skip(4);
            const std::uint64_t low = record_.u32();
            const std::uint64_t size = record_.u32();
            const std::uint64_t offset = low + (std::uint64_t{record_.u32()} << 32U);
            static_cast<void>(
                record_.span(offset, size, fmt::format("an image (layer {})", entry % layers_)));
            stack.add({offset, size});
            record_.skip(12);
        }
        // The first programs wrote the bottoms of layers.
        if (!grey_ && head_.tops_mm.front() < layer_mm_ / 2)
            for (double& top : head_.tops_mm)
                top = std::round((top + layer_mm_) * 1e6) / 1e6;
    }

    std::string_view bytes_;
    BinaryRecord record_;
    ImageStackHead head_;
    std::uint32_t version_ = 0;
    bool grey_ = false;
    bool mirrored_ = false;
    double layer_mm_ = 0;
    std::uint64_t layers_ = 0;
    std::uint32_t sets_ = 1;
    std::uint64_t table_ = 0;
    std::uint64_t print_ = 0;
    std::uint64_t slicer_ = 0;
    std::uint32_t cipher_key_ = 0;
};

} // namespace

bool is_ctb(std::string_view bytes) {
    const std::uint32_t magic = magic_of(bytes);
    return magic == ctb_magic || magic == ctb4_magic || magic == uniformation_magic ||
           magic == encrypted_magic;
}

bool is_cbddlp(std::string_view bytes) {
    return magic_of(bytes) == cbddlp_magic;
}

LayerFile read_ctb(std::string_view bytes, const std::string& name, ReadLimits& limits,
                   const Execution& execution) {
    if (magic_of(bytes) == encrypted_magic)
        throw Error(ErrorKind::input,
                    fmt::format("{}: found an encrypted .ctb file, which is not read here; export it without "
                                "encryption, or in another format",
                                name));
    return ChituboxFile(bytes, name).read(limits, execution);
}

LayerFile read_cbddlp(std::string_view bytes, const std::string& name, ReadLimits& limits,
                      const Execution& execution) {
    return ChituboxFile(bytes, name).read(limits, execution);
}

} // namespace lamella
