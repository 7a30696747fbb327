#include "slices/images/image_reader.hpp"

#include "lamella/core/error.hpp"
#include "lamella/raster/image.hpp"

#include "contour/plane_sums.hpp"
#include "core/executor.hpp"
#include "core/lower_case.hpp"
#include "slices/engine/layer_assembly.hpp"
#include "slices/images/display.hpp"
#include "slices/images/resin_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lamella {

namespace {

/// Bytes of a corner while outlines are made: half a side, and the points of the layer with its copies.
constexpr std::uint64_t of_corner = 16 + 4 * sizeof(Point2);

/// An image, and the pixels that its code lacks.
struct DecodedImage {
    RunImage image;
    std::uint64_t missing = 0;
};

[[noreturn]] void refuse_layer(const std::string& name, std::size_t layer, const std::string& place,
                               const std::string& found, const std::string& expected) {
    throw Error(ErrorKind::input,
                fmt::format("{}, layer {}, {}: found {}; {}", name, layer, place, found, expected));
}

class OpenedImages {
  public:
    OpenedImages(ImageStackHead head, std::shared_ptr<const ImageStack> stack, std::string name)
        : head_(std::move(head)), stack_(std::move(stack)), name_(std::move(name)) {}

    [[nodiscard]] const ImageStackHead& head() const noexcept { return head_; }
    [[nodiscard]] const ImageStack& stack() const noexcept { return *stack_; }

    [[nodiscard]] DecodedImage decoded(std::size_t layer, ReadLimits& limits) const {
        RunBuilder image(head_.grid.width, head_.grid.height, limits);
        stack_->decode(layer, image, limits);
        const std::uint64_t missing = image.left();
        const bool may_lack = head_.may_lack_pixel && layer == 0 && missing == 1;
        if (missing > 0 && !may_lack)
            refuse_layer(name_, layer, stack_->place(layer),
                         fmt::format("an image of {} pixels", image.pixels() - missing),
                         fmt::format("the display has {} x {}, which is {}", image.width(), image.height(),
                                     image.pixels()));
        image.add(0, missing);
        return {image.take(), missing};
    }

    /// Returns the plane of a layer, as PlaneSource::make does.
    [[nodiscard]] Plane plane(std::size_t layer, const ReadLimits& limits) const {
        ReadLimits own(limits); // what it counts is freed with the plane
        const auto image = std::make_shared<const RunImage>(decoded(layer, own).image);
        Plane plane(outlines(*image, head_.grid, head_.bright_from));
        plane.image = image;
        return plane;
    }

