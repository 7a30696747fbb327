#include "lamella/mesh/inspect.hpp"

#include "container/zip_bytes.hpp"
#include "fixtures/face_text.hpp"
#include "inputs/mesh_file_samples.hpp"
#include "parts/shapes.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace lamella::mesh_test::mesh_file_cases {
namespace {

const std::filesystem::path shared = LAMELLA_SHARED;

/// The box of test::box_triangles with its sides as squares, as text.
std::string box_as_off() {
    return "OFF\n8 6 12\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n0 0 3\n2 0 3\n2 2 3\n0 2 3\n"
           "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
}

std::string as_obj(const IndexedMesh& mesh) {
    std::string text;
    for (const Point3& p : mesh.vertices)
        text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    for (const Corners& t : mesh.triangles)
        text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    return text;
}

std::string as_off(const IndexedMesh& mesh) {
    std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
    for (const Point3& p : mesh.vertices)
        text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
    for (const Corners& t : mesh.triangles)
        text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
    return text;
}

std::string as_ply(const IndexedMesh& mesh, const std::string& form) {
    std::string text = fmt::format(
        "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
        "property float z\nelement face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        form, mesh.vertices.size(), mesh.triangles.size());
    if (form == "ascii") {
        const std::string rows = as_off(mesh);
        return text + rows.substr(rows.find('\n', 4) + 1);
    }
    const auto add = [&](auto value) {
        text.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    for (const Point3& p : mesh.vertices)
        for (const double v : {p.x, p.y, p.z})
            add(static_cast<float>(v));
    for (const Corners& t : mesh.triangles) {
        add(std::uint8_t{3});
        for (const std::uint32_t v : t)
            add(v);
    }
    return text;
}

TEST(MeshFile, OfAnyFormatIsTheMeshThatStlWeldsTo) {
    const IndexedMesh welded = weld(make_rook());
    for (const auto& [name, text] : {std::pair<std::string, std::string>{"rook.obj", as_obj(welded)},
                                     {"rook.off", as_off(welded)},
                                     {"rook.ply", as_ply(welded, "ascii")},
                                     {"rook.ply", as_ply(welded, "binary_little_endian")}}) {
        const MeshFile file = read(text, name, {}, 2);
        // Numbers were written so that they read back to the same doubles.
        EXPECT_TRUE(mesh_of(file).vertices == welded.vertices) << name;
        EXPECT_TRUE(mesh_of(file).triangles == welded.triangles) << name;
        EXPECT_EQ(volume(file.mesh()), volume(welded)) << name;
    }
}

TEST(MeshFile, OfPolygonsIsTheSameSolid) {
    const MeshFile file = read(box_as_off(), "box.off");
    EXPECT_EQ(file.stored_triangles, 12U);
    EXPECT_EQ(volume(file.mesh()), 12.0);
}

TEST(MeshFile, MayBePackedWithGzip) {
    const TemporaryFolder folder;
    for (const auto& [name, text] : {std::pair<std::string, std::string>{"part.stl", stl},
                                     {"part.obj", obj},
                                     {"part.off", off.substr(4)}, // told by the name alone
                                     {"part.ply", ply}}) {
        const std::string path = folder.file(name);
        std::ofstream(path, std::ios::binary) << text;
        if (std::system(fmt::format("gzip -k '{}'", path).c_str()) != 0)
            GTEST_SKIP() << "no gzip program";
        const MeshFile plain = read_mesh(path);
        const MeshFile compressed = read_mesh(path + ".gz");
        EXPECT_EQ(compressed.format, plain.format);
        EXPECT_EQ(compressed.stored_triangles, 1U);
        EXPECT_EQ(volume(compressed.mesh()), volume(plain.mesh()));
        test::error_of(ErrorKind::limit, [&] { (void)read_mesh(path + ".gz", {.max_memory = 20}); });
    }
}

/// What a sample of public projects holds; -1: it is refused.
struct Sample {
    const char* path;
    int triangles;
    const char* says = ""; ///< a part of the error, or of the warning
};

TEST(MeshFile, ReadsOrRefusesTheSamples) {
    const std::filesystem::path folder = shared / "formats/samples";
    if (!std::filesystem::exists(folder))
        GTEST_SKIP() << "no samples in " << shared << " (set LAMELLA_SHARED)";
    for (const Sample& sample :
         {Sample{"obj-assimp/box.obj", 12}, Sample{"obj-assimp/box_without_lineending.obj", 12},
          Sample{"obj-assimp/box_longline.obj", 944}, Sample{"obj-assimp/concave_polygon.obj", 64},
          Sample{"obj-assimp/multiple_spaces.obj", 1},
          // 3.1+e2 is how nobody writes a number: it may mean 3.1 or 310.
          Sample{"obj-assimp/number_formats.obj", -1, "line 11: found '3.1+e2', expected a number"},
          Sample{"obj-assimp/point_cloud.obj", -1, "3 vertices without a face"},
          Sample{"ply-assimp/Wuson.ply", 3732, "line 3: took 'Created by Blender3D"},
          Sample{"ply-assimp/cube.ply", 12}, Sample{"ply-assimp/cube_binary.ply", 12},
          Sample{"ply-assimp/cube_binary_header_with_RN_newline.ply", 12},
          Sample{"ply-assimp/cube_binary_starts_with_nl.ply", 12},
          Sample{"ply-assimp/issue623.ply", -1, "24 vertices without an element 'face'"},
          Sample{"off-assimp/Cube.off", 12}, Sample{"off-assimp/Wuson.off", 3732},
          Sample{"off-assimp/invalid.off", -1, "line 7: found the end of the line"},
          Sample{"sli-eos/Box.sli", -1, "is an SLI slice file of EOS"},
          Sample{"own/ring.sli", -1, "is an SLI slice file of EOS"},
          Sample{"own/ring_layer0.hpgl", -1, "is a text, but no mesh file"}}) {
        SCOPED_TRACE(sample.path);
        try {
            const MeshFile file = read_mesh((folder / sample.path).string());
            EXPECT_EQ(static_cast<int>(file.stored_triangles), sample.triangles);
            EXPECT_EQ(file.warnings.size(), *sample.says == '\0' ? 0U : 1U);
            for (const std::string& warning : file.warnings)
                EXPECT_EQ(warning.find(sample.says), 0U) << warning;
        } catch (const Error& error) {
            EXPECT_EQ(sample.triangles, -1) << error.what();
            EXPECT_NE(std::string_view(error.what()).find(sample.says), std::string_view::npos)
                << error.what();
        }
    }
    // The same body in two formats.
    const auto area = [&](const char* path) {
        return inspect(weld(read_mesh((folder / path).string()).mesh())).area_mm2;
    };
    EXPECT_NEAR(area("ply-assimp/Wuson.ply"), 9.0258, 0.00005);
    EXPECT_NEAR(area("ply-assimp/Wuson.ply"), area("off-assimp/Wuson.off"), 1e-9);
}

} // namespace
} // namespace lamella::mesh_test::mesh_file_cases
