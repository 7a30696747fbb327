#pragma once

// The readers of mesh files. Each format has a source of its name, with a function that recognises the format
// by its content, and one that reads it, by the contract of read_mesh.

#include "lamella/core/execution.hpp"
#include "lamella/meshes/mesh_file.hpp"

#include "system/byte_source.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace lamella {

using ReadMesh = MeshFile(const ByteSource& source, const MeshReadOptions& options,
                          const Execution& execution);

/// Returns whether this is STL with certainty: rules 1 and 2 of read_stl.
[[nodiscard]] bool is_stl(const ByteSource& source);
/// Returns whether a file of `size` bytes with this beginning is binary STL, unless it has the signature of
/// another format. Such a file can be read in windows.
[[nodiscard]] bool is_likely_stl_binary(std::span<const std::byte> beginning, std::uint64_t size);
/// STL of either form. The content decides, because many binary files begin with "solid" as the ASCII form
/// does:
/// 1. a size of exactly 84 + 50 * count bytes: binary;
/// 2. "solid", a name, and then a facet or "endsolid": ASCII;
/// 3. other text: an error that shows it;
/// 4. at least 84 bytes: binary with a wrong count, or, if the bytes that each triangle counts as its
///    attributes really follow it and then fill the file, binary with these bytes.
/// Binary files in big-endian order and with implausible coordinates are refused.
ReadMesh read_stl;
/// Returns whether the triangles of a file have the usual distance in it, or are text.
[[nodiscard]] bool can_stream_stl(const ByteSource& source);
/// Returns the number of records of a binary file, according to its header and its length; nullopt for an
/// ASCII file. The form is recognised by the same rules.
[[nodiscard]] std::optional<std::uint64_t> stl_records(const ByteSource& source);
/// Passes the triangles of either form to the sink; see MeshInput::stream.
[[nodiscard]] MeshFile stream_stl(const ByteSource& source, const TriangleSink& sink,
                                  const MeshReadOptions& options, const Execution& execution,
                                  const std::optional<RecordRange>& share);

/// AMF (ISO/ASTM 52915): objects as meshes in XML, plain or in a zip archive, and constellations of them.
[[nodiscard]] bool is_amf(std::string_view text);
/// Number of bytes within which the root element must begin for a text to be recognised.
inline constexpr std::size_t amf_root_within = std::size_t{1} << 16;
/// Reads AMF. The volumes of an object become one mesh; volumes of type support are read only if the options
/// include them. Objects that no constellation places keep their coordinates. Edges and normals, which bend
/// triangles, are skipped with a warning. Angles are in degrees, except in files of Slic3r and its
/// descendants, which have radians, and also the elements scale, mirror and printable.
ReadMesh read_amf;

/// 3MF: a package of model parts with meshes, assemblies of them, and a build that places objects. Each mesh
/// that the build uses is one object; each path from the build to it is one instance. Skipped with a warning:
/// objects of type surface, which are not solids; objects of type support, unless the options include them;
/// and items that are not to be printed.
ReadMesh read_three_mf;
/// Does the same for a package none of whose model parts mentions slices; otherwise returns nullopt as soon
/// as such a part is unpacked. So a package of meshes is unpacked only once.
[[nodiscard]] std::optional<MeshFile> read_three_mf_without_slices(const ByteSource& source,
                                                                   const MeshReadOptions& options,
                                                                   const Execution& execution);

/// PLY, also called the Stanford format: the line "ply", a header that describes rows, and the rows, as text
/// or binary.
[[nodiscard]] bool is_ply(std::string_view text);
/// Reads x, y and z of the element "vertex" and the list "vertex_indices" or "vertex_index" of the element
/// "face", in any order and of any type; skips all others.
ReadMesh read_ply;

/// OFF, the format of Geomview: the word OFF or a similar one (COFF, STNOFF, 4OFF, nOFF...), three counts,
/// then one vertex or face per line.
///
///     OFF
///     3 1 0
///     0 0 0
///     1 0 0
///     0 1 0
///     3 0 1 2
[[nodiscard]] bool is_off(std::string_view text);
/// Reads OFF with or without its first word. Colours, normals and texture coordinates are skipped;
/// homogeneous coordinates (4OFF) are divided. Comments (#) are separate lines.
ReadMesh read_off;

/// Wavefront OBJ: lines of words.
///
///     v 0 0 0
///     v 1 0 0
///     v 0 1 0
///     f 1 2 3
///
/// OBJ has no signature. The first line that is not a comment must therefore be one with which OBJ files
/// usually begin.
[[nodiscard]] bool looks_like_obj(std::string_view text);
/// Reads OBJ. Faces may have any number of corners, each V, V/VT, V//VN or V/VT/VN. These are indices of
/// lines of the kinds v, vt and vn, counted from 1, or backwards from -1. Only V is used. All groups and
/// objects are joined; texture, normals, materials, points and lines are skipped. Runs in parallel, with the
/// same result and errors as a sequential parser.
ReadMesh read_obj;

} // namespace lamella
