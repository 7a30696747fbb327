// Anycubic's container: the places of the tables follow the number of the version, which decides what they
// are.

#include "lamella/core/error.hpp"

#include "slices/engine/layer_readers.hpp"
#include "slices/images/binary_record.hpp"
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

constexpr std::string_view anycubic_magic("ANYCUBIC\0\0\0\0", 12);
constexpr std::uint64_t anycubic_table_head = 16; ///< name and length of a table
constexpr std::uint64_t anycubic_layer_bytes = 32;
constexpr std::uint32_t most_images = 16; ///< of a layer

struct AnycubicImage {
    std::uint64_t offset;
    std::uint64_t size;
};

class AnycubicStack final : public ImageStack {
  public:
    /// `sets`: number of images in black and white for each layer; 0 if there is one with 4 bits of grey.
    AnycubicStack(std::string_view bytes, std::string name, std::uint32_t sets)
        : bytes_(bytes), name_(std::move(name)), sets_(sets) {}

    void add(const AnycubicImage& image) {
        images_.push_back(image);
        largest_ = std::max(largest_, image.size);
    }

    void decode(std::size_t layer, RunBuilder& image, ReadLimits& limits) const override {
        const auto& [offset, size] = images_[layer];
        const std::string_view code =
            bytes_.substr(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
        const CodePlace place{name_, layer, offset};
        if (sets_ == 0)
            decode_layer(decode_pw0_runs, code, place, image);
        else if (sets_ == 1)
            decode_layer(decode_bit_runs, code, place, image);
        else
            decode_bit_sets(code, sets_, place, image, limits);
    }
    std::string place(std::size_t layer) const override {
        return fmt::format("byte {}", images_[layer].offset);
    }
    std::uint64_t decoding_bytes() const override { return sets_ < 2 ? 0 : largest_ * sizeof(ImageRun); }

  private:
    std::string_view bytes_;
    std::string name_;
    std::uint32_t sets_;
    std::vector<AnycubicImage> images_;
    std::uint64_t largest_ = 0;
};

double per_minute(double mm_s) {
    return std::round(mm_s * 60 * 1e6) / 1e6;
}

class AnycubicFile {
  public:
    AnycubicFile(std::string_view bytes, const std::string& name)
        : bytes_(bytes), record_(bytes, name, ByteOrder::little) {}

    LayerFile read(ReadLimits& limits, const Execution& execution) {
        take_places();
        take_header();
        if (machine_ != 0)
            take_machine();
        if (version_ >= 516 && two_stages_ && extra_ != 0)
            take_stages();
        const ResinJob& job = head_.job;
        const ResinPrinter* const printer =
            known_printer(job.printer); // the file does not say how it mirrors
        head_.grid =
            grid_of_display(record_.name(), job.pixels, job.display_mm,
                            printer == nullptr || printer->mirror_x, printer != nullptr && printer->mirror_y);
        move_to_table(layers_, "LAYERDEF");
        const std::uint64_t at = record_.at();
        const std::uint64_t layers = record_.u32();
        check_layer_count(record_.name(), at, layers, anycubic_layer_bytes, bytes_.size());
        limits.add_bytes(layers * (sizeof(AnycubicImage) + 2 * sizeof(double)), "the table of layers");
        if (bits_ && (job.antialias < 1 || job.antialias > most_images))
            record_.fail(header_, fmt::format("{} images for each layer", job.antialias),
                         fmt::format("1 to {} are possible", most_images));
        if (bits_ && job.antialias > 1)
            head_.bright_from = bright_from_of_sets;
        const auto stack = std::make_shared<AnycubicStack>(bytes_, record_.name(), bits_ ? job.antialias : 0);
        take_layers(layers, *stack);
        return read_images(std::move(head_), stack, record_.name(), limits, execution);
    }

  private:
    void take_places() {
        record_.need(48, "a header");
        record_.skip(anycubic_magic.size());
        version_ = record_.u32();
        if (version_ != 1 && (version_ < 515 || version_ > 518))
            record_.fail(12, fmt::format("version {}", version_), "versions 1 and 515 to 518 are read");
        head_.format = "anycubic";
        head_.job.version = std::to_string(version_);
        record_.skip(4);
        header_ = record_.u32();
        record_.skip(12); // software, preview, greys
        layers_ = record_.u32();
        extra_ = record_.u32();
        machine_ = version_ >= 516 ? record_.u32() : 0;
        bits_ = record_.name().ends_with(".pws");
    }

    void move_to_table(std::uint64_t place, std::string_view name) {
        record_.move_to(place);
        record_.need(anycubic_table_head + 4, fmt::format("the table {}", name));
        if (const std::string found = record_.text(12); found != name)
            record_.fail(place, fmt::format("no table {}", name), "the file names this place for it");
        record_.skip(4);
    }

