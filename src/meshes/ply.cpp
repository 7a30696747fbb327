#include "lamella/core/error.hpp"

#include "container/coordinate_text.hpp"
#include "container/read_limits.hpp"
#include "container/text_chunks.hpp"
#include "meshes/face_rows.hpp"
#include "meshes/mesh_readers.hpp"
#include "meshes/ply_binary.hpp"
#include "meshes/ply_header.hpp"
#include "meshes/remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

namespace lamella {

namespace {

std::size_t find_element(const PlyHeader& header, std::string_view name) {
    return static_cast<std::size_t>(std::find_if(header.elements.begin(), header.elements.end(),
                                                 [&](const PlyElement& one) { return one.name == name; }) -
                                    header.elements.begin());
}

PlyPositions find_positions(const PlyHeader& header, const std::string& file) {
    const auto fail = [&](std::string_view what) {
        throw Error(ErrorKind::input, fmt::format("{}: {}", file, what));
    };
    PlyPositions positions;
    positions.vertex = find_element(header, "vertex");
    if (positions.vertex == header.elements.size())
        fail("the header has no 'element vertex', expected one with the properties x, y and z");
    const PlyElement& vertex = header.elements[positions.vertex];
    constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = vertex.find(axes[axis]);
        if (!at || vertex.properties[*at].list_length)
            fail(fmt::format("the header has no 'property float {}' of the element 'vertex'", axes[axis]));
        positions.coordinates[axis] = *at;
    }
    positions.face = find_element(header, "face");
    if (positions.face == header.elements.size() || header.elements[positions.face].rows == 0) {
        positions.face = find_element(header, "tristrips");
        positions.strips = true;
    }
    if (positions.face == header.elements.size() || header.elements[positions.face].rows == 0)
        fail(fmt::format("holds no triangle: {} vertices without an element 'face' (a cloud of points has no "
                         "surface to slice)",
                         vertex.rows));
    const PlyElement& face = header.elements[positions.face];
    const std::string_view what = positions.strips
                                      ? "property list int int vertex_indices' of the element 'tristrips"
                                      : "property list uchar int vertex_indices' of the element 'face";
    for (const std::string_view name : {"vertex_indices", "vertex_index"})
        if (const auto at = face.find(name); at && face.properties[*at].list_length) {
            positions.corners = *at;
            return positions;
        }
    fail(fmt::format("the header has no '{}'", what));
    return positions;
}

void skip_value(const PlyProperty& property, RowWords& words) {
    if (property.list_length)
        words.skip_list();
    else
        words.skip_word();
}

void read_vertex(const PlyElement& element, const PlyPositions& positions, RowWords& words,
                 FaceChunk& chunk) {
    std::array<double, 3> p{};
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const auto* const axis = std::find(positions.coordinates.begin(), positions.coordinates.end(), i);
        if (axis != positions.coordinates.end())
            p[static_cast<std::size_t>(axis - positions.coordinates.begin())] = words.coordinate();
        else
            skip_value(element.properties[i], words);
    }
    chunk.vertices.push_back({p[0], p[1], p[2]});
}

void read_face(const PlyElement& element, const PlyPositions& positions, RowWords& words, FaceChunk& chunk) {
    for (std::size_t i = 0; i < element.properties.size(); ++i)
        if (i != positions.corners)
            skip_value(element.properties[i], words);
        else if (positions.strips)
            words.add_strips(chunk);
        else
            words.add_face(chunk);
}

struct Rows {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;

    [[nodiscard]] bool hold(std::uint64_t row) const { return row >= begin && row < end; }
};

/// Returns the rows of each element. An element without properties has no rows, because its rows would have
/// no words.
std::vector<Rows> rows_of(const PlyHeader& header) {
    std::vector<Rows> rows;
    std::uint64_t begin = 0;
    for (const PlyElement& element : header.elements) {
        const std::uint64_t most = std::numeric_limits<std::uint64_t>::max() - begin;
        const std::uint64_t end = begin + (element.properties.empty() ? 0 : std::min(element.rows, most));
        rows.push_back({begin, end});
        begin = end;
    }
    return rows;
}

MeshFile read_ascii(const ByteSource& source, const PlyHeader& header, const PlyPositions& positions,
                    Remarks& remarks, ReadLimits& limits, const Execution& execution) {
    const std::vector<Rows> element_rows = rows_of(header);
    const Rows vertex_rows = element_rows[positions.vertex];
    const Rows face_rows = element_rows[positions.face];
    const PlyElement& vertex = header.elements[positions.vertex];
    const PlyElement& face = header.elements[positions.face];
    FaceRows rows;
    rows.begin = header.end;
    rows.rows = std::max(vertex_rows.end, face_rows.end);
    rows.more_rows = element_rows.back().end - rows.rows;
    rows.any_lines = true;
    rows.counted_where = "the head";
    rows.read_row = [&](std::uint64_t row, RowWords& words, FaceChunk& chunk) {
        if (vertex_rows.hold(row)) {
            read_vertex(vertex, positions, words, chunk);
        } else if (face_rows.hold(row)) {
            read_face(face, positions, words, chunk);
        } else {
            const auto other = std::upper_bound(element_rows.begin(), element_rows.end(), row,
                                                [](auto value, const Rows& one) { return value < one.end; });
            for (const PlyProperty& property : header.elements[other - element_rows.begin()].properties)
                skip_value(property, words);
        }
    };
    return read_face_rows(source, rows, remarks, limits, execution);
}

} // namespace

bool is_ply(std::string_view text) {
    text.remove_prefix(after_byte_order_mark(text));
    return text.starts_with("ply") && text.size() > 3 && is_blank(text[3]);
}

MeshFile read_ply(const ByteSource& source, const MeshReadOptions& options, const Execution& execution) {
    Remarks remarks(source.name, options.strict);
    ReadLimits limits(source, options);
    const PlyHeader header = read_ply_header(source, remarks);
    const PlyPositions positions = find_positions(header, source.name);
    MeshFile file = header.form == PlyForm::ascii
                        ? read_ascii(source, header, positions, remarks, limits, execution)
                        : read_ply_binary(source, header, positions, remarks, limits, execution);
    file.warnings = remarks.take();
    return file;
}

} // namespace lamella
