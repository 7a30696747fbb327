// The archives of `png-zip`: the list says which image belongs to which layer, and where its pixels are.

#include "lamella/core/error.hpp"

#include "container/json_text.hpp"
#include "slices/engine/layer_readers.hpp"
#include "slices/images/image_reader.hpp"
#include "slices/images/image_stack_format.hpp"
#include "slices/images/png_stack.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// Reads the list of images.
class ManifestReader {
  public:
    ManifestReader(std::string_view text, const ZipReader& archive, ReadLimits& limits)
        : json_(text, fmt::format("{}, {}", archive.name(), manifest_name)), archive_(archive),
          limits_(limits) {
        head_.format = "png-zip";
    }

    LayerFile read(const Execution& execution) {
        json_.object([this](const std::string& key) { take(key); });
        PixelGrid& grid = head_.grid;
        head_.job.pixels = {grid.width, grid.height};
        const double scale = grid.ux * grid.vy - grid.uy * grid.vx;
        const bool sound = grid.width > 0 && grid.height > 0 && std::isfinite(scale) && scale != 0 &&
                           std::isfinite(grid.u0) && std::isfinite(grid.v0);
        if (!sound || images_.empty())
            json_.fail("no map of pixels, or no images", "width, height, column, row and layers are needed");
        head_.job.display_mm = {grid.width * pixel_mm_[0], grid.height * pixel_mm_[1]};
        const auto stack = std::make_shared<PngStack>(archive_, std::move(images_));
        return read_images(std::move(head_), stack, archive_.name(), limits_, execution);
    }

  private:
    void take(const std::string& key) {
        PixelGrid& grid = head_.grid;
        if (key == "width")
            grid.width = side();
        else if (key == "height")
            grid.height = side();
        else if (key == "pixel_mm")
            take_numbers({&pixel_mm_[0], &pixel_mm_[1], nullptr});
        else if (key == "column")
            take_numbers({&grid.ux, &grid.uy, &grid.u0});
        else if (key == "row")
            take_numbers({&grid.vx, &grid.vy, &grid.v0});
        else if (key == "layers")
            json_.array([this] { take_layer(); });
        else
            json_.skip();
    }

    std::uint32_t side() {
        const double number = json_.number();
        constexpr double most = 65535;
        if (!(number >= 1 && number <= most && number == std::floor(number)))
            json_.fail(fmt::format("an image with {} pixels along a side", number),
                       "1 to 65535 are possible");
        return static_cast<std::uint32_t>(number);
    }

    void take_numbers(const std::array<double*, 3>& targets) {
        std::size_t next = 0;
        json_.array([&] {
            const double number = json_.number();
            if (next < targets.size() && targets[next] != nullptr)
                *targets[next] = number;
            ++next;
        });
    }

    void take_layer() {
        Layer plane{.index = head_.planes.size()};
        const ZipEntry* image = nullptr;
        json_.object([&](const std::string& key) {
            if (key == "file")
                image = image_of(json_.string());
            else if (key == "z")
                plane.z = json_.number();
            else if (key == "bottom")
                plane.bottom = json_.number();
            else if (key == "top")
                plane.top = json_.number();
            else
                json_.skip();
        });
        if (image == nullptr)
            json_.fail("a layer without a file", "each layer has one");
        limits_.make_room(head_.planes, 1, [] { return manifest_name; });
        head_.planes.push_back(std::move(plane));
        images_.push_back(image);
    }

    const ZipEntry* image_of(const std::string& name) {
        const ZipEntry* const entry = archive_.find(name);
        if (entry == nullptr)
            json_.fail(fmt::format("the file '{}'", printable(name, 100)), "the archive has no such file");
        return entry;
    }

    JsonText json_;
    const ZipReader& archive_;
    ReadLimits& limits_;
    ImageStackHead head_;
    std::array<double, 2> pixel_mm_{};
    std::vector<const ZipEntry*> images_;
};

} // namespace

bool is_image_archive(const ZipReader& archive) {
    const ZipEntry* const manifest = archive.find(manifest_name);
    return manifest != nullptr && archive.first_bytes(*manifest, manifest_magic.size()) == manifest_magic;
}

LayerFile read_image_archive(const ZipReader& archive, ReadLimits& limits, const Execution& execution) {
    const std::string text = text_of_entry(archive, manifest_name, limits);
    LayerFile file = ManifestReader(text, archive, limits).read(execution);
    return file;
}

} // namespace lamella
