#include "lamella/write/mesh_writer.hpp"

#include "lamella/core/error.hpp"

#include "container/atomic_file.hpp"
#include "write/byte_buffer.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace lamella {

namespace {

constexpr std::size_t triangles_per_block = 20'000;
constexpr std::size_t record_size = 50;

struct Facet {
    Point3f normal;
    Triangle3f corners;
};
static_assert(sizeof(Facet) == 48, "written as memory has it");

float single(double v, std::size_t triangle) {
    if (!(std::abs(v) <= std::numeric_limits<float>::max()))
        throw Error(ErrorKind::usage,
                    fmt::format("triangle {} has a coordinate of {:g} mm, which single precision cannot hold",
                                triangle, v));
    return static_cast<float>(v) + 0.0F;
}

// The unit normal of the corners as they are stored; zero for a triangle without area.
Point3f unit_normal(const Triangle3f& t) {
    const auto edge = [&](int i) {
        return Point3{double{t[i].x} - double{t[0].x}, double{t[i].y} - double{t[0].y},
                      double{t[i].z} - double{t[0].z}};
    };
    const Point3 a = edge(1);
    const Point3 b = edge(2);
    const Point3 n{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    const double length = std::hypot(n.x, n.y, n.z);
    if (!(length > 0) || !std::isfinite(length))
        return {};
    return {static_cast<float>(n.x / length) + 0.0F, static_cast<float>(n.y / length) + 0.0F,
            static_cast<float>(n.z / length) + 0.0F};
}

Facet facet(const TriangleSoup& soup, std::size_t i) {
    Facet f;
    if (soup.has_placement()) {
        const Triangle3 placed = soup.placed(i);
        for (std::size_t c = 0; c < 3; ++c)
            f.corners[c] = {single(placed[c].x, i), single(placed[c].y, i), single(placed[c].z, i)};
    } else {
        f.corners = soup.stored(i);
    }
    f.normal = unit_normal(f.corners);
    return f;
}

char* put(char* out, std::string_view text) {
    std::memcpy(out, text.data(), text.size());
    return out + text.size();
}

char* put(char* out, const Point3f& p) {
    constexpr std::size_t longest_float = 16;
    for (const float v : {p.x, p.y, p.z}) {
        *out++ = ' ';
        out = std::to_chars(out, out + longest_float, v).ptr;
    }
    *out++ = '\n';
    return out;
}

} // namespace

void write_stl(const std::string& path, const TriangleSoup& soup) {
    if (soup.size() > std::numeric_limits<std::uint32_t>::max())
        throw Error(
            ErrorKind::limit,
            fmt::format("{} triangles are more than a binary STL file can count (2^32 - 1)", soup.size()));
    AtomicFile file(path);
    std::array<char, 84> head{};
    // It must not begin with "solid": readers take such a file for ASCII.
    put(head.data(), "Binary STL written by Lamella, millimetres");
    const auto count = static_cast<std::uint32_t>(soup.size());
    std::memcpy(head.data() + 80, &count, sizeof count);
    file.append({head.data(), head.size()});

    ByteBuffer block;
    for (std::size_t begin = 0; begin < soup.size(); begin += triangles_per_block) {
        const std::size_t end = std::min(soup.size(), begin + triangles_per_block);
        block.clear();
        char* at = block.room((end - begin) * record_size);
        for (std::size_t i = begin; i < end; ++i) {
            const Facet f = facet(soup, i);
            std::memcpy(at, &f, sizeof f);
            std::memset(at + sizeof f, 0, record_size - sizeof f);
            at += record_size;
        }
        block.end_at(at);
        file.append(block.view());
    }
    file.commit();
}

void write_stl_ascii(const std::string& path, const TriangleSoup& soup, const std::string& name) {
    std::string title = name;
    for (char& c : title)
        c = static_cast<unsigned char>(c) < ' ' ? ' ' : c; // it must stay one line
    AtomicFile file(path);
    file.append("solid " + title + "\n");
    constexpr std::size_t longest_facet = 400;
    ByteBuffer block;
    for (std::size_t begin = 0; begin < soup.size(); begin += triangles_per_block) {
        const std::size_t end = std::min(soup.size(), begin + triangles_per_block);
        block.clear();
        char* at = block.room((end - begin) * longest_facet);
        for (std::size_t i = begin; i < end; ++i) {
            const Facet f = facet(soup, i);
            at = put(put(at, "facet normal"), f.normal);
            at = put(at, "  outer loop\n");
            for (const Point3f& corner : f.corners)
                at = put(put(at, "    vertex"), corner);
            at = put(at, "  endloop\nendfacet\n");
        }
        block.end_at(at);
        file.append(block.view());
    }
    file.append("endsolid " + title + "\n");
    file.commit();
}

} // namespace lamella
