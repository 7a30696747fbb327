#pragma once

// The formats of slice files, each in a source of its name; docs/formats.md tells what they hold. Each has a
// function that tells it by its content, and one that reads it: that throws Error{input} which names the
// byte, the line, or the file within an archive and the place there.

#include "lamella/core/error.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"

#include "container/zip_reader.hpp"
#include "core/byte_source.hpp"

#include <string>
#include <string_view>

namespace lamella {

class ReadLimits;

/// That an archive holds no layers, or none that can be placed: its meshes may be what is meant.
struct NoLayers : Error {
    explicit NoLayers(const std::string& text) : Error(ErrorKind::input, text) {}
};

/// Reads what has been opened, and unpacked where gzip had packed it, by the contract of read_layers.
[[nodiscard]] LayerFile read_unpacked_layers(const ByteSource& source, const LayerReadOptions& options,
                                             const Execution& execution);

/// Common Layer Interface 2.0, ASCII and binary. Comments may come before its header.
[[nodiscard]] bool is_common_layer(std::string_view bytes);
[[nodiscard]] LayerFile read_common_layer(std::string_view bytes, const std::string& name, ReadLimits& limits,
                                          const Execution& execution);

/// ILT: Common Layer Interface files in a zip archive, with the list of their parameters, which tells it from
/// other archives.
[[nodiscard]] bool is_ilt(const ZipReader& zip);
[[nodiscard]] LayerFile read_ilt(const ZipReader& zip, ReadLimits& limits, const Execution& execution);

/// Layered SVG as Slic3r writes it; whether an SVG document has layers shows when it is read.
[[nodiscard]] bool is_svg(std::string_view bytes);
[[nodiscard]] LayerFile read_layered_svg(std::string_view bytes, const std::string& name, ReadLimits& limits,
                                         const Execution& execution);

/// Our own JSON of layers; whether a JSON document has layers shows when it is read.
[[nodiscard]] bool is_json(std::string_view bytes);
[[nodiscard]] LayerFile read_layers_json(std::string_view bytes, const std::string& name, ReadLimits& limits,
                                         const Execution& execution);

/// Our own NumPy arrays in a zip archive, one of which all such archives have.
[[nodiscard]] bool is_npz(const ZipReader& zip);
[[nodiscard]] LayerFile read_npz(const ZipReader& zip, ReadLimits& limits, const Execution& execution);

/// Open Vector Format.
[[nodiscard]] bool is_ovf(std::string_view bytes);
[[nodiscard]] LayerFile read_ovf(std::string_view bytes, const std::string& name, ReadLimits& limits,
                                 const Execution& execution);

/// SLC 2.0 of 3D Systems.
[[nodiscard]] bool is_slc(std::string_view bytes);
[[nodiscard]] LayerFile read_slc(std::string_view bytes, const std::string& name, ReadLimits& limits,
                                 const Execution& execution);
/// The other format called SLC that a file is of, in words for an error; "" if it is of none.
[[nodiscard]] std::string_view other_slc(std::string_view bytes);

/// 3MF with slice stacks (3MF Slice Extension); whether a package has slices shows when it is read.
[[nodiscard]] bool is_3mf(const ZipReader& zip);
[[nodiscard]] LayerFile read_slices_3mf(const ZipReader& package, ReadLimits& limits,
                                        const Execution& execution);

/// 3MF with toolpaths (3MF Toolpath Extension 1.0): its model refers to layers of them.
[[nodiscard]] bool is_toolpath_3mf(const ZipReader& package);
[[nodiscard]] LayerFile read_toolpath_3mf(const ZipReader& package, ReadLimits& limits,
                                          const Execution& execution);

} // namespace lamella
