#pragma once

// Tools for tests of the readers of indexed meshes: reading from memory, and checking the result.

#include "lamella/core/error.hpp"
#include "lamella/read/mesh_file.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/mutations.hpp"

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
#include <vector>

namespace lamella::mesh_test {

using Corners = std::array<std::uint32_t, 3>;

/// Reads from memory of exactly this size, so that a sanitizer detects reading one byte too far.
inline MeshFile read(std::string_view bytes, const std::string& name, const MeshReadOptions& options = {},
                     unsigned threads = 1) {
    const std::unique_ptr<std::byte[]> exact(new std::byte[bytes.size()]);
    std::memcpy(exact.get(), bytes.data(), bytes.size());
    return read_mesh({exact.get(), bytes.size()}, name, options, {.threads = threads});
}

inline const IndexedMesh& mesh_of(const MeshFile& file) {
    EXPECT_EQ(file.objects.size(), 1U);
    EXPECT_EQ(file.instances.size(), 1U);
    const IndexedMesh* mesh = file.objects.front().mesh.indexed();
    EXPECT_NE(mesh, nullptr);
    return *mesh;
}

/// Expects these vertices and triangles without a warning.
inline void expect_mesh(std::string_view bytes, const std::string& name, const std::vector<Point3>& vertices,
                        const std::vector<Corners>& triangles) {
    const MeshFile file = read(bytes, name);
    EXPECT_EQ(mesh_of(file).vertices, vertices);
    EXPECT_EQ(mesh_of(file).triangles, triangles);
    EXPECT_EQ(file.stored_triangles, triangles.size());
    EXPECT_EQ(file.warnings, std::vector<std::string>{});
}

/// Returns the text of the error; fails the test if there is none or it is of another kind.
inline std::string error_of(std::string_view bytes, const std::string& name,
                            const MeshReadOptions& options = {}, ErrorKind kind = ErrorKind::input) {
    return test::error_of(kind, [&] { static_cast<void>(read(bytes, name, options)); });
}

/// Expects this one warning, which is an error for a strict caller.
inline void expect_warning(std::string_view bytes, const std::string& name, std::uint64_t triangles,
                           const std::string& warning) {
    const MeshFile file = read(bytes, name);
    EXPECT_EQ(mesh_of(file).triangles.size(), triangles);
    EXPECT_EQ(file.warnings, std::vector<std::string>{warning});
    EXPECT_EQ(error_of(bytes, name, {.strict = true}, ErrorKind::defect), name + ": " + warning);
}

/// Expects a valid mesh or an error of one line, for any bytes. Returns whether it is a mesh.
inline bool survive(std::string_view bytes, const std::string& name) {
    try {
        const MeshFile file = read(bytes, name);
        if (const IndexedMesh* mesh = file.objects.front().mesh.indexed()) {
            check(*mesh);
            EXPECT_FALSE(mesh->triangles.empty());
            EXPECT_EQ(mesh->triangles.size() + file.nonfinite_triangles, file.stored_triangles);
        }
        return true;
    } catch (const Error& error) {
        EXPECT_TRUE(error.kind() == ErrorKind::input || error.kind() == ErrorKind::limit) << error.what();
        EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << error.what();
        return false;
    }
}

/// Tests every truncation, and some thousand changes, of these files.
inline void survive_hostility(const std::vector<std::string>& seeds, const std::string& name,
                              const std::vector<std::string>& words) {
    for (const std::string& seed : seeds)
        for (std::size_t size = 1; size < seed.size(); ++size)
            survive(std::string_view(seed).substr(0, size), name);
    std::mt19937 random(7);
    std::size_t read_anyway = 0;
    for (int round = 0; round < 4000; ++round) {
        std::string bytes = seeds[random() % seeds.size()];
        test::mutate(bytes, random, words);
        read_anyway += survive(bytes, name) ? 1 : 0;
    }
    EXPECT_GT(read_anyway, 100U) << "the mutations are so wild that they test nothing";
}

/// Expects the same result for any number of threads, for files of several chunks.
inline void expect_same_for_any_threads(std::string_view bytes, const std::string& name) {
    const MeshFile one = read(bytes, name, {}, 1);
    for (const unsigned threads : {2U, 7U}) {
        const MeshFile many = read(bytes, name, {}, threads);
        EXPECT_TRUE(mesh_of(many).vertices == mesh_of(one).vertices);
        EXPECT_TRUE(mesh_of(many).triangles == mesh_of(one).triangles);
        EXPECT_EQ(many.warnings, one.warnings);
    }
}

} // namespace lamella::mesh_test
