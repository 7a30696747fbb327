#include "lamella/read/layer_file.hpp"

#include "lamella/core/error.hpp"

#include "container/gzip.hpp"
#include "container/text_position.hpp"
#include "container/zip_reader.hpp"
#include "core/executor.hpp"
#include "core/progress.hpp"
#include "read/layer_assembly.hpp"
#include "read/layer_readers.hpp"
#include "read/mesh_formats.hpp"
#include "read/read_limits.hpp"
#include "system/byte_source.hpp"
#include "system/memory_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <string_view>
#include <utility>

namespace lamella {

namespace {

/// A file, and what its layers refer to if they are parsed again.
struct OpenedFile {
    ByteSource source;
    ReadLimits limits;
    std::unique_ptr<const ZipReader> archive = nullptr; ///< if it is one
};

std::uint64_t size_of_entries(const ZipReader& archive) {
    std::uint64_t bytes = 0;
    for (const ZipEntry& entry : archive.entries())
        bytes += entry.size;
    return bytes;
}

LayerFile read_source(OpenedFile& file, const LayerReadOptions& options, const Execution& execution) {
    const ByteSource& source = file.source;
    const std::string_view bytes = source.text();
    if (is_zip(bytes)) {
        file.archive = std::make_unique<const ZipReader>(source, most_unpacked(options));
        file.limits.keep_in_ample_memory(size_of_entries(*file.archive));
        if (ReadLayersOfArchive* const read = archive_reader(*file.archive))
            return read(*file.archive, file.limits, execution);
        if (const MeshFormatRow* const other =
                recognised_format(source, {.max_memory = most_unpacked(options)});
            !other->advice.empty())
            throw NoLayers(fmt::format("{}: {}", source.name, other->advice));
        throw NoLayers(
            fmt::format("{}: found a zip archive that holds no layers; of archives, 3MF with slice "
                        "stacks or toolpaths, NumPy arrays and ILT are read",
                        source.name));
    }
    file.limits.keep_in_ample_memory(source.size());
    if (const MeshFormatRow* const format = layer_format_of(source))
        return format->read_layers(bytes, source.name, file.limits, execution);
    if (const MeshFormatRow* const other = recognised_format(source, {.max_memory = most_unpacked(options)});
        other != nullptr && other->read != nullptr)
        throw Error(ErrorKind::input,
                    fmt::format("{}: found a mesh; a slice file is expected: slice it first", source.name));
    if (const std::string_view other = other_slc(bytes); !other.empty())
        throw Error(ErrorKind::input,
                    fmt::format("{}: found {}; of the formats that go by this name, that of 3D Systems is "
                                "read (-SLCVER)",
                                source.name, other));
    throw Error(ErrorKind::input,
                fmt::format("{}: found '{}' at its beginning; a slice file is expected: {}, 3MF with slice "
                            "stacks or toolpaths, "
                            "NumPy arrays or ILT",
                            source.name, printable(bytes.substr(0, 16), 48), layer_magics()));
}

} // namespace

ReadLayersOfArchive* archive_reader(const ZipReader& archive) {
    if (is_npz(archive))
        return read_npz;
    if (is_ilt(archive))
        return read_ilt;
    if (is_toolpath_3mf(archive))
        return read_toolpath_3mf;
    return is_3mf(archive) ? read_slices_3mf : nullptr;
}

namespace {

/// Returns a function that parses planes of a file on disk, and releases the memory of its bytes again and
/// again.
std::function<ScanVectors(std::size_t)> releasing_planes(const LayerStream& stream,
                                                         const ByteSource& source) {
    constexpr std::uint64_t most_in_memory = std::uint64_t{1} << 22;
    const std::uint64_t planes =
        stream.planes.size() * most_in_memory / std::max<std::uint64_t>(1, source.size());
    return [parse = stream.parse, &source, planes = std::max<std::uint64_t>(1, planes),
            parsed = std::make_shared<std::atomic<std::uint64_t>>(0)](std::size_t position) {
        ScanVectors plane = parse(position);
        if (++*parsed % planes == 0)
            release(source, source.bytes);
        return plane;
    };
}

/// Reads the layers once. If they are not kept in memory, keeps what is needed to parse them again.
LayerFile read_once(const ByteSource& source, const LayerReadOptions& options, const Execution& execution) {
    const auto opened =
        std::make_shared<OpenedFile>(OpenedFile{.source = source, .limits = {source, options}});
    LayerFile file = read_source(*opened, options, releasing(source, execution));
    if (file.stream) {
        if (opened->source.on_disk) {
            release(source, source.bytes);
            LayerStream stream = *file.stream;
            stream.parse = releasing_planes(stream, opened->source);
            file.stream = std::make_shared<const LayerStream>(std::move(stream));
        }
        const auto both =
            std::make_shared<std::pair<std::shared_ptr<OpenedFile>, std::shared_ptr<const LayerStream>>>(
                opened, std::move(file.stream));
        file.stream = {both, both->second.get()};
    }
    return file;
}

} // namespace

LayerFile read_unpacked_layers(const ByteSource& source, const LayerReadOptions& options,
                               const Execution& execution) {
    const bool tight = options.max_memory != 0 && is_tight_for_layers(options.max_memory, source.size());
    Execution one = execution;
    if (thread_count(execution) > 1 && !(tight && options.layers == LayersKept::all))
        try {
            return read_once(source, options, execution);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::limit)
                throw;
            one = without_progress(execution);
        }
    // Several threads may exceed a limit that one thread keeps, and find the excess at different positions.
    one.threads = 1;
    return read_once(source, options, one);
}

