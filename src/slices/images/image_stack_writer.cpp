#include "container/zip_writer.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/engine/ordered_writer.hpp"
#include "slices/images/display.hpp"
#include "slices/images/image_stack_format.hpp"
#include "slices/images/layer_images.hpp"
#include "system/atomic_directory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
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

/// List of the images, with the meaning of their pixels.
class Manifest {
  public:
    Manifest(const Display& display, const LayerImages& images) : pixel_mm2_(display.pixel_mm2()) {
        const PixelGrid& grid = images.grid();
        text_ = fmt::format("{}  \"width\": {},\n  \"height\": {},\n  \"pixel_mm\": [{}, {}],\n"
                            "  \"column\": [{}, {}, {}],\n  \"row\": [{}, {}, {}],\n"
                            "  \"antialias\": {},\n  \"gamma\": {},\n  \"layers\": [",
                            manifest_magic, grid.width, grid.height, display.pixel_mm.x, display.pixel_mm.y,
                            grid.ux, grid.uy, grid.u0, grid.vx, grid.vy, grid.v0, images.options().antialias,
                            images.options().gamma);
    }

    void add(const PlanePosition& offset, double covered) {
        text_ += fmt::format("{}\n    {{\"file\": \"{}\", \"z\": {}, \"bottom\": {}, \"top\": {}, "
                             "\"area_mm2\": {}}}",
                             text_.ends_with('[') ? "" : ",", image_name(offset.index), offset.z,
                             offset.bottom, offset.top, covered * pixel_mm2_);
    }

    [[nodiscard]] std::string text() const { return text_ + "\n  ]\n}\n"; }

  private:
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

class ImageStackWriter final : public OrderedWriter {
  public:
    ImageStackWriter(const std::string& path, bool in_folder, const LayerFileInfo& info,
                     const LayerWriteOptions& options, const DisplayGrid& display)
        : OrderedWriter(info, {.open_chains = false, .supports = true}, Ascending::z_and_index),
          display_(display.display), images_(PlaneDrawing(display.grid, raster_of(options), info.grid)),
          manifest_(display_, images_) {
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
