#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "slices/engine/exposure_keys.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace lamella::exposure_keys_cases {
namespace {

using test::Random;

Exposure any_exposure(Random& random) {
    Exposure exposure;
    exposure.part = random.integer(0, 1) == 0 ? "a" : "b";
    exposure.region = random.integer(0, 1) == 0 ? ScanRegion::core : ScanRegion::upskin;
    exposure.kind = random.integer(0, 1) == 0 ? VectorKind::contour : VectorKind::hatch;
    exposure.contour = static_cast<std::uint32_t>(random.integer(0, 1));
    exposure.parameters.power_w = static_cast<double>(random.integer(0, 1));
    return exposure;
}

bool same_but_for_the_part(Exposure a, const Exposure& b) {
    a.part = b.part;
    return a.region == b.region && a.kind == b.kind && a.contour == b.contour && a.parameters == b.parameters;
}

TEST(ExposureKeys, LeadFromEachPartToItsLabelAndItsExposure) {
    Random random(651);
    for (int round = 0; round < test::rounds_within_reason(1000); ++round) {
        std::vector<PartInfo> infos;
        for (std::int64_t n = random.integer(0, 12); n > 0; --n) {
            PartInfo& info = infos.emplace_back();
            if (random.integer(0, 4) == 0)
                info.label = random.integer(0, 1) == 0 ? "a" : "c";
            else
                info.exposure = any_exposure(random);
        }
        const ExposureKeys keys(infos);
        ASSERT_EQ(keys.keys.size(), infos.size());
        std::set<std::tuple<std::size_t, bool, std::size_t>> pairs;
        for (std::size_t i = 0; i < infos.size(); ++i) {
            const ExposureKeys::Key& key = keys.keys[i];
            ASSERT_LT(key.part, keys.parts.size());
            ASSERT_EQ(key.exposure.has_value(), infos[i].exposure.has_value());
            if (key.exposure) {
                ASSERT_LT(*key.exposure, keys.exposures.size());
                EXPECT_EQ(keys.parts[key.part], infos[i].exposure->part);
                EXPECT_TRUE(same_but_for_the_part(keys.exposures[*key.exposure], *infos[i].exposure));
            } else {
                EXPECT_EQ(keys.parts[key.part], infos[i].label);
            }
            EXPECT_TRUE(pairs.insert({key.part, key.exposure.has_value(), key.exposure.value_or(0)}).second)
                << "no part has an exposure twice";
        }
        for (std::size_t i = 0; i < keys.exposures.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_FALSE(same_but_for_the_part(keys.exposures[i], keys.exposures[k]));
    }
}

TEST(ExposureKeys, TakeTheSameBitsForTheSameNumber) {
    std::vector<PartInfo> infos(3);
    for (PartInfo& info : infos)
        info.exposure = Exposure{};
    infos[0].exposure->parameters.focus_mm = 0.0;
    infos[1].exposure->parameters.focus_mm = -0.0;
    infos[2].exposure->parameters.focus_mm = std::nan("");
    EXPECT_EQ(ExposureKeys(infos).exposures.size(), 2U);
}

} // namespace
} // namespace lamella::exposure_keys_cases
