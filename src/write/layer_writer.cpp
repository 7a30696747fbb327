#include "lamella/write/layer_writer.hpp"

#include "lamella/core/error.hpp"
#include "lamella/write/layer_page.hpp"

#include "core/executor.hpp"
#include "core/lower_case.hpp"
#include "write/common_layer.hpp"
#include "write/dxf.hpp"
#include "write/geojson.hpp"
#include "write/layered_svg.hpp"
#include "write/layers_json.hpp"
#include "write/limited_writer.hpp"
#include "write/npz.hpp"
#include "write/picture_stack.hpp"
#include "write/sl1.hpp"
#include "write/slc.hpp"
#include "write/slices_3mf.hpp"
#include "write/wkt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <utility>

namespace lamella {

namespace {

constexpr std::array formats{
    LayerFormat{"cli", ".cli",
                "Common Layer Interface, binary; single precision, or 16 bits in the short form", false,
                true},
    LayerFormat{"cli-ascii", "", "Common Layer Interface, ASCII; coordinates in whole units of 0.001 mm",
                false, true},
    LayerFormat{"svg", ".svg", "all layers in one SVG file as Slic3r writes it; coordinates to 0.001 mm",
                false, true},
    LayerFormat{"slc", ".slc", "SLC of 3D Systems, binary; single precision; closed contours only"},
    LayerFormat{"3mf", ".3mf", "3MF with slice stacks; coordinates to 0.001 mm; closed contours only"},
    LayerFormat{"dxf", ".dxf", "DXF of AutoCAD Release 12, polylines; coordinates to 0.001 mm", false, true},
    LayerFormat{"geojson", ".geojson", "GeoJSON, one feature per layer; coordinates to 0.001 mm", false,
                true},
    LayerFormat{"wkt", ".csv", "CSV with the layers as well-known text; coordinates to 0.001 mm", false,
                true},
    LayerFormat{"json", ".json", "all that layers have as JSON; exact", false, true},
    LayerFormat{"npz", ".npz", "NumPy arrays; exact"},
    LayerFormat{"html", ".html", "a page to look at the layers with any browser; see docs/viewer.md"},
    LayerFormat{"svg-layers", "", "a folder with one SVG picture per layer; coordinates to 0.001 mm", true},
    LayerFormat{"png", "", "a folder with one PNG picture per layer; as fine as its pixels", true},
    LayerFormat{"png-zip", ".zip", "the same pictures in a zip archive"},
    LayerFormat{"sl1", ".sl1", "a job for the resin printer Original Prusa SL1; as fine as its pixels"},
    LayerFormat{"sl1s", ".sl1s", "the same for the SL1S"},
};

std::string names() {
    std::string text;
    for (const LayerFormat& format : formats) {
        text += text.empty() ? "" : ", ";
        text += format.name;
        if (!format.extension.empty())
            text += fmt::format(" ({})", format.extension);
    }
    return text;
}

void check_info(const LayerFileInfo& info) {
    const Box3& box = info.box;
    const std::array values{box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z, info.bottom};
    if (info.parts.empty())
        throw Error(ErrorKind::usage, "a slice file needs a part");
    const bool finite = std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    if (box.empty() || !finite)
        throw Error(ErrorKind::usage,
                    "a slice file needs the box of its part, and that is empty or not finite");
}

std::unique_ptr<LayerWriter> open_unlimited(const std::string& path, const LayerFormat& format,
                                            const LayerFileInfo& info, const LayerWriteOptions& options) {
    if (format.name == "cli")
        return open_common_layer_binary(path, info, options);
    if (format.name == "cli-ascii")
        return open_common_layer_ascii(path, info, options);
    if (format.name == "svg")
        return open_layered_svg(path, info, options);
    if (format.name == "slc")
        return open_slc(path, info);
    if (format.name == "3mf")
        return open_slices_3mf(path, info);
    if (format.name == "dxf")
        return open_dxf(path, info);
    if (format.name == "geojson")
        return open_geojson(path, info);
    if (format.name == "wkt")
        return open_wkt(path, info);
    if (format.name == "json")
        return open_layers_json(path, info);
    if (format.name == "npz")
        return open_npz(path, info);
    if (format.name == "html")
        return open_layer_page(path, info, options.page);
    if (format.name == "svg-layers")
        return open_svg_layers(path, info);
    if (format.name == "png")
        return open_picture_folder(path, info, options);
    if (format.name == "png-zip")
        return open_picture_archive(path, info, options);
    if (format.name == "sl1" || format.name == "sl1s")
        return open_sl1(path, info, options, format.name);
    throw Error(ErrorKind::usage,
                fmt::format("there is no format '{}'; choose from {}", format.name, names()));
}

} // namespace

std::span<const LayerFormat> layer_formats() noexcept {
    return formats;
}

const LayerFormat& layer_format(std::string_view name, const std::string& path) {
    const std::string extension = lower_case(std::filesystem::path(path).extension().string());
    for (const LayerFormat& format : formats) {
        if (name.empty() ? !extension.empty() && format.extension == extension : format.name == name)
            return format;
    }
    if (!name.empty())
        throw Error(ErrorKind::usage, fmt::format("there is no format '{}'; choose from {}", name, names()));
    if (path == "-")
        throw Error(
            ErrorKind::usage,
            fmt::format("standard output has no extension to tell the format; name one of {}", names()));
    throw Error(ErrorKind::usage,
                fmt::format("the extension of '{}' tells no format; name one of {}", path, names()));
}

std::unique_ptr<LayerWriter> open_layer_writer(const std::string& path, const LayerFormat& format,
                                               const LayerFileInfo& info, const LayerWriteOptions& options) {
    check_info(info);
    if (format.directory && path == "-")
        throw Error(ErrorKind::usage,
                    fmt::format("{} writes a folder and standard output is none; give a path", format.name));
    std::unique_ptr<LayerWriter> writer = open_unlimited(path, format, info, options);
    return options.most_bytes == 0 ? std::move(writer) : limited(std::move(writer), path, options.most_bytes);
}

void write_planes(LayerWriter& writer, std::size_t planes,
                  const std::function<std::vector<Layer>(std::size_t)>& parts_of,
                  const Execution& execution) {
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::write, planes);
    std::mutex mutex;
    std::condition_variable moved;
    std::size_t next = 0;
    executor.for_chunks(planes, 1, [&](std::uint64_t plane, std::uint64_t, unsigned) {
        const std::function<void()> write = writer.prepare(parts_of(plane));
        std::unique_lock lock(mutex);
        // Planes are handed out in ascending order, so somebody is at work on the next one, or has failed.
        while (next != plane) {
            if (executor.stopping())
                return;
            moved.wait_for(lock, std::chrono::milliseconds(50)); // a stop request does not notify
        }
        if (write)
            write();
        progress.add(1);
        ++next;
        moved.notify_all();
    });
    executor.check_cancelled();
    progress.finish();
}

