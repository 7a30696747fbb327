#include "container/zip_writer.hpp"
#include "core/atomic_directory.hpp"
#include "core/atomic_file.hpp"
#include "write/display.hpp"
#include "write/layer_pictures.hpp"
#include "write/layer_writers.hpp"
#include "write/ordered_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

namespace lamella {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view manifest_name = "manifest.json";
/// How the list begins; a folder of pictures that may be replaced is known by it.
constexpr std::string_view manifest_mark = "{\n  \"content\": \"layers as pictures, by Lamella\",\n";

std::string picture_name(std::uint64_t index) {
    return fmt::format("{:05}.png", index);
}

/// The list of the pictures, and what their pixels mean.
class Manifest {
  public:
    Manifest(const Display& display, const LayerPictures& pictures) : pixel_mm2_(display.pixel_mm2()) {
        const PixelGrid& grid = pictures.grid();
        text_ = fmt::format("{}  \"width\": {},\n  \"height\": {},\n  \"pixel_mm\": [{}, {}],\n"
                            "  \"column\": [{}, {}, {}],\n  \"row\": [{}, {}, {}],\n"
                            "  \"antialias\": {},\n  \"gamma\": {},\n  \"layers\": [",
                            manifest_mark, grid.width, grid.height, display.pixel_mm.x, display.pixel_mm.y,
                            grid.ux, grid.uy, grid.u0, grid.vx, grid.vy, grid.v0,
                            pictures.options().antialias, pictures.options().gamma);
    }

    void add(const PlanePlace& place, double covered) {
        text_ += fmt::format("{}\n    {{\"file\": \"{}\", \"z\": {}, \"bottom\": {}, \"top\": {}, "
                             "\"area_mm2\": {}}}",
                             text_.ends_with('[') ? "" : ",", picture_name(place.index), place.z,
                             place.bottom, place.top, covered * pixel_mm2_);
    }

    [[nodiscard]] std::string text() const { return text_ + "\n  ]\n}\n"; }

  private:
    double pixel_mm2_;
    std::string text_;
};

bool begins_with_mark(const fs::path& path) {
    std::string begin(manifest_mark.size(), '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    return file && begin == manifest_mark;
}

/// Of an entry of a folder that is there already.
bool is_ours(const fs::path& path) {
    if (!fs::is_regular_file(fs::symlink_status(path)) ||
        !begins_with_mark(path.parent_path() / manifest_name))
        return false;
    const std::string name = path.filename().string();
    const std::string number = path.stem().string();
    return name == manifest_name ||
           (name.ends_with(".png") && number.size() >= 5 &&
            std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; }));
}

class PictureStackWriter : public OrderedWriter {
  protected:
    PictureStackWriter(const LayerFileInfo& info, const LayerWriteOptions& options)
        : OrderedWriter(info, {.open_chains = false, .hatches = false}, Ascending::z_and_index),
          display_(display_for(info.box, options.picture, {})),
          pictures_(display_.grid(info.box), options.picture.raster), manifest_(display_, pictures_) {}

    /// Called as soon as there is a picture, from any threads.
    virtual void made(std::uint64_t index, const LayerPicture& picture) = 0;
    /// Called in order.
    virtual void add(std::uint64_t index, const LayerPicture& picture) = 0;
    virtual void end(const std::string& manifest) = 0;

  private:
    Write formatted(std::span<const Layer> parts) final {
        LayerPicture picture = pictures_.picture(parts);
        made(parts.front().index, picture);
        return [this, picture = std::move(picture)](const PlanePlace& place) {
            add(place.index, picture);
            manifest_.add(place, picture.covered);
        };
    }

    void end_file() final { end(manifest_.text()); }

    Display display_;
    LayerPictures pictures_;
    Manifest manifest_;
};

class PictureFolderWriter final : public PictureStackWriter {
  public:
    PictureFolderWriter(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options)
        : PictureStackWriter(info, options), directory_(path, is_ours) {}

    std::uint64_t bytes() const noexcept override { return bytes_.load(std::memory_order_relaxed); }

  private:
    // Each layer has a file of its own, so it is written here and not in order.
    void made(std::uint64_t index, const LayerPicture& picture) override {
        write(directory_.working_path() / picture_name(index), picture.file->view());
    }
    void add(std::uint64_t, const LayerPicture&) override {}
    void end(const std::string& manifest) override {
        write(directory_.working_path() / manifest_name, manifest);
        directory_.commit();
    }

    void write(const fs::path& path, std::string_view bytes) {
        AtomicFile file(path.string());
        file.append(bytes);
        file.commit();
        bytes_.fetch_add(bytes.size(), std::memory_order_relaxed);
    }

    AtomicDirectory directory_;
    std::atomic<std::uint64_t> bytes_{0};
};

class PictureArchiveWriter final : public PictureStackWriter {
  public:
    PictureArchiveWriter(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options)
        : PictureStackWriter(info, options), archive_(path) {}

    std::uint64_t bytes() const noexcept override { return archive_.bytes(); }

  private:
    void made(std::uint64_t, const LayerPicture&) override {}
    void add(std::uint64_t index, const LayerPicture& picture) override {
        archive_.add_ready(picture_name(index), ZipMethod::stored, picture.in_zip());
    }
    void end(const std::string& manifest) override {
        archive_.add(manifest_name, manifest, ZipMethod::deflated);
        archive_.finish();
    }

    ZipWriter archive_;
};

} // namespace

std::unique_ptr<LayerWriter> open_picture_folder(const std::string& path, const LayerFileInfo& info,
                                                 const LayerWriteOptions& options) {
    return std::make_unique<PictureFolderWriter>(path, info, options);
}

std::unique_ptr<LayerWriter> open_picture_archive(const std::string& path, const LayerFileInfo& info,
                                                  const LayerWriteOptions& options) {
    return std::make_unique<PictureArchiveWriter>(path, info, options);
}

} // namespace lamella
