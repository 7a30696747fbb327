#include "lamella/core/error.hpp"
#include "lamella/slices/layer_file.hpp"

#include "container/gzip.hpp"
#include "container/read_limits.hpp"
#include "container/text_position.hpp"
#include "container/zip_reader.hpp"
#include "core/executor.hpp"
#include "core/progress.hpp"
#include "inputs/mesh_formats.hpp"
#include "slices/engine/layer_assembly.hpp"
#include "slices/engine/layer_readers.hpp"
#include "system/byte_source.hpp"
#include "system/memory_size.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

namespace {

std::string signatures() {
    std::vector<std::string_view> all;
    for (const SliceFormat& format : slice_formats())
        if (!format.signature.empty())
            all.push_back(format.signature);
    return fmt::format("{}", fmt::join(all, ", "));
}

/// A file, and what its layers refer to if they are parsed again.
struct OpenedFile {
    ByteSource source;
    ReadLimits limits;
    std::unique_ptr<const ZipReader> archive = nullptr; ///< if it is one
};

LayerFile read_source(OpenedFile& file, const LayerReadOptions& options, const Execution& execution) {
    const ByteSource& source = file.source;
    const std::string_view bytes = source.text();
    if (is_zip(bytes)) {
        file.archive = std::make_unique<const ZipReader>(source, most_unpacked(options));
        if (const SliceFormat* const format = slice_format_of(*file.archive))
            return format->read_archive(*file.archive, file.limits, execution);
        if (const MeshFormatRow* const other =
                recognised_format(source, {.max_memory = most_unpacked(options)});
            !other->advice.empty())
            throw NoLayers(fmt::format("{}: {}", source.name, other->advice));
        throw NoLayers(
            fmt::format("{}: found a zip archive that holds no layers; of archives, 3MF with slice "
                        "stacks or toolpaths, NumPy arrays, ILT and images for resin printers are read",
                        source.name));
    }
    if (const SliceFormat* const format = slice_format_of(bytes))
        return format->read(bytes, source.name, file.limits, execution);
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
                            "NumPy arrays, ILT or images for resin printers",
                            source.name, printable(bytes.substr(0, 16), 48), signatures()));
}

/// A function that makes a plane.
using MakePlane = std::function<Plane(std::size_t)>;

/// Returns the function that also releases the memory of the bytes of a file on disk, again and again.
MakePlane releasing(MakePlane make, std::size_t planes, const ByteSource& source) {
    constexpr std::uint64_t most_in_memory = std::uint64_t{1} << 22;
    const std::uint64_t each =
        std::max<std::uint64_t>(1, planes * most_in_memory / std::max<std::uint64_t>(1, source.size()));
    return [make = std::move(make), &source, each,
            made = std::make_shared<std::atomic<std::uint64_t>>(0)](std::size_t position) {
        Plane plane = make(position);
        if (++*made % each == 0)
            release(source, source.bytes);
        return plane;
    };
}

/// Reads the layers once. If they are not kept in memory, keeps what is needed to parse them again.
LayerFile read_once(const ByteSource& source, const LayerReadOptions& options, const Execution& execution) {
    const auto opened =
        std::make_shared<OpenedFile>(OpenedFile{.source = source, .limits = {source, options}});
    LayerFile file = read_source(*opened, options, releasing(source, execution));
    if (opened->limits.in_memory())
        return file;
    if (opened->source.on_disk) {
        release(source, source.bytes);
        file.make = releasing(std::move(file.make), file.planes.size(), opened->source);
    }
    file.make = [opened, make = std::move(file.make)](std::size_t position) {
        return make(position);
    };
    return file;
}

} // namespace

LayerFile read_unpacked_layers(const ByteSource& source, const LayerReadOptions& options,
                               const Execution& execution) {
    const bool tight = options.max_memory != 0 && is_tight_for_layers(options.max_memory, source.size());
    LayerReadOptions fewer = options;
    Execution one = execution;
    if (options.kept == KeptPlanes::if_faster ||
        (thread_count(execution) > 1 && !(tight && options.kept == KeptPlanes::all)))
        try {
            return read_once(source, options, execution);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::limit)
                throw;
            one = without_progress(execution);
            if (options.kept == KeptPlanes::if_faster)
                fewer.kept = KeptPlanes::none;
        }
    // Several threads may exceed a limit that one thread keeps, and find the excess at different positions.
    one.threads = 1;
    return read_once(source, fewer, one);
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