std::vector<std::string> write_layers(const std::string& path, const LayerFormat& format,
                                      std::span<const Layer> layers, const LayerFileInfo& info,
                                      const LayerWriteOptions& options, const Execution& execution) {
    const std::unique_ptr<LayerWriter> writer = open_layer_writer(path, format, info, options);
    write_planes(
        *writer, layers.size(), [&](std::size_t i) { return std::vector<Layer>{layers[i]}; }, execution);
    writer->finish();
    return writer->warnings();
}

std::vector<std::string> write_layers(const std::string& path, const LayerFormat& format,
                                      std::span<const LayerStack> parts, const LayerFileInfo& info,
                                      const LayerWriteOptions& options, const Execution& execution) {
    const std::unique_ptr<LayerWriter> writer = open_layer_writer(path, format, info, options);
    const std::size_t planes = parts.empty() ? 0 : parts.front().size();
    if (std::any_of(parts.begin(), parts.end(),
                    [&](const LayerStack& part) { return part.size() != planes; }))
        throw Error(ErrorKind::usage, "parts of one file must have the same planes");
    const auto parts_of = [&](std::size_t i) {
        std::vector<Layer> plane;
        plane.reserve(parts.size());
        for (const LayerStack& part : parts)
            plane.push_back(part[i]);
        return plane;
    };
    write_planes(*writer, planes, parts_of, execution);
    writer->finish();
    return writer->warnings();
}

} // namespace lamella