    void take_header() {
        ResinJob& job = head_.job;
        ResinSettings& settings = job.settings;
        move_to_table(header_, "HEADER");
        record_.need(80, "the table HEADER");
        const double pixel_mm = record_.f32() / 1000;
        record_.skip(4); // height of a layer
        settings.exposure_s = record_.f32();
        settings.travel.wait_after_retract_s = record_.f32();
        settings.bottom_exposure_s = record_.f32();
        settings.bottom_layers =
            static_cast<std::uint32_t>(std::llround(std::clamp(record_.f32(), 0.0, 1e6)));
        settings.travel.lift_mm = record_.f32();
        settings.travel.lift_mm_min = per_minute(record_.f32());
        settings.travel.retract_mm_min = per_minute(record_.f32());
        settings.bottom_travel = settings.travel;
        job.volume_ml = record_.f32();
        job.antialias = record_.u32();
        job.pixels.x = record_.u32();
        job.pixels.y = record_.u32();
        job.mass_g = record_.f32();
        job.price = record_.f32();
        settings.currency = record_.text(4);
        record_.skip(4); // own settings for each layer, which are used in either case
        job.time_s = record_.u32();
        settings.transition_layers = record_.u32();
        record_.skip(4);
        two_stages_ = version_ >= 516 && record_.u32() != 0;
        job.display_mm = {pixel_mm * job.pixels.x, pixel_mm * job.pixels.y};
        if (job.volume_ml > 0 && job.mass_g > 0)
            settings.density_g_ml = job.mass_g / job.volume_ml;
        if (job.volume_ml > 0 && job.price > 0)
            settings.price_per_litre = 1000 * job.price / job.volume_ml;
    }

    void take_machine() {
        move_to_table(machine_, "MACHINE");
        record_.need(140, "the table MACHINE");
        head_.job.printer = record_.text(96);
        const std::string image = record_.text(16);
        if (image != "pw0Img" && image != "pwsImg")
            record_.fail(record_.at() - 16, fmt::format("images of the kind '{}'", printable(image, 16)),
                         "pw0Img and pwsImg are read");
        bits_ = image == "pwsImg";
        record_.skip(8);
        const double x = record_.f32();
        const double y = record_.f32();
        if (x > 0 && y > 0)
            head_.job.display_mm = {x, y};
    }

    /// Takes the movements in two stages, which are bands of height: see the writer.
    void take_stages() {
        move_to_table(extra_, "EXTRA");
        record_.need(56, "the table EXTRA");
        for (PlateTravel* travel : {&head_.job.settings.bottom_travel, &head_.job.settings.travel}) {
            record_.skip(4);
            travel->lift_mm = record_.f32();
            travel->lift_mm_min = per_minute(record_.f32());
            const double upper_retract = per_minute(record_.f32());
            travel->lift2_mm = record_.f32();
            travel->lift2_mm_min = per_minute(record_.f32());
            const double lower_retract = per_minute(record_.f32());
            const bool two = travel->lift2_mm > 0;
            travel->retract_mm_min = two ? upper_retract : lower_retract;
            travel->retract2_mm = two ? travel->lift_mm : 0;
            travel->retract2_mm_min = lower_retract;
        }
    }

    void take_layers(std::uint64_t layers, AnycubicStack& stack) {
        record_.need(layers * anycubic_layer_bytes, "the table of layers");
        double top = 0;
        for (std::uint64_t layer = 0; layer < layers; ++layer) {
            const std::uint64_t offset = record_.u32();
            const std::uint64_t size = record_.u32();
            static_cast<void>(record_.span(offset, size, fmt::format("an image (layer {})", layer)));
            stack.add({offset, size});
            record_.skip(8); // lift, and its speed
            head_.job.exposures_s.push_back(record_.f32());
            top += record_.f32();
            head_.tops_mm.push_back(std::round(top * 1e6) / 1e6);
            record_.skip(8); // pixels that are not black
        }
    }

    std::string_view bytes_;
    BinaryRecord record_;
    ImageStackHead head_;
    std::uint32_t version_ = 0;
    std::uint64_t header_ = 0;
    std::uint64_t layers_ = 0;
    std::uint64_t extra_ = 0;
    std::uint64_t machine_ = 0;
    bool two_stages_ = false;
    bool bits_ = false; ///< images in black and white
};

} // namespace

bool is_anycubic(std::string_view bytes) {
    return bytes.starts_with(anycubic_magic);
}

LayerFile read_anycubic(std::string_view bytes, const std::string& name, ReadLimits& limits,
                        const Execution& execution) {
    return AnycubicFile(bytes, name).read(limits, execution);
}

} // namespace lamella
