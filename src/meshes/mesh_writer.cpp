#include "lamella/meshes/mesh_writer.hpp"

#include "lamella/core/error.hpp"

#include "container/byte_buffer.hpp"
#include "container/checked_output.hpp"
#include "container/decimal.hpp"
#include "mesh/measures.hpp"
#include "mesh/triangle_contact.hpp"
#include "system/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <string_view>
#include <type_traits>
#include <utility>

namespace lamella {

namespace {

constexpr std::size_t triangles_per_block = 20'000;
constexpr std::size_t record_size = 50;

struct Facet {
    Point3f normal;
    Triangle3f corners;
};
static_assert(sizeof(Facet) == 48, "written as memory has it");

float single(double v, std::uint64_t triangle, const std::string& path) {
    if (!(std::abs(v) <= std::numeric_limits<float>::max()))
        throw Error(ErrorKind::output,
                    fmt::format("{}: triangle {} has a coordinate of {:g} mm, which the single precision of "
                                "STL cannot hold; write it as .ply or .obj",
                                path, triangle, v));
    return static_cast<float>(v) + 0.0F;
}

Triangle3f rounded(const Triangle3& triangle, std::uint64_t number, const std::string& path) {
    Triangle3f corners;
    for (std::size_t k = 0; k < 3; ++k)
        corners[k] = {single(triangle[k].x, number, path), single(triangle[k].y, number, path),
                      single(triangle[k].z, number, path)};
    return corners;
}

// Returns the unit normal of the corners as they are stored; zero for a triangle without area.
Point3f unit_normal(const Triangle3f& t) {
    const auto corner = [&](int i) {
        return Point3{t[i].x, t[i].y, t[i].z};
    };
    const Point3 n = normal({corner(0), corner(1), corner(2)});
    const double length = distance(n, {});
    if (!(length > 0) || !std::isfinite(length))
        return {};
    return {static_cast<float>(n.x / length) + 0.0F, static_cast<float>(n.y / length) + 0.0F,
            static_cast<float>(n.z / length) + 0.0F};
}

/// Returns facet i. Error messages number the triangles of the file; `before` is the number of triangles of
/// the file before this soup.
Facet facet(const TriangleSoup& soup, std::size_t i, std::uint64_t before, const std::string& path) {
    Facet f;
    f.corners = soup.has_placement() ? rounded(soup.placed(i), before + i, path) : soup.stored(i);
    f.normal = unit_normal(f.corners);
    return f;
}

std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
    return text;
}

bool fits_single_precision(const IndexedMesh& mesh) {
    const auto fits = [](double v) {
        return static_cast<double>(static_cast<float>(v)) == v;
    };
    return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                       [&](const Point3& p) { return fits(p.x) && fits(p.y) && fits(p.z); });
}

/// Appends items in chunks. `put_item(at, i)` writes an item of at most `longest` bytes and returns its end.
template <class Put>
void append_blocks(AtomicFile& file, std::size_t count, std::size_t longest, Put put_item) {
    ByteBuffer block;
    for (std::size_t begin = 0; begin < count; begin += triangles_per_block) {
        const std::size_t end = std::min(count, begin + triangles_per_block);
        block.clear();
        char* at = block.room((end - begin) * longest);
        for (std::size_t i = begin; i < end; ++i)
            at = put_item(at, i);
        block.end_at(at);
        file.append(block.view());
    }
}

/// Writes the rest of a line: a space before each number, which is the shortest text that reads back to it.
template <class Number>
char* put_rest_of_line(char* out, const std::array<Number, 3>& numbers) {
    for (const Number number : numbers) {
        *out++ = ' ';
        if constexpr (std::is_floating_point_v<Number>)
            out = put_shortest(out, number);
        else
            out = put_integer(out, std::uint64_t{number});
    }
    *out++ = '\n';
    return out;
}

Triangle3 widened(const Triangle3f& corners) {
    Triangle3 triangle;
    for (std::size_t k = 0; k < 3; ++k)
        triangle[k] = {corners[k].x, corners[k].y, corners[k].z};
    return triangle;
}

template <class Point>
auto coordinates(const Point& p) {
    return std::array{p.x, p.y, p.z};
}

} // namespace

StlWriter::StlWriter(const std::string& path, std::uint64_t triangles, std::string* memory)
    : announced_(triangles) {
    if (triangles > std::numeric_limits<std::uint32_t>::max())
        throw Error(
            ErrorKind::limit,
            fmt::format("{} triangles are more than a binary STL file can count (2^32 - 1)", triangles));
    file_ = std::make_unique<AtomicFile>(path, Overwriting::no, memory);
    std::array<char, 84> header{};
    // The text must not begin with "solid", because readers would take the file for ASCII STL.
    put_text(header.data(), "Binary STL written by Lamella, millimetres");
    const auto count = static_cast<std::uint32_t>(triangles);
    std::memcpy(header.data() + 80, &count, sizeof count);
    file_->append({header.data(), header.size()});
}

