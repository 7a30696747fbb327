#pragma once

// Small jobs for resin printers, in memory.

#include "lamella/slices/layer_writer.hpp"

#include "container/zip_reader.hpp"
#include "fixtures/any_printer.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/sample_layers.hpp"
#include "temporary_folder.hpp"

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// A printer of 8 x 4 pixels of 1 mm.
inline constexpr ResinPrinter tiny_printer{.name = "Elegoo Tiny",
                                           .pixels = {8, 4},
                                           .display_mm = {8, 4},
                                           .mirror_x = true,
                                           .height_mm = 10,
                                           .exposure_s = 2,
                                           .bottom_exposure_s = 20,
                                           .bottom_layers = 2,
                                           .transition_layers = 1};

/// A stack of squares of 2 mm, in layers of 0.5 mm from z = 1 upwards.
inline LayerStack squares(std::size_t count) {
    LayerStack layers;
    for (std::size_t i = 0; i < count; ++i) {
        LayerBuilder builder;
        add_contour(builder, {{0, 0}, {2, 0}, {2, 2}, {0, 2}});
        const double bottom = 1 + 0.5 * static_cast<double>(i);
        layers.push_back(builder.finish(i, bottom + 0.25, bottom, bottom + 0.5));
    }
    return layers;
}

/// Two stages with numbers that all differ.
inline PlateTravel staged_travel(double first) {
    return {.lift_mm = first,
            .lift_mm_min = 60,
            .lift2_mm = 4,
            .lift2_mm_min = 240,
            .retract_mm_min = 180,
            .retract2_mm = 1,
            .retract2_mm_min = 30,
            .wait_before_lift_s = 0.25,
            .wait_after_lift_s = 0.5,
            .wait_after_retract_s = 1};
}

inline std::string job_of(std::string_view format, const LayerStack& layers, LayerWriteOptions options = {}) {
    if (options.printer == nullptr)
        options.printer = &tiny_printer;
    std::string bytes;
    LayerFileInfo info = info_of(layers);
    info.memory = &bytes;
    write_layers("job", layer_format(format, ""), test::planes_of(layers), info, options);
    return bytes;
}

/// The bytes of an entry of an archive; "" if there is none.
inline std::string entry_of(const std::string& archive, const std::string& name) {
    const TemporaryFolder folder;
    write_file(folder.file("job.zip"), archive);
    const ZipReader zip(open_bytes(folder.file("job.zip")), 0);
    const ZipEntry* const entry = zip.find(name);
    return entry == nullptr ? std::string() : std::string(zip.read(*entry).text());
}

/// Numbers of a file, at offsets.
class FieldsOfFile {
  public:
    FieldsOfFile(std::string_view bytes, bool big) : bytes_(bytes), big_(big) {}

    [[nodiscard]] std::uint32_t number(std::size_t at, std::size_t size = 4) const {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < size; ++i)
            value |= std::uint32_t{static_cast<unsigned char>(bytes_.at(at + i))}
                     << (8 * (big_ ? size - 1 - i : i));
        return value;
    }
    [[nodiscard]] float real(std::size_t at) const {
        const std::uint32_t bits = number(at);
        float value = 0;
        std::memcpy(&value, &bits, sizeof value);
        return value;
    }
    [[nodiscard]] std::vector<float> reals(std::size_t at, std::size_t count) const {
        std::vector<float> values;
        for (std::size_t i = 0; i < count; ++i)
            values.push_back(real(at + 4 * i));
        return values;
    }

  private:
    std::string_view bytes_;
    bool big_;
};

} // namespace lamella
