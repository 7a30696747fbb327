#pragma once

// The table of the formats of slice files: how each is written and, if it can be read, how it is recognised
// and read.

#include "lamella/slices/layer_writer.hpp"

#include "slices/engine/layer_readers.hpp"

#include <span>
#include <string_view>

namespace lamella {

/// A format of slice files. One that can be read has `recognises` and `read` or, if it is an archive,
/// `in_archive` and `read_archive`.
struct SliceFormat {
    LayerFormat writer = {};

    /// Recognises a file that is not an archive.
    bool (*recognises)(std::string_view bytes) = nullptr;
    ReadLayers* read = nullptr;
    /// First bytes of such a file, after blanks; lower-case letters match both cases. "" if only `recognises`
    /// decides.
    std::string_view first_bytes = {};
    /// The name of the format and its first bytes, for errors.
    std::string_view signature = {};

    /// Recognises an archive.
    bool (*in_archive)(const ZipReader& archive) = nullptr;
    ReadLayersOfArchive* read_archive = nullptr;

    /// If such a file is read as a mesh: the kind of file, and advice, as the end of a sentence that begins
    /// with the name of the file. Only formats with an extension have it, and none that also holds meshes.
    std::string_view advice = {};
};

/// Returns all formats, in the order in which help lists them. Of those that recognise a file, the last one
/// applies.
[[nodiscard]] std::span<const SliceFormat> slice_formats() noexcept;

/// Returns the format of an archive that holds layers, or may hold them, by the names of its entries; null
/// for other archives.
[[nodiscard]] const SliceFormat* slice_format_of(const ZipReader& archive);
/// Returns the format of a slice file that is not an archive, by its content; null for other files.
[[nodiscard]] const SliceFormat* slice_format_of(std::string_view bytes);

} // namespace lamella
