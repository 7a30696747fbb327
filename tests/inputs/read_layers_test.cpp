#include "lamella/contour/exposure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layer_outcome.hpp"
#include "inputs/gzip.hpp"
#include "slices/engine/layer_assembly.hpp"
#include "slices/engine/layer_pieces.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

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

TEST(LayerFile, MayBePackedWithGzip) {
    const std::string content = compressed(square);
    if (content.empty())
        GTEST_SKIP() << "no gzip program";
    const LayerFile file = read_compressed(content);
    const std::vector<LayerPart> parts = file.in_memory();
    EXPECT_EQ(file.format, "cli-ascii");
    ASSERT_EQ(file.parts.size(), 1U);
    ASSERT_EQ(parts.front().layers.size(), 1U);
    EXPECT_EQ(parts.front().layers[0].points.size(), 4U);
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

/// Returns a file of many pieces, in which layers occur out of order, heights twice, and comments look like
/// layers. With `settings`, they apply to the vectors of later layers.
std::string many_pieces(bool settings) {
    std::string text = "$$HEADERSTART\n$$ASCII\n$$UNITS/0.001\n$$VERSION/200\n$$HEADEREND\n$$GEOMETRYSTART\n";
    for (std::size_t i = 0; text.size() < 4 * layer_piece_bytes; ++i) {
        const std::size_t z = i % 50 == 7 ? 100 + i / 2 : i % 50 == 9 ? 99 + i : 100 + i;
        if (settings && i % 400 == 100)
            text += fmt::format("$$POWER/{}\n$$SPEED/700\n", 100 + i);
        text += fmt::format("$$LAYER/{}\n// $$LAYER/{} //\n", z, z + 1);
        if (settings && i % 300 == 50)
            text += fmt::format("$$FOCUS/{}\n", i);
        for (std::size_t k = 0; k < 1 + i % 3; ++k)
            text += fmt::format("$$POLYLINE/{},1,5,{},0,{},0,{},{},{},{},{},0\n", 1 + k, i, i + 900, i + 900,
                                700 + k, i, 700 + k, i);
        if (i % 5 == 0)
            text += fmt::format("$$HATCHES/1,2,{},5,{},5,{},9,{},9\n", i, i + 90, i + 90, i);
    }
    return text + "$$GEOMETRYEND\n";
}

TEST(LayerFile, WhoseLayersAreNotInMemoryHasTheSamePlanes) {
    for (const bool settings : {false, true}) {
        const std::string text = many_pieces(settings);
        const auto bytes = std::as_bytes(std::span(text));
        test::expect_same_layers(text);
        const LayerFile held = read_layers(bytes, "a.cli", {}, {.threads = 1});
        ASSERT_GT(held.planes.size(), 1000U);
        EXPECT_GT(held.parts.size(), settings ? 10U : 2U);
        const LayerFile file = read_layers(bytes, "a.cli", {.kept = KeptPlanes::none});
        ASSERT_GT(file.plane_bytes, 0U);
        const LayerStack merged = file.merged();
        ASSERT_EQ(merged.size(), held.planes.size());
        EXPECT_EQ(content_hash(merged[30]), content_hash(held.merged()[30]));
    }
}

TEST(LayerFile, WhoseLayersAreNotInMemoryNeedsNoMemoryForThem) {
    std::string text = "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$VERSION/200\n$$HEADEREND\n$$GEOMETRYSTART\n";
    for (int z = 1; text.size() < 8 * layer_piece_bytes; ++z) {
        text += fmt::format("$$LAYER/{}\n$$POLYLINE/1,1,2000", z);
        for (int i = 0; i < 1000; ++i)
            text += ",0,0,9,9";
        text += '\n';
    }
    text += "$$GEOMETRYEND\n";
    const auto bytes = std::as_bytes(std::span(text));
    const std::uint64_t max_memory = 4 * text.size();
    test::expect_error(ErrorKind::limit, {"max_memory"}, [&] {
        static_cast<void>(read_layers(bytes, "a.cli", {.max_memory = max_memory}, {.threads = 1}));
    });
    const LayerFile file = read_layers(
        bytes, "a.cli", {.max_memory = max_memory, .kept = KeptPlanes::if_faster}, {.threads = 1});
    for (std::size_t i = 0; i < file.planes.size(); ++i)
        ASSERT_EQ(file.plane(i).polylines.front().points.size(), 2000U);
}

/// A binary file of 100 layers of 400 numbers each.
std::string binary_layers() {
    std::string bytes = "$$HEADERSTART\n$$BINARY\n$$UNITS/1\n$$VERSION/200\n$$HEADEREND";
    for (int z = 1; z <= 100; ++z) {
        const auto put = [&](auto value) {
            bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
        };
        put(std::uint16_t{127});
        put(static_cast<float>(z));
        put(std::uint16_t{130});
        for (const std::int32_t number : {1, 1, 400})
            put(number);
        for (int i = 0; i < 100; ++i)
            for (const float value : {0.F, 0.F, 9.F, 0.F, 9.F, 9.F, 0.F, 9.F})
                put(value);
    }
    return bytes;
}

TEST(LayerFile, KeepsPlanesOfTextInAmpleMemory) {
    const auto kept = [](const std::string& bytes, KeptPlanes planes, std::uint64_t max_memory) {
        const LayerFile file = read_layers(std::as_bytes(std::span(bytes)), "a.cli",
                                           {.max_memory = max_memory, .kept = planes}, {.threads = 1});
        EXPECT_GE(file.planes.size(), 100U);
        return file.plane_bytes == 0;
    };
    std::string text = "$$HEADERSTART\n$$ASCII\n$$UNITS/0.001\n$$VERSION/200\n$$HEADEREND\n$$GEOMETRYSTART\n";
    for (int i = 0; i < 100; ++i) {
        text += fmt::format("$$LAYER/{}\n$$POLYLINE/1,1,1001", i);
        for (int k = 0; k <= 1000; ++k)
            text += fmt::format(",{},{}", k % 1000, k * k % 1000);
        text += '\n';
    }
    text += "$$GEOMETRYEND\n";
    const std::uint64_t ample = 8 * text.size();
    EXPECT_TRUE(kept(text, KeptPlanes::all, ample - 1));
    EXPECT_TRUE(kept(text, KeptPlanes::if_faster, 0));
    EXPECT_TRUE(kept(text, KeptPlanes::if_faster, ample));
    EXPECT_FALSE(kept(text, KeptPlanes::if_faster, ample - 1));
    EXPECT_FALSE(kept(text, KeptPlanes::none, ample));
    const std::string binary = binary_layers();
    EXPECT_TRUE(kept(binary, KeptPlanes::all, 0));
    EXPECT_FALSE(kept(binary, KeptPlanes::if_faster, 0));
}

TEST(LayerFile, HasNoMorePlanesAtOnceThanFitTheMemory) {
    const std::string bytes = binary_layers();
    const auto threads = [&](KeptPlanes kept, std::uint64_t more, unsigned wished) {
        // Memory for the bytes, a piece of them as points, and the planes without contours.
        const std::uint64_t base = bytes.size() + 1'000'000;
        const LayerFile file = read_layers(std::as_bytes(std::span(bytes)), "a.cli",
                                           {.max_memory = base + more, .kept = kept}, {.threads = 1});
        return file.for_planes({.threads = wished}).threads;
    };
    EXPECT_EQ(threads(KeptPlanes::all, 1'000'000, 8), 8U);
    EXPECT_EQ(threads(KeptPlanes::none, 100'000'000, 8), 8U);
    EXPECT_EQ(threads(KeptPlanes::none, 0, 1), 1U);
    unsigned last = 0;
    for (const std::uint64_t more : {0, 100'000, 200'000, 400'000, 800'000, 1'600'000}) {
        const unsigned now = threads(KeptPlanes::none, more, 1000);
        EXPECT_GE(now, std::max(1U, last)) << more;
        EXPECT_LE(now, (1'000'000 + more) / (200 * sizeof(Point2))) << more;
        last = now;
    }
    EXPECT_GT(last, 8U);
}

} // namespace
} // namespace lamella
