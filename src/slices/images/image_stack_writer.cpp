#include "lamella/core/error.hpp"

#include "container/quoted.hpp"
#include "container/zip_writer.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/engine/ordered_writer.hpp"
#include "slices/images/display.hpp"
#include "slices/images/image_stack_format.hpp"
#include "slices/images/layer_images.hpp"
#include "system/atomic_directory.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

namespace {

namespace fs = std::filesystem;

std::string image_name(std::uint64_t index) {
    return fmt::format("{:05}.png", index);
}

/// Returns the hue with this angle in degrees as a colour.
PartColour colour_of_hue(double hue) {
    constexpr double light = 230;
    constexpr double dark = 50;
    const auto part = [hue](double shift) {
        // Full for a third of the circle, none for another, and linear between.
        const double k = std::fmod(hue / 60 + shift, 6);
        const double share = std::clamp(std::min(k, 4 - k), 0.0, 1.0);
        return static_cast<std::uint8_t>(std::lround(light - (light - dark) * share));
    };
    return {part(5), part(3), part(1)};
}

/// Returns the palette for the parts, which begins with the background. Throws Error{usage} if there are too
/// many parts or other colours than parts.
std::vector<PartColour> palette_for(std::span<const PartInfo> parts, std::vector<PartColour> colours) {
    constexpr std::size_t most = 255;
    if (parts.size() > most)
        throw Error(ErrorKind::usage,
                    fmt::format("{} parts have no colours of their own in an image, which has "
                                "at most {}; write them in several runs",
                                parts.size(), most));
    constexpr double golden_angle = 137.508; // hues stay apart for any number of parts
    for (std::size_t i = 0; colours.size() < parts.size() && (colours.empty() || i > 0); ++i)
        colours.push_back(colour_of_hue(std::fmod(golden_angle * static_cast<double>(i), 360)));
    if (colours.size() != parts.size())
        throw Error(
            ErrorKind::usage,
            fmt::format("{} colours for {} parts: give one for each part, in their order, or leave the "
                        "choice to Lamella",
                        colours.size(), parts.size()));
    if (std::find(colours.begin(), colours.end(), PartColour{}) != colours.end())
        throw Error(ErrorKind::usage,
                    "black (#000000) is the colour of pixels without material; give the part another one");
    colours.insert(colours.begin(), PartColour{});
    return colours;
}

/// Returns the pixels of the images: numbers of a palette, black and white, or grey.
PngPixels pixels_for(const LayerFileInfo& info, const LayerWriteOptions& options,
                     const RasterOptions& raster) {
    if (!options.image.colour_parts)
        return {.bits = raster.antialias == 1 ? 1U : 8U};
    if (info.grid)
        throw Error(ErrorKind::usage,
                    "images do not tell which part a pixel belongs to, so parts cannot have "
                    "colours; slice the mesh");
    PngPixels pixels{.bits = 1, .palette = palette_for(info.parts, options.image.part_colours)};
    while (pixels.palette.size() > std::size_t{1} << pixels.bits)
        pixels.bits *= 2;
    return pixels;
}

/// List of the images, with the meaning of their pixels.
class Manifest {
  public:
    Manifest(const Display& display, const LayerImages& images, std::span<const PartInfo> parts)
        : pixel_mm2_(display.pixel_mm2()) {
        const PixelGrid& grid = images.grid();
        text_ = fmt::format("{}  \"width\": {},\n  \"height\": {},\n  \"pixel_mm\": [{}, {}],\n"
                            "  \"column\": [{}, {}, {}],\n  \"row\": [{}, {}, {}],\n  \"bits\": {},\n{}",
                            manifest_magic, grid.width, grid.height, display.pixel_mm.x, display.pixel_mm.y,
                            grid.ux, grid.uy, grid.u0, grid.vx, grid.vy, grid.v0, images.pixels().bits,
                            images.pixels().palette.empty() ? values_text(images.options())
                                                            : parts_text(images.pixels().palette, parts));
        text_ += "  \"layers\": [";
    }

    void add(const PlanePosition& offset, double covered) {
        text_ += fmt::format("{}\n    {{\"file\": \"{}\", \"z\": {}, \"bottom\": {}, \"top\": {}, "
                             "\"area_mm2\": {}}}",
                             text_.ends_with('[') ? "" : ",", image_name(offset.index), offset.z,
                             offset.bottom, offset.top, covered * pixel_mm2_);
    }

    [[nodiscard]] std::string text() const { return text_ + "\n  ]\n}\n"; }

