#include "lamella/core/error.hpp"
#include "lamella/read/layer_file.hpp"

#include "read/gzip.hpp"

#include <gtest/gtest.h>

#include <span>
#include <string>

namespace lamella {
namespace {

using test::packed;

const std::string square =
    "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$VERSION/200\n$$HEADEREND\n$$GEOMETRYSTART\n$$LAYER/0\n$$LAYER/1\n"
    "$$POLYLINE/1,1,5,0,0,2,0,2,2,0,2,0,0\n$$GEOMETRYEND\n";

LayerFile read_packed(const std::string& content, std::uint64_t max_memory = 0) {
    return read_layers(std::as_bytes(std::span(content)), "layers.cli.gz", {.max_memory = max_memory});
}

LayerFile read_text(const std::string& content) {
    return read_layers(std::as_bytes(std::span(content)), "layers");
}

TEST(LayerFile, OfNoKindNamesAllKindsThatAreRead) {
    try {
        (void)read_text("G1 X10 Y10\n");
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        const std::string text = error.what();
        for (const char* kind : {"$$HEADERSTART", "-SLCVER", "<svg", "JSON", "3MF", "NumPy"})
            EXPECT_NE(text.find(kind), std::string::npos) << kind << ": " << text;
    }
}

TEST(LayerFile, IsOfTheKindThatItsBeginningSaysWhateverItsTextsHold) {
    try {
        (void)read_text("{\"label\": \"$$HEADERSTART <svg\"}");
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find("$$"), std::string::npos) << error.what();
    }
}

TEST(LayerFile, MayBePackedWithGzip) {
    const std::string content = packed(square);
    if (content.empty())
        GTEST_SKIP() << "no gzip program";
    const LayerFile file = read_packed(content);
    EXPECT_EQ(file.format, "cli-ascii");
    ASSERT_EQ(file.parts.size(), 1U);
    ASSERT_EQ(file.parts.front().layers.size(), 1U);
    EXPECT_EQ(file.parts.front().layers[0].points.size(), 4U);
}

TEST(LayerFile, WhatIsUnpackedCountsForTheLimit) {
    const std::string content = packed(square + std::string(1 << 20, '\n'));
    if (content.empty())
        GTEST_SKIP() << "no gzip program";
    EXPECT_EQ(read_packed(content, 2U << 20).parts.size(), 1U);
    try {
        static_cast<void>(read_packed(content, 1U << 19));
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::limit) << error.what();
    }
}

TEST(LayerFile, PackedWithGzipAndCutOffIsAnError) {
    const std::string content = packed(square);
    if (content.empty())
        GTEST_SKIP() << "no gzip program";
    for (std::size_t length = 4; length < content.size(); ++length)
        EXPECT_THROW(static_cast<void>(read_packed(content.substr(0, length))), Error) << length;
}

} // namespace
} // namespace lamella