StlWriter::~StlWriter() = default;

void StlWriter::append(const TriangleSoup& soup) {
    append_blocks(*file_, soup.size(), record_size, [&](char* at, std::size_t i) {
        std::memset(put_value(at, facet(soup, i, written_, file_->path())), 0, record_size - sizeof(Facet));
        return at + record_size;
    });
    written_ += soup.size();
}

void StlWriter::finish() {
    if (written_ != announced_)
        throw Error(ErrorKind::usage,
                    fmt::format("{} triangles were announced and {} were written", announced_, written_));
    file_->commit();
}

void write_stl(const std::string& path, const TriangleSoup& soup) {
    StlWriter writer(path, soup.size());
    writer.append(soup);
    writer.finish();
}

std::vector<std::string> write_stl(const std::string& path, const Mesh& mesh, bool strict,
                                   std::string* memory) {
    StlWriter writer(path, mesh.size(), memory);
    if (const TriangleSoup* const soup = mesh.soup(); soup != nullptr && !soup->has_placement()) {
        writer.append(*soup);
        writer.finish();
        return {};
    }
    std::uint64_t lost = 0;
    for (std::size_t begin = 0; begin < mesh.size(); begin += triangles_per_block) {
        std::vector<Triangle3f> triangles(std::min(triangles_per_block, mesh.size() - begin));
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            const Triangle3 before = mesh.triangle(begin + i);
            triangles[i] = rounded(before, begin + i, path);
            lost += !flat(before) && flat(widened(triangles[i])) ? 1 : 0;
        }
        writer.append(TriangleSoup(std::move(triangles)));
    }
    Findings findings;
    if (lost > 0)
        findings.add({.kind = FindingKind::flattened_triangles, .count = lost});
    if (strict)
        check_strictly(path, findings);
    writer.finish();
    return findings.texts();
}

void write_stl_ascii(const std::string& path, const TriangleSoup& soup, const std::string& name) {
    const std::string title = one_line(name);
    AtomicFile file(path);
    file.append("solid " + title + "\n");
    constexpr std::size_t longest_facet = 400;
    append_blocks(file, soup.size(), longest_facet, [&](char* at, std::size_t i) {
        const Facet f = facet(soup, i, 0, path);
        at = put_rest_of_line(put_text(at, "facet normal"), coordinates(f.normal));
        at = put_text(at, "  outer loop\n");
        for (const Point3f& corner : f.corners)
            at = put_rest_of_line(put_text(at, "    vertex"), coordinates(corner));
        return put_text(at, "  endloop\nendfacet\n");
    });
    file.append("endsolid " + title + "\n");
    file.commit();
}

void write_ply(const std::string& path, const IndexedMesh& mesh, std::string* memory) {
    static_assert(std::endian::native == std::endian::little, "written as memory has it");
    const bool single_precision = fits_single_precision(mesh);
    const std::string_view type = single_precision ? "float" : "double";
    AtomicFile file(path, Overwriting::no, memory);
    file.append(fmt::format("ply\nformat binary_little_endian 1.0\ncomment written by Lamella, millimetres\n"
                            "element vertex {0}\nproperty {1} x\nproperty {1} y\nproperty {1} z\n"
                            "element face {2}\nproperty list uchar uint vertex_indices\nend_header\n",
                            mesh.vertices.size(), type, mesh.triangles.size()));
    append_blocks(file, mesh.vertices.size(), sizeof(Point3), [&](char* at, std::size_t i) {
        for (const double v : coordinates(mesh.vertices[i]))
            at = single_precision ? put_value(at, static_cast<float>(v)) : put_value(at, v);
        return at;
    });
    constexpr std::size_t face_bytes = 1 + 3 * sizeof(std::uint32_t);
    append_blocks(file, mesh.triangles.size(), face_bytes, [&](char* at, std::size_t i) {
        return put_value(put_value(at, std::uint8_t{3}), mesh.triangles[i]);
    });
    file.commit();
}

void write_obj(const std::string& path, const IndexedMesh& mesh, const std::string& name,
               std::string* memory) {
    AtomicFile file(path, Overwriting::no, memory);
    std::string line = one_line(name);
    std::replace(line.begin(), line.end(), '\\', '/'); // a backslash at the end would continue the line
    file.append(fmt::format("# written by Lamella, millimetres\no {}\n", line));
    constexpr std::size_t longest_line = 80;
    append_blocks(file, mesh.vertices.size(), longest_line, [&](char* at, std::size_t i) {
        return put_rest_of_line(put_text(at, "v"), coordinates(mesh.vertices[i]));
    });
    append_blocks(file, mesh.triangles.size(), longest_line, [&](char* at, std::size_t i) {
        const auto& [a, b, c] = mesh.triangles[i]; // indices count from 1 in this format
        return put_rest_of_line(put_text(at, "f"), std::array{a + 1ULL, b + 1ULL, c + 1ULL});
    });
    file.commit();
}

} // namespace lamella
