#include "lamella/core/error.hpp"

#include "read/coordinate_text.hpp"
#include "read/face_rows.hpp"
#include "read/mesh_readers.hpp"
#include "read/ply_binary.hpp"
#include "read/ply_header.hpp"
#include "read/read_limits.hpp"
#include "read/remarks.hpp"
#include "read/text_pieces.hpp"

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

PlyPlaces find_places(const PlyHeader& header, const std::string& file) {
    const auto fail = [&](std::string_view what) {
        throw Error(ErrorKind::input, fmt::format("{}: {}", file, what));
    };
    PlyPlaces places;
    places.vertex = find_element(header, "vertex");
    if (places.vertex == header.elements.size())
        fail("the head has no 'element vertex', expected one with the properties x, y and z");
    const PlyElement& vertex = header.elements[places.vertex];
    constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = vertex.find(axes[axis]);
        if (!at || vertex.properties[*at].list_length)
            fail(fmt::format("the head has no 'property float {}' of the element 'vertex'", axes[axis]));
        places.coordinates[axis] = *at;
    }
    places.face = find_element(header, "face");
    if (places.face == header.elements.size() || header.elements[places.face].rows == 0) {
        places.face = find_element(header, "tristrips");
        places.strips = true;
    }
    if (places.face == header.elements.size() || header.elements[places.face].rows == 0)
        fail(fmt::format("holds no triangle: {} vertices without an element 'face' (a cloud of points has no "
                         "surface to slice)",
                         vertex.rows));
    const PlyElement& face = header.elements[places.face];
    const std::string_view what = places.strips
                                      ? "property list int int vertex_indices' of the element 'tristrips"
                                      : "property list uchar int vertex_indices' of the element 'face";
    for (const std::string_view name : {"vertex_indices", "vertex_index"})
        if (const auto at = face.find(name); at && face.properties[*at].list_length) {
            places.corners = *at;
            return places;
        }
    fail(fmt::format("the head has no '{}'", what));
    return places;
}

void skip_value(const PlyProperty& property, RowWords& words) {
    if (property.list_length)
        words.skip_list();
    else
        words.skip_word();
}

void read_vertex(const PlyElement& element, const PlyPlaces& places, RowWords& words, FacePiece& piece) {
    std::array<double, 3> p{};
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const auto* const axis = std::find(places.coordinates.begin(), places.coordinates.end(), i);
        if (axis != places.coordinates.end())
            p[static_cast<std::size_t>(axis - places.coordinates.begin())] = words.coordinate();
        else
            skip_value(element.properties[i], words);
    }
    piece.vertices.push_back({p[0], p[1], p[2]});
}

void read_face(const PlyElement& element, const PlyPlaces& places, RowWords& words, FacePiece& piece) {
    for (std::size_t i = 0; i < element.properties.size(); ++i)
        if (i != places.corners)
            skip_value(element.properties[i], words);
        else if (places.strips)
            words.add_strips(piece);
        else
            words.add_face(piece);
}

struct Rows {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;

    [[nodiscard]] bool hold(std::uint64_t row) const { return row >= begin && row < end; }
};

/// Returns the rows of each element. An element without properties has no words, and so no rows.
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

MeshFile read_ascii(const ByteSource& source, const PlyHeader& header, const PlyPlaces& places,
                    Remarks& remarks, ReadLimits& limits, const Execution& execution) {
    const std::vector<Rows> element_rows = rows_of(header);
    const Rows vertex_rows = element_rows[places.vertex];
    const Rows face_rows = element_rows[places.face];
    const PlyElement& vertex = header.elements[places.vertex];
    const PlyElement& face = header.elements[places.face];
    FaceRows rows;
    rows.begin = header.end;
    rows.rows = std::max(vertex_rows.end, face_rows.end);
    rows.more_rows = element_rows.back().end - rows.rows;
    rows.any_lines = true;
    rows.counted_where = "the head";
    rows.read_row = [&](std::uint64_t row, RowWords& words, FacePiece& piece) {
        if (vertex_rows.hold(row)) {
            read_vertex(vertex, places, words, piece);
        } else if (face_rows.hold(row)) {
            read_face(face, places, words, piece);
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
    const PlyPlaces places = find_places(header, source.name);
    MeshFile file = header.form == PlyForm::ascii
                        ? read_ascii(source, header, places, remarks, limits, execution)
                        : read_ply_binary(source, header, places, remarks, limits, execution);
    file.warnings = remarks.take();
    return file;
}

} // namespace lamella
