#include "inputs/mesh_formats.hpp"

#include "lamella/core/error.hpp"

#include "container/read_limits.hpp"
#include "container/text_chunks.hpp"
#include "container/zip_reader.hpp"
#include "core/lower_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lamella {

namespace {

using namespace std::string_view_literals;

template <bool (*recognises)(std::string_view)>
bool by_text(const ByteSource& source, const MeshReadOptions&) {
    return recognises(source.text());
}

template <bool (*recognises)(const ZipReader&)>
bool by_archive(const ByteSource& source, const MeshReadOptions& options) {
    return is_zip(source.text()) && recognises(ZipReader(source, most_unpacked(options)));
}

bool is_any_stl(const ByteSource& source, const MeshReadOptions&) {
    return is_stl(source);
}

bool holds(const ZipReader& zip, std::string_view ending) {
    return std::any_of(zip.entries().begin(), zip.entries().end(),
                       [&](const ZipEntry& entry) { return lower_case(entry.name).ends_with(ending); });
}

/// Returns whether the archive may be a 3MF package.
bool holds_model(const ZipReader& zip) {
    return holds(zip, ".rels") || holds(zip, ".model");
}

/// Returns whether this is AMF, perhaps compressed under another name, but not a 3MF package.
bool is_plain_or_compressed_amf(const ByteSource& source, const MeshReadOptions& options) {
    if (!is_zip(source.text()))
        return is_amf(source.text());
    const ZipReader zip(source, most_unpacked(options));
    if (holds_model(zip))
        return false;
    return holds(zip, ".amf") || holds(zip, ".amf.xml") ||
           (zip.entries().size() == 1 && is_amf(zip.first_bytes(zip.entries().front(), amf_root_within)));
}

/// Returns whether the archive contains images, such as a job for a resin printer.
bool holds_images(const ZipReader& zip) {
    return holds(zip, ".png") && !holds_model(zip);
}

/// Returns whether the checksum of the first header, which all variants of tar have, is correct.
bool is_tar(std::string_view text) {
    constexpr std::size_t header_bytes = 512;
    constexpr std::size_t checksum_at = 148;
    constexpr std::size_t checksum_bytes = 8;
    if (text.size() < header_bytes || text[0] == '\0')
        return false;
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < header_bytes; ++i) // the checksum itself counts as blanks
        sum += i - checksum_at < checksum_bytes ? ' ' : static_cast<unsigned char>(text[i]);
    std::uint64_t stored = 0;
    std::size_t digits = 0;
    for (std::size_t i = checksum_at; i < checksum_at + checksum_bytes; ++i)
        if (text[i] >= '0' && text[i] <= '7') {
            stored = stored * 8 + static_cast<std::uint64_t>(text[i] - '0');
            ++digits;
        } else if (digits != 0 || text[i] != ' ') {
            break;
        }
    return digits != 0 && stored == sum;
}

constexpr std::string_view web_page = "is a web page, no mesh file; download the file itself";
constexpr std::string_view utf16 = "is text in UTF-16; save it as UTF-8, or as a binary file";
constexpr std::string_view image = "is an image, no mesh file";
constexpr std::string_view compressed =
    "is compressed by a method that is not read here; decompress it first, or compress it with gzip";
constexpr std::string_view surfaces =
    "is a CAD file of surfaces without triangles; export STL, 3MF, OBJ or PLY from a CAD program";
constexpr std::string_view drawing =
    "is a DXF drawing, which is only written here and not read; take the mesh, or layers in another format";
constexpr std::string_view scene =
    "is a kind of mesh file that is not read here; save it as STL, 3MF, OBJ or PLY";

constexpr std::array stl_rows = {
    MeshFormatRow{.extension = "stl", .recognises = is_any_stl, .read = read_stl, .stream = stream_stl}};

constexpr std::array archive_and_text_rows = {
    // Zip archives.
    MeshFormatRow{.extension = "amf", .recognises = is_plain_or_compressed_amf, .read = read_amf},
    MeshFormatRow{
        .recognises = by_archive<holds_images>,
        .advice = "holds images of layers, as for a resin printer, and no mesh; of such archives, those of "
                  "png-zip, SL1, Chitubox and NanoDLP can be viewed, converted and verified as they are"},
    MeshFormatRow{.extension = "3mf", .recognises = by_text<is_zip>, .read = read_three_mf},
    MeshFormatRow{.recognises = by_text<is_tar>,
                  .advice = "is a tar archive, no mesh file; unpack it, and take the mesh that is in it"},
    // Texts, and binary files with a text header.
    MeshFormatRow{.extension = "ply", .recognises = by_text<is_ply>, .goes_by_name = true, .read = read_ply},
    MeshFormatRow{.extension = "off", .recognises = by_text<is_off>, .goes_by_name = true, .read = read_off},
    MeshFormatRow{.extension = "obj", .goes_by_name = true, .resembles = looks_like_obj, .read = read_obj},
    // Web pages, which may hold SVG.
    MeshFormatRow{.first_bytes = "<!doctype html"sv, .advice = web_page},
    MeshFormatRow{.first_bytes = "<html"sv, .advice = web_page},
};

