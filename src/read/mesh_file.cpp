#include "lamella/read/mesh_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/read/mesh_input.hpp"

#include "container/byte_source.hpp"
#include "container/gzip.hpp"
#include "container/zip_reader.hpp"
#include "core/lower_case.hpp"
#include "read/amf.hpp"
#include "read/foreign_files.hpp"
#include "read/obj.hpp"
#include "read/off.hpp"
#include "read/ply.hpp"
#include "read/stl.hpp"
#include "read/three_mf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace lamella {

const char* format_name(MeshFormat format) noexcept {
    switch (format) {
    case MeshFormat::stl_binary:
        return "stl-binary";
    case MeshFormat::stl_ascii:
        return "stl-ascii";
    case MeshFormat::three_mf:
        return "3mf";
    case MeshFormat::amf:
        return "amf";
    case MeshFormat::obj:
        return "obj";
    case MeshFormat::ply:
        return "ply";
    case MeshFormat::off:
        return "off";
    }
    return "unknown";
}

Mesh MeshFile::placed(std::size_t i) const {
    return objects[instances[i].object].mesh.transformed(instances[i].placement);
}

Mesh MeshFile::mesh(const Execution& execution) const {
    std::vector<Mesh> all;
    for (std::size_t i = 0; i < instances.size(); ++i)
        all.push_back(placed(i));
    return joined(all, execution);
}

namespace {

/// Whether a zip archive is no 3MF package, but a packed AMF file, perhaps of another name.
bool holds_amf(const ByteSource& source, const MeshReadOptions& options) {
    const ZipReader zip(source, options.max_memory);
    const auto any = [&](std::string_view suffix) {
        return std::any_of(zip.entries().begin(), zip.entries().end(),
                           [&](const ZipEntry& entry) { return entry.name.ends_with(suffix); });
    };
    if (any(".rels") || any(".model"))
        return false;
    return any(".amf") || any(".AMF") || any(".amf.xml") ||
           (zip.entries().size() == 1 && is_amf(zip.read(zip.entries().front()).text()));
}

/// The extension of a name in lower case, without the one of gzip: "stl" of "PART.STL.gz".
std::string extension_of(std::string name) {
    name = lower_case(name);
    if (name.ends_with(".gz"))
        name.resize(name.size() - 3);
    const std::size_t point = name.find_last_of("./");
    return point == std::string::npos || name[point] == '/' ? std::string() : name.substr(point + 1);
}

using Reader = MeshFile (*)(const ByteSource&, const MeshReadOptions&, const Execution&);

/// By the content, where that tells; else by the extension.
Reader reader_of(const ByteSource& source, const MeshReadOptions& options) {
    const std::string_view text = source.text();
    const std::string extension = extension_of(source.name);
    if (is_stl(source))
        return read_stl;
    if (is_zip(text))
        return holds_amf(source, options) ? read_amf : read_three_mf;
    if (is_amf(text))
        return read_amf;
    if (is_ply(text))
        return read_ply;
    if (is_off(text))
        return read_off;
    if (const std::string_view advice = foreign_advice(text); !advice.empty())
        throw Error(ErrorKind::input, fmt::format("{}: {}", source.name, advice));
    if (extension == "obj" || (extension != "off" && extension != "ply" && looks_like_obj(text)))
        return read_obj;
    if (extension == "off")
        return read_off;
    if (extension == "ply")
        return read_ply;
    return read_stl;
}

MeshFile read_any(const ByteSource& opened, const MeshReadOptions& options, const Execution& execution) {
    const ByteSource source =
        is_gzip(opened.bytes) ? unpack_gzip(opened, options.max_memory, execution.cancel) : opened;
    return reader_of(source, options)(source, options, execution);
}

} // namespace

MeshFile read_mesh(const std::string& path, const MeshReadOptions& options, const Execution& execution) {
    MeshFile file = read_any(open_bytes(path, execution.cancel), options, execution);
    file.path = path;
    return file;
}

MeshFile read_mesh(std::span<const std::byte> bytes, const std::string& name, const MeshReadOptions& options,
                   const Execution& execution) {
    MeshFile file = read_any(copy_bytes(bytes, name), options, execution);
    file.path = name;
    return file;
}

MeshInput::MeshInput(const std::string& path, std::uint64_t most_in_memory, const std::stop_token& cancel)
    : path_(path), source_(std::make_shared<const ByteSource>(open_bytes(path, most_in_memory, cancel))) {}

std::uint64_t MeshInput::bytes() const noexcept {
    return source_->bytes.size();
}

bool MeshInput::can_stream() const {
    if (is_stl(*source_))
        return true;
    return !is_gzip(source_->bytes) && !is_zip(source_->text()) && reader_of(*source_, {}) == read_stl;
}

std::optional<std::uint64_t> MeshInput::records() const {
    return can_stream() ? stl_records(*source_) : std::nullopt;
}

MeshFile MeshInput::read(const MeshReadOptions& options, const Execution& execution) const {
    MeshFile file = read_any(*source_, options, execution);
    file.path = path_;
    return file;
}

MeshFile MeshInput::stream(const TriangleSink& sink, const MeshReadOptions& options,
                           const Execution& execution, const std::optional<RecordRange>& share) const {
    if (!can_stream())
        throw Error(
            ErrorKind::usage,
            fmt::format("{}: only STL files that are not packed can be read batch by batch", source_->name));
    MeshFile file = stream_stl(*source_, sink, options, execution, share);
    file.path = path_;
    return file;
}

} // namespace lamella