  private:
    static std::string values_text(const RasterOptions& options) {
        std::string text =
            fmt::format("  \"antialias\": {},\n  \"gamma\": {},\n", options.antialias, options.gamma);
        if (options.grey_values)
            text += fmt::format("  \"grey_values\": [{}],\n", fmt::join(*options.grey_values, ", "));
        return text;
    }

    static std::string parts_text(std::span<const PartColour> palette, std::span<const PartInfo> parts) {
        std::string text = "  \"parts\": [";
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const PartColour& colour = palette[i + 1];
            text += fmt::format("{}\n    {{\"label\": {}, \"colour\": \"#{:02x}{:02x}{:02x}\"}}",
                                i == 0 ? "" : ",", json_quoted(quotable(parts[i].label)), colour.red,
                                colour.green, colour.blue);
        }
        return text + "\n  ],\n";
    }

    double pixel_mm2_;
    std::string text_;
};

/// Returns whether an existing entry of a folder was written by this program.
bool is_ours(const fs::path& path) {
    std::error_code ignored;
    const fs::path folder = path.parent_path();
    if (!fs::is_regular_file(fs::symlink_status(path, ignored)) ||
        !(is_unfinished_name(folder) || begins_with_magic(folder / manifest_name, manifest_magic)))
        return false; // the manifest is written at the end
    const std::string name = path.filename().string();
    const std::string number = path.stem().string();
    return name == manifest_name ||
           (name.ends_with(".png") && number.size() >= 5 &&
            std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; }));
}

RasterOptions raster_of(const LayerWriteOptions& options) {
    return options.printer == nullptr ? options.image.raster : raster_for(options.image, *options.printer);
}

DisplayGrid display_of_options(const LayerFileInfo& info, const LayerWriteOptions& options) {
    return display_grid(info, options.image, options.printer == nullptr ? ResinPrinter{} : *options.printer);
}

/// The list has labels only with the colours of parts.
Holds holds(const LayerWriteOptions& options) {
    return {.open_chains = false,
            .written_label = options.image.colour_parts ? quotable : nullptr,
            .supports = true};
}

class ImageStackWriter final : public OrderedWriter {
  public:
    ImageStackWriter(const std::string& path, bool in_folder, const LayerFileInfo& info,
                     const LayerWriteOptions& options, const DisplayGrid& display)
        : OrderedWriter(info, holds(options), Ascending::z_and_index), display_(display.display),
          images_(PlaneDrawing(display.grid, raster_of(options), info.grid),
                  pixels_for(info, options, raster_of(options))),
          manifest_(display_, images_, info.parts) {
        if (in_folder)
            folder_.emplace(path, is_ours);
        else
            archive_.emplace(path, Overwriting::no, info.memory);
    }

    std::uint64_t bytes() const noexcept override { return folder_ ? folder_->bytes() : archive_->bytes(); }

  private:
    Write formatted(const Plane& plane) override {
        LayerImage image = images_.image(plane);
        // In a folder each layer has a file of its own, which can be written in any order.
        if (folder_)
            folder_->write(image_name(plane.polylines.front().index), image.file->view());
        return [this, image = std::move(image)](const PlanePosition& offset, Completions& after) {
            if (archive_)
                archive_->add_ready(image_name(offset.index), ZipMethod::stored, image.in_zip(), image.file,
                                    after);
            manifest_.add(offset, image.areas.covered);
            add_loss(unseen_material(offset.z, image.areas, display_.pixel_mm2()));
        };
    }

    void end_file() override {
        if (folder_) {
            folder_->write(std::string(manifest_name), manifest_.text());
            folder_->commit();
        } else {
            archive_->add(manifest_name, manifest_.text(), ZipMethod::deflated);
            archive_->finish();
        }
    }

    Display display_;
    LayerImages images_;
    Manifest manifest_;
    std::optional<AtomicDirectory> folder_; ///< or archive_
    std::optional<ZipWriter> archive_;
};

} // namespace

std::unique_ptr<LayerWriter> open_image_folder(const std::string& path, const LayerFileInfo& info,
                                               const LayerWriteOptions& options) {
    return std::make_unique<ImageStackWriter>(path, true, info, options, display_of_options(info, options));
}

std::unique_ptr<LayerWriter> open_image_archive(const std::string& path, const LayerFileInfo& info,
                                                const LayerWriteOptions& options) {
    return std::make_unique<ImageStackWriter>(path, false, info, options, display_of_options(info, options));
}

} // namespace lamella
