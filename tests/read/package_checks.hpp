#pragma once

// Tools for tests of 3MF and AMF files.

#include "lamella/core/error.hpp"
#include "lamella/read/mesh_file.hpp"

#include "packages.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <string_view>

namespace lamella::package_test {

inline MeshFile read(std::string_view bytes, const MeshReadOptions& options = {}, unsigned threads = 1) {
    return read_mesh(std::as_bytes(std::span(bytes.data(), bytes.size())), "x", options,
                     {.threads = threads});
}

/// Returns the text of the error, "" if there is none.
inline std::string error_of(std::string_view bytes, ErrorKind kind = ErrorKind::input,
                            const MeshReadOptions& options = {}) {
    try {
        read(bytes, options);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), kind) << error.what();
        EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << error.what();
        return error.what();
    }
    return {};
}

inline testing::AssertionResult says(const std::string& text, std::string_view part) {
    if (text.find(part) != std::string::npos)
        return testing::AssertionSuccess();
    return testing::AssertionFailure() << "found '" << text << "', expected '" << part << "'";
}

inline void expect_box(const MeshFile& file, const Point3& min, const Point3& max) {
    const Box3 box = bounding_box(file.mesh());
    const auto near = [](const Point3& a, const Point3& b) {
        EXPECT_NEAR(a.x, b.x, 1e-9);
        EXPECT_NEAR(a.y, b.y, 1e-9);
        EXPECT_NEAR(a.z, b.z, 1e-9);
    };
    near(box.min, min);
    near(box.max, max);
}

inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

/// Reads from memory of exactly this size, so that a sanitizer detects reading one byte too far. Returns the
/// number of triangles, none if the file was refused.
inline std::optional<std::size_t> survive(std::string_view bytes) {
    const std::unique_ptr<std::byte[]> exact(new std::byte[bytes.size()]);
    std::memcpy(exact.get(), bytes.data(), bytes.size());
    try {
        const MeshFile file = read_mesh({exact.get(), bytes.size()}, "x", {}, {.threads = 1});
        EXPECT_FALSE(file.instances.empty());
        std::size_t triangles = 0;
        for (const MeshObject& object : file.objects) {
            const IndexedMesh* const mesh = object.mesh.indexed();
            if (mesh == nullptr)
                return file.mesh().size(); // a mutation made it an STL file
            EXPECT_NO_THROW(check(*mesh));
            triangles += mesh->triangles.size();
        }
        EXPECT_EQ(file.stored_triangles, triangles);
        for (const MeshInstance& instance : file.instances) {
            EXPECT_LT(instance.object, file.objects.size());
            EXPECT_TRUE(finite(instance.placement));
        }
        for (const std::string& warning : file.warnings)
            EXPECT_EQ(warning.find('\n'), std::string::npos);
        return triangles;
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
        EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << error.what();
        return std::nullopt;
    }
}

/// Changes some bytes, and inserts words at positions where they cause errors.
inline std::string mutated(std::string text, std::mt19937& random, std::span<const std::string_view> words) {
    for (unsigned change = 0; change <= random() % 3; ++change) {
        const std::size_t at = random() % text.size();
        switch (random() % 6) {
        case 0:
            text[at] = static_cast<char>(random());
            break;
        case 1:
            text[at] = static_cast<char>(text[at] ^ (1 << random() % 8));
            break;
        case 2:
            text.erase(at, 1 + random() % 30);
            break;
        case 3:
        case 4:
            text.insert(at, words[random() % words.size()]);
            break;
        default:
            text.insert(at, text.substr(random() % text.size(), random() % 80));
        }
        if (text.empty())
            text.assign(1, 'x');
    }
    return text;
}

} // namespace lamella::package_test
