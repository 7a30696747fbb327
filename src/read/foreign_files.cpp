#include "read/foreign_files.hpp"

#include "read/text_pieces.hpp"

#include <algorithm>
#include <array>

namespace lamella {

namespace {

using namespace std::string_view_literals;

struct Foreign {
    std::string_view first_bytes; ///< letters in lower case stand for both cases
    std::string_view advice;
};

constexpr std::string_view picture = "is a picture, no mesh file";
constexpr std::string_view packed =
    "is packed in a way that is not read here; unpack it first, or pack it with gzip";
constexpr std::string_view surfaces =
    "is a CAD file of surfaces without triangles; export STL, 3MF, OBJ or PLY from a CAD program";
constexpr std::string_view scene =
    "is a kind of mesh file that is not read here; save it as STL, 3MF, OBJ or PLY";

/// What is often found under the name of a mesh file, or given by mistake. Binary ones would be taken for
/// binary STL with a wrong count.
constexpr std::array foreign_files = {
    Foreign{"\x1f\x8b"sv, "is packed with gzip twice; unpack it once first"},
    Foreign{"pk\x03\x04"sv,
            "is a zip archive (3MF files are, too); unpack it, or give it its real extension"},
    Foreign{"<!doctype html"sv, "is a web page, no mesh file; download the file itself"},
    Foreign{"<html"sv, "is a web page, no mesh file; download the file itself"},
    Foreign{"<?xml"sv, "is an XML file of an unknown kind, no mesh file"},
    Foreign{"version https://git-lfs"sv,
            "is a pointer of Git LFS to the real file; fetch it with 'git lfs pull'"},
    Foreign{"\xff\xfe"sv, "is text in UTF-16; save it as UTF-8, or as a binary file"},
    Foreign{"\xfe\xff"sv, "is text in UTF-16; save it as UTF-8, or as a binary file"},
    Foreign{"eos 1993 sli"sv, "is an SLI slice file of EOS, which is not read here; export CLI instead"},
    Foreign{"\x89PNG"sv, picture},
    Foreign{"\xff\xd8\xff"sv, picture},
    Foreign{"GIF8"sv, picture},
    Foreign{"%pdf-"sv, "is a PDF document, no mesh file"},
    Foreign{"\x7f"
            "ELF"sv,
            "is a program, no mesh file"},
    Foreign{"BZh"sv, packed},
    Foreign{"\xfd"
            "7zXZ"sv,
            packed},
    Foreign{"\x28\xb5\x2f\xfd"sv, packed}, // Zstandard
    Foreign{"7z\xbc\xaf"sv, packed},
    Foreign{"Rar!"sv, packed},
    Foreign{"iso-10303-21"sv, surfaces},     // STEP
    Foreign{"\xd0\xcf\x11\xe0"sv, surfaces}, // compound documents, as SolidWorks and Inventor write
    Foreign{"3D Geometry File Format"sv, surfaces},
    Foreign{"glTF"sv, scene},
    Foreign{"Kaydara FBX Binary"sv, scene},
    Foreign{"BLENDER"sv, scene},
};

bool begins_with(std::string_view text, std::string_view first_bytes) {
    const auto same = [](char byte, char expected) {
        return byte == expected ||
               (expected >= 'a' && expected <= 'z' && byte == static_cast<char>(expected - ('a' - 'A')));
    };
    return text.size() >= first_bytes.size() &&
           std::equal(first_bytes.begin(), first_bytes.end(), text.begin(),
                      [&](char expected, char byte) { return same(byte, expected); });
}

} // namespace

std::string_view foreign_advice(std::string_view text) {
    const std::string_view begin = after_blanks(text);
    for (const Foreign& foreign : foreign_files)
        if (begins_with(text, foreign.first_bytes) || begins_with(begin, foreign.first_bytes))
            return foreign.advice;
    return {};
}

} // namespace lamella
