#include "lamella/contour/exposure.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>

namespace lamella {
namespace {

TEST(Exposure, IsReadBackFromItsLabel) {
    for (const std::string part : {"part", "", "a core hatch", "core contour 7", "x 3"})
        for (const ScanRegion region :
             {ScanRegion::core, ScanRegion::upskin, ScanRegion::downskin, ScanRegion::support})
            for (const VectorKind kind : {VectorKind::contour, VectorKind::hatch})
                for (const std::uint32_t contour : {0U, 1U, 12U}) {
                    Exposure exposure;
                    exposure.part = part;
                    exposure.region = region;
                    exposure.kind = kind;
                    exposure.contour = contour;
                    const std::optional<Exposure> read = labelled_exposure(exposure.label());
                    ASSERT_TRUE(read) << exposure.label();
                    EXPECT_EQ(read->part, part);
                    EXPECT_EQ(read->region, region);
                    EXPECT_EQ(read->kind, kind);
                    EXPECT_EQ(read->contour, contour);
                    EXPECT_EQ(read->parameters, unknown_parameters());
                    EXPECT_TRUE(exposure.label().ends_with(exposure.name()));
                }
}

TEST(Exposure, IsNoneOfAnyOtherLabel) {
    for (const std::string label : {"", "part", "core", "core hatch", "part core", "part core hatches",
                                    "part inner hatch", "part core contour x", "part core  hatch"})
        EXPECT_FALSE(labelled_exposure(label)) << label;
}

TEST(Exposure, OfUnknownParametersHasNoNumbers) {
    const ParameterSet unknown = unknown_parameters();
    EXPECT_TRUE(unknown.name.empty());
    for (const double value : {unknown.power_w, unknown.speed_mm_s, unknown.jump_speed_mm_s, unknown.focus_mm,
                               unknown.spot_mm, unknown.mark_delay_us, unknown.jump_delay_us})
        EXPECT_EQ(value, 0);
}

} // namespace
} // namespace lamella