// Files that are often named like a mesh file, or passed by mistake. Binary ones would be mistaken for
// binary STL with a wrong count.
constexpr std::array other_rows = {
    MeshFormatRow{.first_bytes = "\x1f\x8b"sv,
                  .advice = "is compressed with gzip twice; decompress it once first"},
    MeshFormatRow{.first_bytes = "<?xml"sv, .advice = "is an XML file of an unknown kind, no mesh file"},
    MeshFormatRow{.first_bytes = "version https://git-lfs"sv,
                  .advice = "is a pointer of Git LFS to the real file; fetch it with 'git lfs pull'"},
    MeshFormatRow{.first_bytes = "\xff\xfe"sv, .advice = utf16},
    MeshFormatRow{.first_bytes = "\xfe\xff"sv, .advice = utf16},
    MeshFormatRow{.first_bytes = "eos 1993 sli"sv,
                  .advice = "is an SLI slice file of EOS, which is not read here; export CLI instead"},
    MeshFormatRow{.first_bytes = "\x89PNG"sv, .advice = image},
    MeshFormatRow{.first_bytes = "\xff\xd8\xff"sv, .advice = image},
    MeshFormatRow{.first_bytes = "GIF8"sv, .advice = image},
    MeshFormatRow{.first_bytes = "II*\0"sv, .advice = image}, // TIFF
    MeshFormatRow{.first_bytes = "MM\0*"sv, .advice = image},
    MeshFormatRow{.first_bytes = "%pdf-"sv, .advice = "is a PDF document, no mesh file"},
    MeshFormatRow{.first_bytes = "\x7f"
                                 "ELF"sv,
                  .advice = "is a program, no mesh file"},
    MeshFormatRow{.first_bytes = "BZh"sv, .advice = compressed},
    MeshFormatRow{.first_bytes = "\xfd"
                                 "7zXZ"sv,
                  .advice = compressed},
    MeshFormatRow{.first_bytes = "\x28\xb5\x2f\xfd"sv, .advice = compressed}, // Zstandard
    MeshFormatRow{.first_bytes = "7z\xbc\xaf"sv, .advice = compressed},
    MeshFormatRow{.first_bytes = "\x04\x22\x4d\x18"sv, .advice = compressed}, // LZ4
    MeshFormatRow{.first_bytes = "MSCF"sv, .advice = compressed},             // Microsoft Cabinet
    MeshFormatRow{.first_bytes = "Rar!"sv, .advice = compressed},
    // DXF files begin with one of two groups, in which other programs write no blanks.
    MeshFormatRow{.first_bytes = "0\nSECTION"sv, .advice = drawing},
    MeshFormatRow{.first_bytes = "0\r\nSECTION"sv, .advice = drawing},
    MeshFormatRow{.first_bytes = "999\n"sv, .advice = drawing}, // a comment
    MeshFormatRow{.first_bytes = "999\r\n"sv, .advice = drawing},
    MeshFormatRow{.first_bytes = "iso-10303-21"sv, .advice = surfaces}, // STEP
    // Compound documents, as SolidWorks and Inventor write.
    MeshFormatRow{.first_bytes = "\xd0\xcf\x11\xe0"sv, .advice = surfaces},
    MeshFormatRow{.first_bytes = "3D Geometry File Format"sv, .advice = surfaces},
    MeshFormatRow{.first_bytes = "glTF"sv, .advice = scene},
    MeshFormatRow{.first_bytes = "Kaydara FBX Binary"sv, .advice = scene},
    MeshFormatRow{.first_bytes = "BLENDER"sv, .advice = scene},
};

bool is_in_archive(const SliceFormat& format, const ByteSource& source, const MeshReadOptions& options) {
    return is_zip(source.text()) && format.in_archive(ZipReader(source, most_unpacked(options)));
}

/// Appends the formats of slice files that can be read, and that hold no meshes.
void append_slice_files(bool archives, std::vector<MeshFormatRow>& rows) {
    const std::span<const SliceFormat> formats = slice_formats();
    for (auto format = formats.rbegin(); format != formats.rend(); ++format)
        if (!format->advice.empty() && (format->in_archive != nullptr) == archives)
            rows.push_back({.extension = format->writer.extension.substr(1),
                            .first_bytes = format->first_bytes,
                            .goes_by_name = true,
                            .advice = format->advice,
                            .slices = &*format});
}

