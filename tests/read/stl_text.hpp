#pragma once

// STL files in memory, valid and defective.

#include "lamella/mesh/triangle_soup.hpp"
#include "lamella/read/mesh_file.hpp"

#include "fixtures/expect_error.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::stl_test {

using Triangles = std::vector<Triangle3f>;

/// Returns triangles of numbers that are exact in few decimals; not a closed body.
inline Triangles some_triangles(std::size_t count) {
    Triangles triangles(count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const auto base = static_cast<float>(i * 3 + corner);
            triangles[i][corner] = {base * 0.5F, -base * 0.25F, static_cast<float>(i % 17) + 0.125F};
        }
    return triangles;
}

inline void append(std::string& bytes, const void* data, std::size_t size) {
    bytes.append(static_cast<const char*>(data), size);
}

/// Returns a binary file with any header, count and tail.
inline std::string binary(const Triangles& triangles, std::uint32_t count,
                          std::string header = "made by a test") {
    header.resize(80, '\0');
    std::string bytes = header;
    append(bytes, &count, sizeof count);
    for (const Triangle3f& triangle : triangles) {
        bytes.append(12, '\0');
        append(bytes, &triangle, sizeof triangle);
        bytes.append(2, '\0');
    }
    return bytes;
}

inline std::string binary(const Triangles& triangles) {
    return binary(triangles, static_cast<std::uint32_t>(triangles.size()));
}

inline std::string facet(const Triangle3f& t, std::string_view normal = "normal 0 0 1") {
    std::string text = fmt::format("  facet {}\n    outer loop\n", normal);
    for (const Point3f& p : t)
        text += fmt::format("      vertex {} {} {}\n", p.x, p.y, p.z);
    return text + "    endloop\n  endfacet\n";
}

inline std::string solid(const Triangles& triangles, std::string_view name = "part") {
    std::string text = fmt::format("solid {}\n", name);
    for (const Triangle3f& triangle : triangles)
        text += facet(triangle);
    return text + fmt::format("endsolid {}\n", name);
}

inline std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t found = std::min(text.find(from, at), text.size());
        result += text.substr(at, found - at);
        if (found < text.size())
            result += to;
        at = found + from.size();
    }
    return result;
}

inline std::string upper_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; });
    return text;
}

inline MeshFile read(std::string_view bytes, const MeshReadOptions& options = {}, unsigned threads = 1) {
    return read_mesh(std::as_bytes(std::span(bytes.data(), bytes.size())), "part.stl", options,
                     {.threads = threads});
}

/// Returns the triangles of an STL file.
inline TriangleSoup soup_of(const MeshFile& file) {
    return *file.mesh().soup();
}

inline Triangles triangles_of(const MeshFile& file) {
    Triangles triangles;
    for (std::size_t i = 0; i < soup_of(file).size(); ++i)
        triangles.push_back(soup_of(file).stored(i));
    return triangles;
}

/// Returns the text of the error; fails the test if there is none or it is of another kind.
inline std::string error_of(std::string_view bytes, const MeshReadOptions& options = {},
                            ErrorKind kind = ErrorKind::input) {
    return test::error_of(kind, [&] { static_cast<void>(read(bytes, options)); });
}

/// Expects these triangles without a warning.
inline void expect_clean(std::string_view bytes, const Triangles& expected) {
    const MeshFile file = read(bytes);
    EXPECT_EQ(triangles_of(file), expected);
    EXPECT_EQ(file.stored_triangles, expected.size());
    EXPECT_EQ(file.nonfinite_triangles, 0U);
    EXPECT_EQ(file.warnings, std::vector<std::string>{});
}

/// Expects these triangles and this one warning, which is an error for a strict caller.
inline void expect_warning(std::string_view bytes, const Triangles& expected, const std::string& warning) {
    const MeshFile file = read(bytes);
    EXPECT_EQ(triangles_of(file), expected);
    EXPECT_EQ(file.warnings, std::vector<std::string>{warning});
    EXPECT_EQ(error_of(bytes, {.strict = true}, ErrorKind::defect), "part.stl: " + warning);
}

} // namespace lamella::stl_test
