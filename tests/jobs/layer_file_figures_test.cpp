#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/layer_files.hpp"

#include "fixtures/rounds.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lamella::layer_file_figures_cases {
namespace {

constexpr int planes = 300;

/// A part of which the layers become larger, and hatch lines in every layer.
std::string text_of(bool vectors) {
    std::string text = "$$HEADERSTART\n$$ASCII\n$$UNITS/0.001\n$$VERSION/200\n$$LABEL/1,body\n";
    text += vectors ? "$$LABEL/2,body core hatch\n" : "$$LABEL/2,other\n";
    text += "$$HEADEREND\n$$GEOMETRYSTART\n";
    for (int z = 1; z <= planes; ++z) {
        const std::string size = std::to_string(1000 + 7 * z);
        text += "$$LAYER/" + std::to_string(100 * z) + "\n$$POLYLINE/1,1,5,0,0," + size + ",0," + size + "," +
                size + ",0," + size + ",0,0\n$$HATCHES/2,2,0,10," + size + ",10," + size + ",20,0,20\n";
    }
    return text + "$$GEOMETRYEND\n";
}

LayerFile read(bool vectors, KeptPlanes kept) {
    const std::string text = text_of(vectors);
    return read_layers(std::as_bytes(std::span(text)), "a.cli", {.kept = kept}, {.threads = 1});
}

TEST(LayerFileFigures, AreSumsOfTheLayers) {
    const FileFigures figures = measure(read(true, KeptPlanes::all));
    EXPECT_EQ(figures.contours.contours, std::size_t{planes});
    EXPECT_EQ(figures.contours.points, std::size_t{4 * planes});
    EXPECT_EQ(figures.contours.open_chains, 0U);
    double volume = 0;
    double length = 0;
    for (int z = 1; z <= planes; ++z) {
        const double size = 1 + 0.007 * z;
        volume += size * size * 0.1;
        length += 2 * size;
    }
    EXPECT_NEAR(figures.volume_mm3, volume, 1e-9);
    ASSERT_EQ(figures.exposures.size(), 1U);
    EXPECT_EQ(figures.exposures[0].exposure.kind, VectorKind::hatch);
    EXPECT_EQ(figures.exposures[0].figures.vectors, std::uint64_t{2 * planes});
    EXPECT_NEAR(figures.exposures[0].figures.marked_mm, length, 1e-9);
    EXPECT_NEAR(figures.exposures[0].figures.jumped_mm, planes * 0.01, 1e-9);
    EXPECT_TRUE(measure(read(false, KeptPlanes::all)).exposures.empty());
}

TEST(LayerFileFigures, AreTheSameForAnyNumberOfThreadsAndIfLayersAreNotInMemory) {
    const FileFigures expected = measure(read(true, KeptPlanes::all), {.threads = 1});
    for (const KeptPlanes kept : {KeptPlanes::all, KeptPlanes::none})
        for (const unsigned threads : test::thread_counts()) {
            const LayerFile file = read(true, kept);
            ASSERT_EQ(file.plane_bytes > 0, kept == KeptPlanes::none);
            const FileFigures found = measure(file, {.threads = threads});
            EXPECT_EQ(found.contours.perimeter_mm, expected.contours.perimeter_mm);
            EXPECT_EQ(found.volume_mm3, expected.volume_mm3);
            EXPECT_EQ(found.exposures[0].figures.marked_mm, expected.exposures[0].figures.marked_mm);
            EXPECT_EQ(found.exposures[0].figures.jumped_mm, expected.exposures[0].figures.jumped_mm);
        }
}

TEST(LayerFileFigures, OfNoPartsAreNothing) {
    EXPECT_EQ(measure(LayerFile{}).contours.points, 0U);
}

} // namespace
} // namespace lamella::layer_file_figures_cases
