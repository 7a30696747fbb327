#include "lamella/mesh/inspect.hpp"

#include "container/zip_bytes.hpp"
#include "fixtures/face_text.hpp"
#include "inputs/mesh_file_samples.hpp"
#include "parts/shapes.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>

#include <random>

namespace lamella::mesh_test::mesh_file_cases {
namespace {

TEST(MeshFile, IsReadByItsContentWhateverItsName) {
    for (const std::string name : {"part", "part.stl", "part.obj", "part.off", "part.ply", "part.txt"}) {
        EXPECT_EQ(read(stl, name).format, "stl-ascii") << name;
        EXPECT_EQ(read(ply, name).format, "ply") << name;
        EXPECT_EQ(read(off, name).format, "off") << name;
        EXPECT_EQ(read("OFF # <amf" + off.substr(3), name).format, "off") << name;
        if (name != "part.off" && name != "part.ply") {
            EXPECT_EQ(read(obj, name).format, "obj") << name;
            EXPECT_EQ(read("# replaces <amf>\n" + obj, name).format, "obj") << name;
        }
    }
}

TEST(MeshFile, IsReadByItsNameWhereTheContentDoesNotReport) {
    EXPECT_EQ(read(off.substr(4), "part.off").format, "off");
    EXPECT_EQ(read(off.substr(4), "PART.OFF").format, "off");
    EXPECT_EQ(read("s off\nxyz\n" + obj, "part.Obj").format, "obj");
    EXPECT_EQ(error_of("1 2 3\n", "folder.obj/part"),
              "folder.obj/part: line 1: is a text, but no mesh file: found '1 2 3', expected 'solid' of an "
              "ASCII STL file, or the beginning of another mesh format");
}

TEST(MeshFile, RefusesOtherKindsOfFilesByWhatTheyAre) {
    for (const std::string name : {"part.obj", "part.ply", "part.off", "part.stl"}) {
        EXPECT_EQ(error_of("\n<!DOCTYPE html><html>", name),
                  name + ": is a web page, no mesh file; download the file itself");
        EXPECT_EQ(error_of(std::string("\xff\xfev\0 \0", 6), name),
                  name + ": is text in UTF-16; save it as UTF-8, or as a binary file");
        EXPECT_EQ(error_of(std::string("\xfe\xff\0v\0 ", 6), name),
                  name + ": is text in UTF-16; save it as UTF-8, or as a binary file");
    }
}

TEST(MeshFile, RefusesSliceFilesByWhatTheyHold) {
    const std::string binary(300, '\1');
    const std::string already = "it holds layers already, no mesh; view, convert or verify it as it is";
    for (const std::string name : {"part.stl", "part.cli", "part.obj", "part"}) {
        EXPECT_EQ(error_of("// by hand //\n$$HEADERSTART\n$$BINARY\n$$UNITS/1\n$$HEADEREND" + binary, name),
                  name + ": is a slice file (Common Layer Interface): " + already);
        EXPECT_EQ(error_of("-SLCVER 2.0 -UNIT MM\r\n\x1a" + binary, name),
                  name + ": is a slice file (SLC): " + already);
        EXPECT_TRUE(error_of("<?xml version=\"1.0\"?>\n<svg></svg>", name)
                        .starts_with(name + ": is an SVG document, which may hold layers, but no mesh;"));
        EXPECT_TRUE(error_of("{\"layers\": []}", name)
                        .starts_with(name + ": is a JSON document, which may hold layers, but no mesh"));
    }
    EXPECT_EQ(error_of(zip_test::zip_bytes({{.name = "points.npy", .content = "x"}}), "part.npz"),
              "part.npz: is a slice file (NumPy arrays): " + already);
    for (const std::string image : {"00000.png", "part/LAYER.PNG"})
        EXPECT_EQ(error_of(zip_test::zip_bytes(
                               {{.name = "config.ini", .content = "x"}, {.name = image, .content = "x"}}),
                           "job.sl1"),
                  "job.sl1: holds images of layers, as for a resin printer, and no mesh; of such archives, "
                  "those of "
                  "png-zip, SL1, Chitubox and NanoDLP can be viewed, converted and verified as they are");
}

TEST(MeshFile, IsNotGuessedToBeBinaryStlUnderTheNameOfASliceFile) {
    for (const std::string extension : {"cli", "slc", "svg", "json", "npz"})
        EXPECT_EQ(
            error_of(std::string(300, '\1'), "part." + extension),
            fmt::format("part.{0}: is neither a mesh file nor the slice file that its extension .{0} says",
                        extension));
    EXPECT_EQ(read(obj, "part.json").format, "obj");
    EXPECT_EQ(read(stl, "part.cli").format, "stl-ascii");
}

TEST(MeshFile, IsNotGuessedToBeBinaryStlUnderTheNameOfAnotherMeshFile) {
    for (const std::string name : {"part.3mf", "PART.AMF", "part.3mf.gz"})
        EXPECT_NE(error_of(std::string(300, '\1'), name).find("is neither what its extension ."),
                  std::string::npos);
    EXPECT_EQ(read(stl, "part.3mf").format, "stl-ascii");
}

TEST(MeshFile, IsNotGuessedToBeBinaryStlWhereCornersMakeNoSense) {
    std::mt19937 random(3);
    for (const std::size_t size : {3000U, 100'000U}) {
        std::string bytes(size, '\0');
        for (char& byte : bytes)
            byte = static_cast<char>(random());
        for (const std::string name : {"part.stl", "part"})
            EXPECT_NE(error_of(bytes, name).find("no mesh file that is known"), std::string::npos);
    }
}

TEST(MeshFile, GoesByTheExtensionsOfTheFormatsThatAreRead) {
    for (const std::string_view extension : mesh_extensions()) {
        EXPECT_TRUE(is_mesh_name(fmt::format("a.b/part.{}", extension)));
        EXPECT_TRUE(is_mesh_name(fmt::format("part.{}.GZ", extension)));
    }
    EXPECT_TRUE(is_mesh_name("PART.Stl"));
    for (const char* name : {"stl", "part.cli", "part.npz", "folder.stl/part", "part.gz", "part.stl.txt", ""})
        EXPECT_FALSE(is_mesh_name(name)) << name;
}

} // namespace
} // namespace lamella::mesh_test::mesh_file_cases
