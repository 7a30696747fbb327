#include "lamella/read/layer_file.hpp"

#include "lamella/core/error.hpp"

#include "container/gzip.hpp"
#include "container/text_position.hpp"
#include "container/zip_reader.hpp"
#include "read/layer_assembly.hpp"
#include "read/layer_readers.hpp"
#include "read/mesh_formats.hpp"
#include "read/read_limits.hpp"
#include "system/byte_source.hpp"
#include "system/memory_size.hpp"

#include <fmt/format.h>

#include <string_view>

namespace lamella {

namespace {

LayerFile read_source(const ByteSource& source, const LayerReadOptions& options, ReadLimits& limits,
                      const Execution& execution) {
    const std::string_view bytes = source.text();
    if (is_zip(bytes)) {
        const ZipReader package(source, most_unpacked(options));
        if (ReadLayersOfArchive* const read = archive_reader(package))
            return read(package, limits, execution);
        if (const MeshFormatRow* const other =
                recognised_format(source, {.max_memory = most_unpacked(options)});
            !other->advice.empty())
            throw NoLayers(fmt::format("{}: {}", source.name, other->advice));
        throw NoLayers(
            fmt::format("{}: found a zip archive that holds no layers; of archives, 3MF with slice "
                        "stacks or toolpaths, NumPy arrays and ILT are read",
                        source.name));
    }
    if (const MeshFormatRow* const format = layer_format_of(source))
        return format->read_layers(bytes, source.name, limits, execution);
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

LayerFile read_unpacked_layers(const ByteSource& source, const LayerReadOptions& options,
                               const Execution& execution) {
    ReadLimits limits(source, options);
    return read_source(source, options, limits, releasing(source, execution));
}

std::uint64_t memory_of(const LayerFile& file) noexcept {
    std::uint64_t bytes = 0;
    for (const LayerPart& part : file.parts) {
        for (const Layer& layer : part.layers)
            bytes += sizeof(Layer) + of_empty_layer + layer.offsets.size() * sizeof(std::uint64_t) +
                     layer.points.size() * sizeof(Point2);
        for (const PointArray& hatches : part.hatches)
            bytes += sizeof(PointArray) + hatches.size() * sizeof(Point2);
    }
    return bytes;
}

std::uint64_t LayerPart::hatch_lines() const noexcept {
    std::uint64_t points = 0;
    for (const PointArray& of_layer : hatches)
        points += of_layer.size();
    return points / 2;
}

ScanVectors LayerFile::plane(std::size_t position) const {
    ScanVectors vectors;
    for (const LayerPart& part : parts)
        vectors.add(part.layers[position], part.hatches.empty() ? PointArray() : part.hatches[position]);
    return vectors;
}

LayerStack LayerFile::merged() const {
    if (parts.size() == 1)
        return parts.front().layers;
    const std::size_t planes = parts.empty() ? 0 : parts.front().layers.size();
    for (const LayerPart& part : parts)
        if (part.layers.size() != planes)
            throw Error(
                ErrorKind::usage,
                fmt::format("{}: the part \"{}\" has {} layers and the first one has {}; parts can be "
                            "put together where all have the same planes",
                            path, excerpt(part.label), part.layers.size(), planes));
    LayerStack all;
    std::vector<Layer> plane(parts.size());
    for (std::size_t i = 0; i < planes; ++i) {
        for (std::size_t part = 0; part < parts.size(); ++part)
            plane[part] = parts[part].layers[i];
        all.push_back(lamella::merged(plane));
    }
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
