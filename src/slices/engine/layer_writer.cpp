#include "lamella/slices/layer_writer.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "container/checked_output.hpp"
#include "container/gzip.hpp"
#include "core/counted.hpp"
#include "core/executor.hpp"
#include "core/lower_case.hpp"
#include "core/ordered_stage.hpp"
#include "slices/engine/ordered_writer.hpp"
#include "system/atomic_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <filesystem>
#include <utility>

namespace lamella {

namespace {

std::string names() {
    std::vector<std::string> texts;
    for (const LayerFormat& format : layer_formats())
        texts.push_back(format.extension.empty() ? std::string(format.name)
                                                 : fmt::format("{} ({})", format.name, format.extension));
    return fmt::format("{}", fmt::join(texts, ", "));
}

/// Returns whether an extension determines the format.
bool has_extension(const LayerFormat& format, std::string_view extension) {
    if (format.extension == extension)
        return true;
    std::string_view more = format.more_extensions;
    for (std::size_t blank = 0; !more.empty(); more.remove_prefix(std::min(more.size(), blank + 1))) {
        blank = std::min(more.find(' '), more.size());
        if (more.substr(0, blank) == extension)
            return true;
    }
    return false;
}

/// Throws if the path asks for compression that the format does not have.
void check_compression(const LayerFormat& format, const std::string& path) {
    if (format.chunks || !has_gzip_extension(path))
        return;
    std::vector<std::string_view> compressed;
    for (const LayerFormat& one : layer_formats())
        if (one.chunks)
            compressed.push_back(one.name);
    throw Error(ErrorKind::usage,
                fmt::format("'{}': {} is not written compressed with gzip, as {} are; leave out .gz", path,
                            format.name, fmt::join(compressed, ", ")));
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

/// Enforces LayerWriteOptions::most_bytes and `strict` on another writer. Throws after the layer that exceeds
/// the limit; throws in `finish`, before the file has its name, if there are findings. Adds the cuts that
/// are lost by the table of formats.
class LimitedWriter final : public LayerWriter {
  public:
    LimitedWriter(std::unique_ptr<LayerWriter> writer, std::string path, const LayerFormat& format,
                  const LayerWriteOptions& options)
        : writer_(std::move(writer)), path_(std::move(path)), keeps_cuts_(format.cuts),
          most_bytes_(options.most_bytes), strict_(options.strict) {}

    Commit prepare(const Plane& plane) override { return limited(writer_->prepare(plane)); }

    void finish() override {
        if (strict_)
            check_strictly(path_, findings());
        check_bytes(path_, bytes(), most_bytes_);
        writer_->finish();
    }

    std::uint64_t bytes() const noexcept override { return writer_->bytes(); }
    Findings findings() const override {
        Findings found = writer_->findings();
        if (!keeps_cuts_)
            for (const Finding& finding : losses().found.by_file)
                if (is_cut(finding.kind))
                    found.add(finding);
        return found;
    }
    WriteLosses losses() const override { return writer_->losses(); }
    const ResinJob* resin_job() const noexcept override { return writer_->resin_job(); }
    void add_losses(const WriteLosses& above) override { writer_->add_losses(above); }

  private:
    Commit limited(Commit commit) {
        return [this, commit = std::move(commit)](Completions& after) {
            commit.in_order(after);
            check_bytes(path_, bytes(), most_bytes_);
        };
    }

    std::unique_ptr<LayerWriter> writer_;
    std::string path_;
    bool keeps_cuts_;
    std::uint64_t most_bytes_;
    bool strict_;
};

} // namespace

Box3 part_box(std::span<const Layer> layers, std::span<const PointArray> hatches,
              const Execution& execution) {
    assert(hatches.empty() || hatches.size() == layers.size());
    Executor executor(execution);
    std::vector<Box3> boxes(executor.workers());
    executor.for_chunks(layers.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned worker) {
        Box3 box;
        for (const Point2& p : layers[i].points)
            box.add(Point3{p.x, p.y, layers[i].z});
        if (!hatches.empty())
            for (const Point2& p : hatches[i])
                box.add(Point3{p.x, p.y, layers[i].z});
        boxes[worker].add(box);
    });
    executor.check_cancelled();
    Box3 box;
    for (const Box3& some : boxes)
        box.add(some);
    if (!box.empty()) {
        box.min.z = layers.front().bottom;
        box.max.z = layers.back().top;
    }
    return box;
}

LayerFileInfo info_of(const PlaneSource& source) {
    if (source.planes.empty())
        throw Error(ErrorKind::input, fmt::format("{}: holds no layers", source.path));
    LayerFileInfo info{.box = {},
                       .layers = source.planes.size(),
                       .bottom = source.planes.front().bottom,
                       .parts = source.parts,
                       .rule = source.rule,
                       .grid = source.grid};
    for (PartInfo& part : info.parts) {
        if (part.label.empty())
            part.label = PartInfo{}.label;
        info.box.add(part.box);
    }
    if (info.box.empty())
        info.box.add(Point3{});
    info.box.min.z = source.planes.front().bottom;
    info.box.max.z = source.planes.back().top;
    return info;
}

const LayerFormat& layer_format(std::string_view name, const std::string& path) {
    std::filesystem::path plain(path);
    if (has_gzip_extension(path))
        plain.replace_extension();
    const std::string extension = lower_case(plain.extension().string());
    const std::string_view wanted = name.empty() ? std::string_view(extension) : name;
    const std::span<const LayerFormat> formats = layer_formats();
    const auto found = std::find_if(formats.begin(), formats.end(), [&](const LayerFormat& format) {
        return name.empty() ? has_extension(format, wanted) : format.name == wanted;
    });
    if (found != formats.end() && (!name.empty() || !extension.empty())) {
        if (name.empty())
            check_compression(*found, path);
        return *found;
    }
    if (!name.empty())
        throw Error(ErrorKind::usage,
                    fmt::format("there is no format '{}'; choose from {}", excerpt(name), names()));
    if (path == "-")
        throw Error(ErrorKind::usage,
                    fmt::format("standard output has no extension to name the format; choose a `format`: {}",
                                names()));
    for (const std::string_view machine_code : {".gcode", ".gco", ".g", ".bgcode", ".nc"})
        if (extension == machine_code)
            throw Error(
                ErrorKind::usage,
                fmt::format("'{}': Lamella writes layers and scan vectors, and no G-code; programs such as "
                            "PrusaSlicer and Cura do",
                            path));
    if (extension == ".png")
        throw Error(
            ErrorKind::usage,
            fmt::format("'{}': images go into a folder, one for each layer; give the path of a folder "
                        "and the `format` png",
                        path));
    throw Error(ErrorKind::usage,
                fmt::format("{}; choose another, or a `format`: {}",
                            extension.empty()
                                ? fmt::format("'{}' has no extension that determines the format", path)
                                : fmt::format("the extension of '{}' is that of no format", path),
                            names()));
}

std::unique_ptr<LayerWriter> open_layer_writer(const std::string& path, const LayerFormat& format,
                                               const LayerFileInfo& info, const LayerWriteOptions& options) {
    check_info(info);
    if (info.memory == nullptr)
        check_compression(format, path);
    if (format.directory && (path == "-" || info.memory != nullptr))
        throw Error(ErrorKind::usage,
                    fmt::format("{} writes a folder, so {} is not possible; give the path of a folder",
                                format.name, name_of_output(path)));
    std::unique_ptr<LayerWriter> writer = format.open(path, info, options);
    if (options.most_bytes == 0 && !options.strict && format.cuts)
        return writer;
    return std::make_unique<LimitedWriter>(std::move(writer), path, format, options);
}

void write_planes(LayerWriter& writer, std::span<const Plane> planes, const Execution& execution) {
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::write, planes.size());
    run_in_order(executor, progress, planes.size(),
                 [&](std::uint64_t i) { return writer.prepare(planes[i]); });
    progress.finish();
}

std::vector<std::string> write_layers(const std::string& path, std::span<const Layer> layers,
                                      const LayerWriteOptions& options, const Execution& execution) {
    if (layers.empty())
        throw Error(ErrorKind::usage, "there are no layers to write");
    LayerFileInfo info{.box = part_box(layers), .layers = layers.size(), .bottom = layers.front().bottom};
    if (info.box.empty())
        info.box.add(Point3{});
    info.box.min.z = info.bottom;
    info.box.max.z = layers.back().top;
    info.parts.front().box = info.box;
    return write_layers(path, layer_format("", path), std::vector<Plane>(layers.begin(), layers.end()), info,
                        options, execution);
}

std::vector<std::string> write_layers(const std::string& path, const LayerFormat& format,
                                      std::span<const Plane> planes, const LayerFileInfo& info,
                                      const LayerWriteOptions& options, const Execution& execution) {
    const std::unique_ptr<LayerWriter> writer = open_layer_writer(path, format, info, options);
    write_planes(*writer, planes, execution);
    writer->finish();
    return writer->warnings();
}

} // namespace lamella
