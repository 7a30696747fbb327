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
TEST(Skin, IsWhatSomeNeighbourGrownHasNot) {
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
        std::vector<Layer> neighbours;
        Layer open;
        for (std::uint32_t k = 0; k < rule.layers; ++k) {
            neighbours.push_back(plate.layer(random, slope));
            const double grown = rule.narrowest * (1 + 0.01 * k / rule.layers);
            const Layer beyond = combine(layer, offset(neighbours.back(), grown), BooleanOperation::subtract);
            open = combine(open, beyond, BooleanOperation::unite);
        }
        const Layer area = offset(layer, -0.2);
        const Skin found(layer, neighbours, rule);
        const Layer of =
            combine(area, offset(open, rule.narrowest + rule.overlap), BooleanOperation::intersect);
        const Layer rest_of = combine(area, offset(open, rule.narrowest), BooleanOperation::subtract);
        EXPECT_LT(difference(found.of(area), of), 1e-6) << round;
        EXPECT_LT(difference(found.rest_of(area), rest_of), 1e-6) << round;
        skin += measure(of).area_mm2;
        rest += measure(rest_of).area_mm2;
    }
    EXPECT_GT(skin, 0);
    EXPECT_GT(rest, 0);
}

TEST(Skin, IsAllOfTheLayerWhereThePartEndsAndNothingWithoutARule) {
    const Layer layer = layer_of({rectangle(0, 0, 6, 6)});
    const Layer area = offset(layer, -1);
    SkinRule rule;
    EXPECT_EQ(Skin(layer, {}, rule).of(area).rings, 0U);
    EXPECT_TRUE(same_contours(Skin(layer, {}, rule).rest_of(area), area));
    rule.layers = 2;
    const std::vector<Layer> one{layer};
    EXPECT_TRUE(same_contours(Skin(layer, one, rule).of(area), area));
    EXPECT_EQ(Skin(layer, one, rule).rest_of(area).rings, 0U);
    const std::vector<Layer> two{layer, layer};
    EXPECT_EQ(Skin(layer, two, rule).of(area).rings, 0U);
    EXPECT_TRUE(same_contours(Skin(layer, two, rule).rest_of(area), area));
    const Layer empty = layer_of({{}});
    EXPECT_EQ(Skin(empty, two, rule).of(Layer{}).rings, 0U);
    EXPECT_EQ(Skin(Layer{}, one, rule).of(Layer{}).rings, 0U);
    const std::vector<Layer> gone{layer, empty};
    EXPECT_TRUE(same_contours(Skin(layer, gone, rule).of(area), area));
}

} // namespace
} // namespace lamella