  private:
    ImageStackHead head_;
    std::shared_ptr<const ImageStack> stack_;
    std::string name_;
};

/// Returns the box of bright pixels in layer coordinates, at a height of 0.
Box3 box_of(const BrightPixels& bright, const PixelGrid& grid) {
    Box3 box;
    if (bright.count == 0)
        return box;
    const double scale = grid.ux * grid.vy - grid.uy * grid.vx;
    for (const std::uint32_t column : {bright.left, bright.right})
        for (const std::uint32_t row : {bright.top, bright.bottom}) {
            const double u = column - grid.u0;
            const double v = row - grid.v0;
            box.add(Point3{(grid.vy * u - grid.uy * v) / scale, (grid.ux * v - grid.vx * u) / scale, 0});
        }
    return box;
}

void put_planes(LayerFile& file, const ImageStackHead& head) {
    for (const Layer& plane : head.planes) {
        const bool ascends = file.planes.empty() || plane.z > file.planes.back().z;
        const bool sound = plane.bottom <= plane.z && plane.z <= plane.top && plane.bottom < plane.top;
        if (!ascends || !sound || !(std::abs(plane.bottom) < 1e9 && plane.top < 1e9))
            throw Error(ErrorKind::input,
                        fmt::format("{}, layer {}: found a cut at {:.6g} mm from {:.6g} to {:.6g} mm; cuts "
                                    "ascend and are within their layers",
                                    file.path, plane.index, plane.z, plane.bottom, plane.top));
        file.planes.push_back(plane);
    }
    double bottom = 0;
    for (std::size_t i = 0; i < head.tops_mm.size(); ++i) {
        const double top = head.tops_mm[i];
        if (!(top > bottom) || !std::isfinite(top))
            throw Error(ErrorKind::input,
                        fmt::format("{}, layer {}: found a top at {:.6g} mm; it must be above the {:.6g} mm "
                                    "where the layer begins",
                                    file.path, i, top, bottom));
        file.planes.push_back({.index = i, .z = bottom + (top - bottom) / 2, .bottom = bottom, .top = top});
        bottom = top;
    }
}

/// The sums of the images that one thread has seen.
struct ImageSums {
    PlaneSums sums{1};
    std::uint64_t plane_bytes = 0;
};

/// Decodes all images, and adds what the file has on its planes.
void look_at_images(const OpenedImages& opened, LayerFile& file, ReadLimits& limits,
                    const Execution& execution) {
    const std::size_t layers = file.planes.size();
    file.contents.resize(layers);
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::read, layers);
    std::vector<ImageSums> workers(executor.workers());
    std::vector<std::uint64_t> missing(layers);
    executor.for_chunks(layers, 1, [&](std::uint64_t i, std::uint64_t, unsigned worker) {
        const DecodedImage decoded = opened.decoded(static_cast<std::size_t>(i), limits);
        const std::uint64_t of_runs = decoded.image.runs.size() * (sizeof(ImageRun) + of_corner);
        limits.add_bytes_at(of_runs, [&] { return fmt::format("layer {}", i); });
        const BrightPixels bright = bright_pixels(decoded.image, opened.head().bright_from);
        limits.give_back(0, of_runs);
        file.contents[i].points = bright.corners;
        missing[i] = decoded.missing;
        ImageSums& sums = workers[worker];
        sums.sums.add_contours(0, box_of(bright, opened.head().grid));
        sums.plane_bytes =
            std::max(sums.plane_bytes, 2 * decoded.image.runs.size() * sizeof(ImageRun) +
                                           bright.corners * of_corner + opened.stack().decoding_bytes());
        progress.add(1);
    });
    executor.check_cancelled();
    progress.finish();
    Findings found;
    for (std::size_t i = 0; i < layers; ++i)
        if (missing[i] > 0)
            found.note(FindingKind::missing_pixels, [&] { return fmt::format("layer {}", i); });
    append_to(found, file.warnings);
    for (ImageSums& sums : workers) {
        file.plane_bytes = std::max(file.plane_bytes, sums.plane_bytes);
        if (&sums != &workers.front())
            workers.front().sums.add(sums.sums);
    }
    workers.front().sums.put(file);
}

} // namespace

void decode_layer(DecodeRuns& decode, std::string_view code, const CodePlace& place, RunBuilder& image) {
    if (const std::optional<RunFault> fault = decode(code, image))
        refuse_layer(place.name, place.layer, fmt::format("byte {}", place.offset + fault->at), fault->found,
                     fault->expected);
}

RunImage whole_set(RunBuilder& set, const CodePlace& place) {
    if (set.left() > 0)
        refuse_layer(place.name, place.layer, fmt::format("byte {}", place.offset),
                     fmt::format("an image of {} pixels", set.pixels() - set.left()),
                     fmt::format("the display has {}", set.pixels()));
    return set.take();
}

void add_sets(std::span<const RunImage> sets, RunBuilder& image) {
    std::vector<std::size_t> at(sets.size());
    for (std::uint64_t from = 0; from < image.pixels();) {
        std::uint64_t to = image.pixels();
        std::size_t white = 0;
        for (std::size_t set = 0; set < sets.size(); ++set) {
            const ImageRun& run = sets[set].runs[at[set]];
            to = std::min(to, run.end);
            white += run.value != 0 ? 1 : 0;
        }
        image.add(grey_of_sets(white, sets.size()), to - from);
        for (std::size_t set = 0; set < sets.size(); ++set)
            at[set] += sets[set].runs[at[set]].end == to ? 1 : 0;
        from = to;
    }
}