namespace {

std::uint64_t memory_of(const Layer& layer) {
    return sizeof(Layer) + of_empty_layer + layer.offsets.size() * sizeof(std::uint64_t) +
           layer.points.size() * sizeof(Point2);
}

} // namespace

std::uint64_t memory_of(const LayerFile& file) noexcept {
    std::uint64_t bytes = file.stream ? file.stream->bytes : 0;
    for (const LayerPart& part : file.parts) {
        for (const Layer& layer : part.layers)
            bytes += memory_of(layer);
        for (const PointArray& hatches : part.hatches)
            bytes += sizeof(PointArray) + hatches.size() * sizeof(Point2);
    }
    return bytes;
}

void check(const LayerFile& file) {
    for (const LayerPart& part : file.parts) {
        const std::size_t planes = file.parts.front().layers.size();
        if (part.layers.size() != planes)
            throw Error(
                ErrorKind::usage,
                fmt::format("{}: the part \"{}\" has {} layers and the first one has {}; parts can be "
                            "put together where all have the same planes",
                            file.path, excerpt(part.label), part.layers.size(), planes));
        if (!part.hatches.empty() && part.hatches.size() != planes)
            throw Error(ErrorKind::usage,
                        fmt::format("{}: the part \"{}\" has {} layers and hatch lines of {}", file.path,
                                    excerpt(part.label), planes, part.hatches.size()));
    }
}

std::uint64_t LayerPart::hatch_lines() const noexcept {
    std::uint64_t points = 0;
    for (const PointArray& of_layer : hatches)
        points += of_layer.size();
    return points / 2;
}

const LayerStack& LayerFile::planes() const noexcept {
    return stream ? stream->planes : parts.front().layers;
}

std::uint64_t LayerFile::hatch_lines(std::size_t part) const {
    return stream ? stream->hatch_lines[part] : parts[part].hatch_lines();
}

std::vector<PlaneContent> LayerFile::contents() const {
    if (stream)
        return stream->contents;
    std::vector<PlaneContent> contents(parts.empty() ? 0 : planes().size());
    for (const LayerPart& part : parts)
        for (std::size_t i = 0; i < contents.size(); ++i) {
            contents[i].contours = contents[i].contours || part.layers[i].contours() > 0;
            contents[i].hatch_lines += part.hatches_of(i).size() / 2;
        }
    return contents;
}

void LayerFile::keep_layers(const LayerReadOptions& options, const Execution& execution) {
    if (!stream)
        return;
    ReadLimits limits(ByteSource{.name = path, .bytes = {}, .owner = {}}, options);
    limits.add_bytes(stream->bytes);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        parts[i].layers.resize(planes().size());
        if (hatch_lines(i) > 0)
            parts[i].hatches.resize(planes().size());
    }
    Executor executor(for_planes(execution));
    executor.for_chunks(planes().size(), 1, [&](std::uint64_t position, std::uint64_t, unsigned) {
        ScanVectors vectors = plane(position);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            limits.add_bytes_at(memory_of(vectors.polylines[i]) + vectors.hatches[i].size() * sizeof(Point2),
                                [&] { return fmt::format("layer {}", position); });
            parts[i].layers[position] = std::move(vectors.polylines[i]);
            if (!parts[i].hatches.empty())
                parts[i].hatches[position] = std::move(vectors.hatches[i]);
        }
    });
    executor.check_cancelled();
    stream = nullptr;
}

Execution LayerFile::for_planes(const Execution& execution) const {
    Execution fewer = execution;
    if (stream) {
        const std::uint64_t planes =
            std::max<std::uint64_t>(1, stream->spare_bytes / std::max<std::uint64_t>(1, stream->plane_bytes));
        fewer.threads = static_cast<unsigned>(std::min<std::uint64_t>(planes, thread_count(execution)));
    }
    return fewer;
}

ScanVectors LayerFile::plane(std::size_t position) const {
    if (stream) {
        ScanVectors vectors = stream->parse(position);
        const Layer& heights = stream->planes[position];
        for (Layer& layer : vectors.polylines) {
            layer.index = heights.index;
            layer.z = heights.z;
            layer.bottom = heights.bottom;
            layer.top = heights.top;
        }
        return vectors;
    }
    ScanVectors vectors;
    for (const LayerPart& part : parts)
        vectors.add(part.layers[position], part.hatches.empty() ? PointArray() : part.hatches[position]);
    return vectors;
}

LayerStack LayerFile::merged(const Execution& execution) const {
    if (stream) {
        LayerFile held = *this;
        held.keep_layers({}, execution);
        return held.merged(execution);
    }
    check(*this);
    if (parts.size() == 1)
        return parts.front().layers;
    LayerStack all(parts.empty() ? 0 : parts.front().layers.size());
    Executor executor(execution);
    executor.for_chunks(all.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
        std::vector<Layer> plane;
        for (const LayerPart& part : parts)
            plane.push_back(part.layers[i]);
        all[i] = lamella::merged(plane);
    });
    executor.check_cancelled();
    return all;
}

LayerFile read_layers(const std::string& path, const LayerReadOptions& options, const Execution& execution) {
    const ByteSource opened = open_bytes(path, execution, memory_of_file(options.max_memory));
    return read_unpacked_layers(unpacked(opened, most_unpacked(options), execution), options, execution);
}

LayerFile read_layers(std::span<const std::byte> bytes, const std::string& name,
                      const LayerReadOptions& options, const Execution& execution) {
    return read_unpacked_layers(unpacked(copy_bytes(bytes, name), most_unpacked(options), execution), options,
                                execution);
}

} // namespace lamella
