#pragma once

// The formats of mesh files, each in a source of its name. Each has a function that tells it by its content,
// and one that reads it, by the contract of read_mesh.

#include "lamella/core/execution.hpp"
#include "lamella/read/mesh_file.hpp"
#include "lamella/read/mesh_input.hpp"

#include "core/byte_source.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace lamella {

using ReadMesh = MeshFile(const ByteSource& source, const MeshReadOptions& options,
                          const Execution& execution);

/// STL beyond doubt: rules 1 and 2 of read_stl.
[[nodiscard]] bool is_stl(const ByteSource& source);
/// Whether a file of `size` bytes that begins like this is a binary STL file, unless it is of a format that
/// has a signature. It can be read in windows.
[[nodiscard]] bool is_likely_stl_binary(std::span<const std::byte> beginning, std::uint64_t size);
/// STL of either form. The content decides, because many binary files begin with "solid" as the ASCII form
/// does:
///   1. a size of exactly 84 + 50 * count bytes: binary;
///   2. "solid", a name, and then a facet or "endsolid": ASCII;
///   3. other text: an error that says what was found;
///   4. at least 84 bytes: binary with a wrong count.
ReadMesh read_stl;
/// By the same rules: how many records a binary file holds, as far as its head and its length tell; nothing
/// for an ASCII file.
[[nodiscard]] std::optional<std::uint64_t> stl_records(const ByteSource& source);
/// Hands the triangles of either form to the sink; see MeshInput::stream.
[[nodiscard]] MeshFile stream_stl(const ByteSource& source, const TriangleSink& sink,
                                  const MeshReadOptions& options, const Execution& execution,
                                  const std::optional<RecordRange>& share);

/// AMF (ISO/ASTM 52915): objects as meshes in XML, plain or in a zip archive, and constellations of them.
[[nodiscard]] bool is_amf(std::string_view text);
/// Nothing behind these bytes tells whether a text is one.
inline constexpr std::size_t amf_mark_within = std::size_t{1} << 16;
/// The volumes of an object make one mesh, those of type support only where the options ask for them. Objects
/// that no constellation places stand where they are. Edges and normals, which bend triangles, are passed
/// over with a warning. Angles are degrees, but radians in the files of Slic3r and its descendants, which
/// also know scale, mirror and printable.
ReadMesh read_amf;

/// 3MF: a package of model parts, with meshes, assemblies of them, and a build that says what is made where.
/// Each mesh of the file that the build uses is one object, each way to it from the build one instance. Of
/// objects of the type surface, which are no solids, nothing is read, nor of those of the type support,
/// unless the options ask for them, nor of items that are not to be printed: a warning says so.
ReadMesh read_three_mf;

/// PLY, also called the Stanford format: the line "ply", a head that describes rows, and the rows, as text or
/// binary.
[[nodiscard]] bool is_ply(std::string_view text);
/// Takes x, y and z of the element "vertex" and the list "vertex_indices" or "vertex_index" of the element
/// "face", wherever they stand and of whatever type; all else is skipped.
ReadMesh read_ply;

/// OFF, the format of Geomview: the word OFF or one like it (COFF, STNOFF, 4OFF, nOFF...), three counts,
/// vertices and faces, one on each line.
///
///     OFF
///     3 1 0
///     0 0 0
///     1 0 0
///     0 1 0
///     3 0 1 2
[[nodiscard]] bool is_off(std::string_view text);
/// With or without its first word. Colours, normals and texture coordinates are skipped, homogeneous
/// coordinates (4OFF) divided out. Comments (#) are lines of their own.
ReadMesh read_off;

/// Wavefront OBJ: lines of words.
///
///     v 0 0 0
///     v 1 0 0
///     v 0 1 0
///     f 1 2 3
///
/// It has no mark of its own, so the first line that is no comment must be one that OBJ files begin with.
[[nodiscard]] bool looks_like_obj(std::string_view text);
/// Faces may have any number of corners, each V, V/VT, V//VN or V/VT/VN: numbers of lines of those kinds from
/// 1 on, or backwards from -1. Only V is looked at. All groups and objects are taken together; texture,
/// normals, materials, points and lines are skipped. In parallel, with the same result, errors included, as
/// from front to back.
ReadMesh read_obj;

} // namespace lamella