void decode_bit_sets(std::string_view code, std::uint32_t sets, const CodePlace& place, RunBuilder& image,
                     ReadLimits& limits) {
    std::vector<RunImage> images;
    std::size_t at = 0;
    for (std::uint32_t set = 0; set < sets; ++set) {
        const std::size_t begin = at;
        for (std::uint64_t pixels = 0; at < code.size() && pixels < image.pixels(); ++at)
            pixels += static_cast<unsigned char>(code[at]) & 0x7fU;
        RunBuilder one(image.width(), image.height(), limits);
        const CodePlace of_set{place.name, place.layer, place.offset + begin};
        const std::size_t end = set + 1 == sets ? code.size() : at;
        decode_layer(decode_bit_runs, code.substr(begin, end - begin), of_set, one);
        images.push_back(whole_set(one, of_set));
    }
    add_sets(images, image);
}

const ResinPrinter* known_printer(std::string_view name) noexcept {
    const std::span<const ResinPrinter> all = resin_printers();
    const auto found = std::find_if(all.begin(), all.end(), [&](const ResinPrinter& one) {
        return lower_case(one.name) == lower_case(name);
    });
    return found == all.end() ? nullptr : &*found;
}

PixelGrid grid_of_display(const std::string& name, AlongXY<std::uint32_t> pixels, AlongXY<double> display_mm,
                          bool mirror_x, bool mirror_y) {
    for (const std::uint32_t side : {pixels.x, pixels.y})
        if (side < 1 || side > most_pixels)
            throw Error(ErrorKind::input,
                        fmt::format("{}: found images of {} x {} pixels; each side has 1 to "
                                    "{}",
                                    name, pixels.x, pixels.y, most_pixels));
    constexpr double usual_pixel_mm = 0.05;
    const auto pixel = [](double mm, std::uint32_t count) {
        const double size = mm / count;
        return size > 1e-6 && size < 1e3 ? size : usual_pixel_mm;
    };
    const Display display{.pixels = pixels,
                          .pixel_mm = {pixel(display_mm.x, pixels.x), pixel(display_mm.y, pixels.y)},
                          .portrait = false,
                          .mirror_x = mirror_x,
                          .mirror_y = mirror_y};
    Box3 middle;
    middle.add(Point3{});
    return display.grid(middle);
}

void check_layer_count(const std::string& name, std::uint64_t at, std::uint64_t layers, std::uint64_t each,
                       std::uint64_t bytes) {
    if (layers == 0)
        throw Error(ErrorKind::input,
                    fmt::format("{}, byte {}: found no layers; a file has at least one", name, at));
    if (layers > bytes / each)
        throw Error(ErrorKind::input,
                    fmt::format("{}, byte {}: found {} layers; a file of {} bytes has fewer", name, at,
                                layers, bytes));
}

LayerFile read_images(ImageStackHead head, std::shared_ptr<const ImageStack> stack, const std::string& name,
                      ReadLimits& limits, const Execution& execution) {
    limits.parse_again();
    LayerFile file = layer_file(name, head.format);
    head.job.settings = usable_settings(head.job.settings);
    limits.add_bytes(head.tops_mm.size() * (2 * sizeof(double) + sizeof(Layer) + sizeof(PlaneContent)), {});
    put_planes(file, head);
    file.grid = head.grid;
    file.resin = head.job;
    file.warnings = std::move(head.warnings);
    file.parts = {{.label = ""}};
    const auto opened = std::make_shared<const OpenedImages>(std::move(head), std::move(stack), name);
    look_at_images(*opened, file, limits, execution);
    file.bytes = limits.bytes();
    file.spare_bytes = limits.bytes_left();
    file.make = [opened, &limits](std::size_t position) {
        return opened->plane(position, limits);
    };
    return file;
}

} // namespace lamella
