#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/offset.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "scan/skin.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <vector>

namespace lamella {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;
using test::rectangle;
using test::reversed;
using test::rounds_within_reason;

/// A body with or without a hole; `by`: what its sides are moved by.
void add_body(std::vector<Contour>& rings, double x, double y, bool hole, const auto& by) {
    rings.push_back(rectangle(x + by(), y + by(), x + 6 + by(), y + 6 + by()));
    if (hole)
        rings.push_back(reversed(rectangle(x + 2 + by(), y + 2 + by(), x + 4 + by(), y + 4 + by())));
}

/// Bodies in rows, of which one layer differs from the next one little, much, or not at all.
struct Plate {
    explicit Plate(Random& random) : holes(random.integer(0, 4095)) {}

    [[nodiscard]] Layer layer(Random& random, double slope) const {
        std::vector<Contour> rings;
        for (int i = 0; i < 12; ++i) {
            const double x = 10.0 * (i % 4);
            const double y = 10.0 * (i / 4);
            const std::int64_t kind = random.integer(0, 9);
            const double most = kind < 7 ? slope : kind == 7 ? 0.7 : 0;
            if (kind != 8)
                add_body(rings, x, y, (holes >> i & 1) != 0 && kind != 9,
                         [&] { return random.real(-most, most); });
        }
        if (random.integer(0, 3) == 0) // joins two bodies
            rings.push_back(rectangle(5, 1, 11, 1.5));
        return fill(layer_of(rings), FillRule::nonzero).layer;
    }

    std::int64_t holes;
};

double difference(const Layer& a, const Layer& b) {
    return measure(combine(a, b, BooleanOperation::exclude)).area_mm2;
}

// By the definition, with nothing left out.
TEST(Skin, IsWhatSomeNeighbourHasNotWhereThatIsWide) {
    Random random(23);
    SkinRule rule;
    rule.narrowest = 0.12;
    rule.overlap = 0.3;
    double skin = 0;
    double rest = 0;
    for (int round = 0; round < rounds_within_reason(200); ++round) {
        rule.layers = static_cast<std::uint32_t>(random.integer(1, 9));
        const Plate plate(random);
        const double slope = round % 2 == 0 ? 0.01 : 0;
        const Layer layer = plate.layer(random, slope);
        std::vector<ScanLayer> neighbours;
        Layer open;
        for (std::uint32_t k = 0; k < rule.layers; ++k) {
            neighbours.emplace_back(plate.layer(random, slope));
            const double grown = rule.narrowest / 2 * (1 + 0.01 * k / rule.layers);
            const Layer beyond =
                combine(offset(layer, -rule.narrowest / 2 * 0.99), offset(neighbours.back().layer(), grown),
                        BooleanOperation::subtract);
            open = combine(open, beyond, BooleanOperation::unite);
        }
        const Skin found(layer, neighbours, rule);
        EXPECT_FALSE(found.whole());
        EXPECT_LT(difference(found.area(), offset(open, rule.narrowest / 2)), 1e-6) << round;
        EXPECT_LT(difference(found.with_overlap(), offset(open, rule.narrowest / 2 + rule.overlap)), 1e-6)
            << round;
        skin += measure(found.area()).area_mm2;
        rest += measure(combine(layer, found.area(), BooleanOperation::subtract)).area_mm2;
    }
    EXPECT_GT(skin, 0);
    EXPECT_GT(rest, 0);
}

TEST(Skin, IsAllOfTheLayerWhereThePartEndsAndNothingWithoutARule) {
    const Layer layer = layer_of({rectangle(0, 0, 6, 6)});
    SkinRule rule;
    const auto nothing = [](const Skin& skin) {
        return !skin.whole() && skin.area().rings == 0 && skin.with_overlap().rings == 0;
    };
    EXPECT_TRUE(nothing(Skin(layer, {}, rule)));
    rule.layers = 2;
    const std::vector<ScanLayer> one{layer};
    EXPECT_TRUE(Skin(layer, one, rule).whole());
    const std::vector<ScanLayer> two{layer, layer};
    EXPECT_TRUE(nothing(Skin(layer, two, rule)));
    const Layer empty = layer_of({{}});
    EXPECT_TRUE(nothing(Skin(empty, two, rule)));
    EXPECT_TRUE(nothing(Skin(Layer{}, one, rule)));
    const std::vector<ScanLayer> gone{layer, empty};
    const Skin all(layer, gone, rule);
    EXPECT_FALSE(all.whole());
    EXPECT_LT(difference(all.area(), offset(layer, rule.narrowest / 200)), 1e-6);
}

TEST(Skin, IsAllOfTheLayerBelowAndAboveAGap) {
    SkinRule rule;
    rule.layers = 2;
    const auto at = [](double bottom) {
        Layer layer = layer_of({rectangle(0, 0, 6, 6)});
        layer.bottom = bottom;
        layer.top = bottom + 0.1;
        return ScanLayer(layer);
    };
    const auto whole = [&](double first, double second) {
        return Skin(at(1), std::vector<ScanLayer>{at(first), at(second)}, rule).whole();
    };
    EXPECT_FALSE(whole(1.1, 1.2));
    EXPECT_FALSE(whole(1.1 + 1e-9, 1.2));
    EXPECT_TRUE(whole(1.1, 1.5));
    EXPECT_TRUE(whole(1.5, 1.6));
    EXPECT_FALSE(whole(0.9, 0.8));
    EXPECT_FALSE(whole(0.9, 0.8 - 1e-9));
    EXPECT_TRUE(whole(0.9, 0.5));
    EXPECT_TRUE(whole(0.5, 0.4));
}

} // namespace
} // namespace lamella
