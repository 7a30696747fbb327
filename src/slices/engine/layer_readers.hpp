#pragma once

// The readers of slice files. Each format has a source; docs/formats.md describes the formats.
// Each has a function that recognises it by its content, and one that reads it. The latter throws
// Error{input} with the offset, the line, or the file within an archive and the position there.

#include "lamella/core/error.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/slices/layer_file.hpp"

#include "container/zip_reader.hpp"
#include "system/byte_source.hpp"

#include <string>
#include <string_view>

namespace lamella {

class ReadLimits;

/// Thrown if an archive has no layers, or if no build item places any; the caller may then read its meshes.
struct NoLayers : Error {
    explicit NoLayers(const std::string& text) : Error(ErrorKind::input, text) {}
};

/// Reads the layers of a file that is not an archive. The bytes must live as long as the planes of the
/// result.
using ReadLayers = LayerFile(std::string_view bytes, const std::string& name, ReadLimits& limits,
                             const Execution& execution);
/// Reads the layers of an archive, which must live as long as the stream of the result.
using ReadLayersOfArchive = LayerFile(const ZipReader& archive, ReadLimits& limits,
                                      const Execution& execution);

/// Common Layer Interface 2.0, ASCII and binary. Comments may precede the header.
[[nodiscard]] bool is_common_layer(std::string_view bytes);
ReadLayers read_common_layer;

/// ILT: Common Layer Interface files in a zip archive with a list of their parameters, by which it is
/// recognised.
[[nodiscard]] bool is_ilt(const ZipReader& zip);
ReadLayersOfArchive read_ilt;

/// Layered SVG as written by Slic3r. Reading decides whether an SVG document has layers.
[[nodiscard]] bool is_svg(std::string_view bytes);
ReadLayers read_layered_svg;

/// Lamella's JSON of layers. Reading decides whether a JSON document has layers.
[[nodiscard]] bool is_json(std::string_view bytes);
ReadLayers read_layers_json;

/// Lamella's NumPy arrays in a zip archive, recognised by an array that all such archives have.
[[nodiscard]] bool is_npz(const ZipReader& zip);
ReadLayersOfArchive read_npz;

/// Open Vector Format.
[[nodiscard]] bool is_ovf(std::string_view bytes);
ReadLayers read_ovf;

/// SLC 2.0 of 3D Systems.
[[nodiscard]] bool is_slc(std::string_view bytes);
ReadLayers read_slc;
/// Returns, for an error, the name of the format if the file has another format that is also called SLC;
/// otherwise "".
[[nodiscard]] std::string_view other_slc(std::string_view bytes);

/// 3MF with slice stacks (3MF Slice Extension). Reading decides whether a package has slices.
[[nodiscard]] bool is_3mf(const ZipReader& zip);
ReadLayersOfArchive read_slices_3mf;

/// 3MF with toolpaths (3MF Toolpath Extension 1.0), recognised by a model that refers to toolpath layers.
[[nodiscard]] bool is_toolpath_3mf(const ZipReader& package);
ReadLayersOfArchive read_toolpath_3mf;

/// Elegoo's .goo and Phrozen's .prz, version 3.0.
[[nodiscard]] bool is_goo(std::string_view bytes);
ReadLayers read_goo;
/// Chitubox's .ctb, versions 1 to 5; encrypted files are recognised and refused.
[[nodiscard]] bool is_ctb(std::string_view bytes);
ReadLayers read_ctb;
/// Chitubox's .cbddlp and .photon, versions 1 and 2.
[[nodiscard]] bool is_cbddlp(std::string_view bytes);
ReadLayers read_cbddlp;
/// Anycubic's container of Photon Workshop, versions 1 and 515 to 518.
[[nodiscard]] bool is_anycubic(std::string_view bytes);
ReadLayers read_anycubic;
/// Zip archives of images: those of `png-zip`, of Prusa's SL1 and SL1S, of Chitubox, and of NanoDLP. Each is
/// recognised by the names of its files.
[[nodiscard]] bool is_image_archive(const ZipReader& archive);
ReadLayersOfArchive read_image_archive;
[[nodiscard]] bool is_sl1(const ZipReader& archive);
ReadLayersOfArchive read_sl1;
[[nodiscard]] bool is_chitubox_zip(const ZipReader& archive);
ReadLayersOfArchive read_chitubox_zip;
[[nodiscard]] bool is_nanodlp(const ZipReader& archive);
ReadLayersOfArchive read_nanodlp;

} // namespace lamella