/// The first row that recognises a file applies. If no row does, the first row of the table applies, because
/// STL has no signature. Texts that contain the signature of the Common Layer Interface can also be PLY or
/// OFF.
const std::vector<MeshFormatRow>& table() {
    static const std::vector<MeshFormatRow> rows = [] {
        std::vector<MeshFormatRow> all(stl_rows.begin(), stl_rows.end());
        append_slice_files(true, all);
        all.insert(all.end(), archive_and_text_rows.begin(), archive_and_text_rows.end());
        append_slice_files(false, all);
        all.insert(all.end(), other_rows.begin(), other_rows.end());
        return all;
    }();
    return rows;
}

/// Returns whether a row recognises a file with certainty, apart from its first bytes.
bool recognises(const MeshFormatRow& row, const ByteSource& source, const MeshReadOptions& options) {
    if (row.slices == nullptr)
        return row.recognises != nullptr && row.recognises(source, options);
    return row.slices->in_archive != nullptr ? is_in_archive(*row.slices, source, options)
                                             : row.slices->recognises(source.text());
}

bool begins_with(std::string_view text, std::string_view first_bytes) {
    const auto same = [](char byte, char expected) {
        return byte == expected ||
               (expected >= 'a' && expected <= 'z' && byte == static_cast<char>(expected - ('a' - 'A')));
    };
    return text.size() >= first_bytes.size() &&
           std::equal(first_bytes.begin(), first_bytes.end(), text.begin(),
                      [&](char expected, char byte) { return same(byte, expected); });
}

/// Returns the extension of a name in lower case, without that of gzip: "stl" of "PART.STL.gz".
std::string extension_of(std::string name) {
    name = lower_case(name);
    if (name.ends_with(".gz"))
        name.resize(name.size() - 3);
    const std::size_t point = name.find_last_of("./");
    return point == std::string::npos || name[point] == '/' ? std::string() : name.substr(point + 1);
}

template <class Condition>
const MeshFormatRow* first_row(const Condition& condition) {
    const auto row = std::find_if(table().begin(), table().end(), condition);
    return row == table().end() ? nullptr : &*row;
}

[[noreturn]] void refuse(const ByteSource& source, std::string_view what) {
    throw Error(ErrorKind::input, fmt::format("{}: {}", source.name, what));
}

} // namespace

const MeshFormatRow* recognised_format(const ByteSource& source, const MeshReadOptions& options) {
    const std::string_view text = source.text();
    const std::string_view begin = after_blanks(text);
    return first_row([&](const MeshFormatRow& row) {
        if (recognises(row, source, options))
            return true;
        return !row.first_bytes.empty() &&
               (begins_with(text, row.first_bytes) || begins_with(begin, row.first_bytes));
    });
}

const MeshFormatRow& mesh_format_of(const ByteSource& source, const MeshReadOptions& options) {
    if (const MeshFormatRow* const row = recognised_format(source, options)) {
        if (row->read == nullptr)
            refuse(source, row->advice);
        return *row;
    }
    const std::string extension = extension_of(source.name);
    const MeshFormatRow* const named =
        first_row([&](const MeshFormatRow& row) { return row.goes_by_name && row.extension == extension; });
    if (named != nullptr && named->read != nullptr)
        return *named;
    if (const MeshFormatRow* const row = first_row([&](const MeshFormatRow& candidate) {
            return candidate.resembles != nullptr && candidate.resembles(source.text());
        }))
        return *row;
    if (named != nullptr)
        refuse(source, fmt::format("is neither a mesh file nor the slice file that its extension .{} says",
                                   extension));
    // A file with the extension of another format is not meant to be STL.
    if (first_row([&](const MeshFormatRow& row) {
            return row.read != nullptr && row.extension == extension && &row != table().data();
        }) != nullptr)
        refuse(source,
               fmt::format("is neither what its extension .{} says nor another mesh file that is known",
                           extension));
    return table().front();
}

std::vector<std::string_view> mesh_extensions() {
    std::vector<std::string_view> extensions;
    for (const MeshFormatRow& row : table())
        if (row.read != nullptr)
            extensions.push_back(row.extension);
    return extensions;
}

bool is_mesh_name(const std::string& name) {
    const std::string extension = extension_of(name);
    return first_row([&](const MeshFormatRow& row) {
               return row.read != nullptr && row.extension == extension;
           }) != nullptr;
}

} // namespace lamella
