#include "lamella/core/error.hpp"
#include "lamella/read/layer_file.hpp"

#include "fixtures/expect_error.hpp"
#include "read/gzip.hpp"
#include "read/layer_assembly.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <string>

namespace lamella {
namespace {

using test::compressed;

const std::string square =
    "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$VERSION/200\n$$HEADEREND\n$$GEOMETRYSTART\n$$LAYER/0\n$$LAYER/1\n"
    "$$POLYLINE/1,1,5,0,0,2,0,2,2,0,2,0,0\n$$GEOMETRYEND\n";

LayerFile read_compressed(const std::string& content, std::uint64_t max_memory = 0) {
    return read_layers(std::as_bytes(std::span(content)), "layers.cli.gz", {.max_memory = max_memory});
}

LayerFile read_text(const std::string& content) {
    return read_layers(std::as_bytes(std::span(content)), "layers");
}

TEST(LayerFile, OfNoKindNamesAllKindsThatAreRead) {
    const std::string text = test::error_of(ErrorKind::input, [] { (void)read_text("G1 X10 Y10\n"); });
    for (const char* kind : {"$$HEADERSTART", "-SLCVER", "<svg", "JSON", "3MF", "NumPy"})
        EXPECT_NE(text.find(kind), std::string::npos) << kind << ": " << text;
}

TEST(LayerFile, MayBeAStackOfAThousandPartsInFewBytes) {
    LayerFile file;
    file.path = "stack.cli";
    file.parts.resize(1000);
    check_part_planes(file, 1100, 114'338); // as such a plate is written
    const auto check = [&](std::uint64_t planes, std::uint64_t bytes) {
        return [&, planes, bytes] {
            check_part_planes(file, planes, bytes);
        };
    };
    check(5000, 5'000'000)();
    EXPECT_NE(test::error_of(ErrorKind::input, check(5000, 114'338)).find("1000 parts on 5000 planes"),
              std::string::npos);
}

TEST(LayerFile, IsOfTheKindThatItsBeginningSaysWhateverItsTextsHold) {
    const std::string text =
        test::error_of(ErrorKind::input, [] { (void)read_text("{\"label\": \"$$HEADERSTART <svg\"}"); });
    EXPECT_EQ(text.find("$$"), std::string::npos) << text;
}

TEST(LayerFile, WhosePartsTheCallerMadeUnequalIsNotMerged) {
    LayerFile file = read_text(square);
    file.parts.push_back({.label = "other", .layers = {}});
    test::expect_error(ErrorKind::usage, {"layers", "\"other\" has 0 layers", "has 1"},
                       [&] { static_cast<void>(file.merged()); });
    file.parts = {};
    EXPECT_TRUE(file.merged().empty());
}

TEST(LayerFile, MayBePackedWithGzip) {
    const std::string content = compressed(square);
    if (content.empty())
        GTEST_SKIP() << "no gzip program";
    const LayerFile file = read_compressed(content);
    EXPECT_EQ(file.format, "cli-ascii");
    ASSERT_EQ(file.parts.size(), 1U);
    ASSERT_EQ(file.parts.front().layers.size(), 1U);
    EXPECT_EQ(file.parts.front().layers[0].points.size(), 4U);
}

TEST(LayerFile, WhatIsUnpackedCountsForTheLimit) {
    const std::string content = compressed(square + std::string(1 << 20, '\n'));
    if (content.empty())
        GTEST_SKIP() << "no gzip program";
    EXPECT_EQ(read_compressed(content, 2U << 20).parts.size(), 1U);
    test::error_of(ErrorKind::limit, [&] { static_cast<void>(read_compressed(content, 1U << 19)); });
}

TEST(LayerFile, PackedWithGzipAndCutOffIsAnError) {
    const std::string content = compressed(square);
    if (content.empty())
        GTEST_SKIP() << "no gzip program";
    for (std::size_t length = 4; length < content.size(); ++length)
        EXPECT_THROW(static_cast<void>(read_compressed(content.substr(0, length))), Error) << length;
}

} // namespace
} // namespace lamella
