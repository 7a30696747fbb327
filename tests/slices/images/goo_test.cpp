#include "resin_jobs.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lamella::goo_cases {
namespace {

constexpr std::size_t first_layer = 195477;

/// 2 x 2 pixels in the middle of 8 x 4, without anti-aliasing.
const std::string image("\x55\x0B\xC2\x06\xC2\x0B\x5F", 7);

LayerWriteOptions goo_options() {
    return {.image = {.raster = {.antialias = 1}},
            .printer = &tiny_printer,
            .resin = {.bottom_travel = staged_travel(2),
                      .travel = staged_travel(3),
                      .bottom_light_power = 200,
                      .light_power = 100,
                      .price_per_litre = 50,
                      .currency = "EUR"}};
}

TEST(Goo, HasTheFieldsOfItsSpecification) {
    const std::string file = job_of("goo", squares(4), goo_options());
    const FieldsOfFile fields(file, true);
    EXPECT_EQ(file.substr(0, 12), std::string("V3.0\x07\0\0\0DLP\0", 12));
    EXPECT_EQ(file.substr(124, 12), std::string("ELEGOO Tiny\0", 12));
    EXPECT_EQ(file.substr(27106, 2) + file.substr(195308, 2), "\r\n\r\n");
    EXPECT_EQ(fields.number(195310), 4U);
    EXPECT_EQ(fields.number(195314, 2), 8U);
    EXPECT_EQ(fields.number(195316, 2), 4U);
    EXPECT_EQ(fields.number(195318, 2), 0x0100U) << "mirrored along x";
    EXPECT_EQ(fields.reals(195320, 5), (std::vector<float>{8, 4, 10, 0.5F, 2}));
    EXPECT_EQ(fields.number(195340, 1), 1U) << "waits";
    EXPECT_EQ(fields.reals(195341, 8), (std::vector<float>{0, 0.25F, 0.5F, 1, 0.25F, 0.5F, 1, 20}));
    EXPECT_EQ(fields.number(195373), 2U);
    EXPECT_EQ(fields.reals(195377, 16),
              (std::vector<float>{2, 60, 3, 60, 5, 180, 6, 180, 4, 240, 4, 240, 1, 30, 1, 30}));
    EXPECT_EQ(fields.number(195441), 200U << 16U | 100U);
    EXPECT_EQ(fields.number(195445, 1), 1U) << "each layer has its own settings";
    EXPECT_NEAR(fields.real(195450), 8, 1e-5); // four layers of 2 x 2 x 0.5 mm
    EXPECT_NEAR(fields.real(195454), 0.0088, 1e-7);
    EXPECT_NEAR(fields.real(195458), 0.0004, 1e-8);
    EXPECT_EQ(file.substr(195462, 8), std::string("EUR\0\0\0\0\0", 8));
    EXPECT_EQ(fields.number(195470), first_layer);
    EXPECT_EQ(file.substr(195474, 3), std::string("\1\0\0", 3));
    EXPECT_EQ(file.substr(file.size() - 11), std::string("\0\0\0\7\0\0\0DLP\0", 11));
}

TEST(Goo, HasLayersWithTheirOwnSettings) {
    const std::string file = job_of("goo", squares(4), goo_options());
    const FieldsOfFile fields(file, true);
    const std::size_t size = 70 + image.size() + 2;
    ASSERT_EQ(file.size(), first_layer + 4 * size + 11);
    const float exposures[] = {20, 20, 11, 2};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t at = first_layer + i * size;
        const float top = 0.5F * static_cast<float>(i + 1);
        const float lift = i < 2 ? 2 : 3;
        EXPECT_EQ(fields.reals(at + 2, 15), (std::vector<float>{top, top, exposures[i], 0, 0.25F, 0.5F, 1,
                                                                lift, 60, 4, 240, lift + 3, 180, 1, 30}));
        EXPECT_EQ(fields.number(at + 62, 2), i < 2 ? 200U : 100U);
        EXPECT_EQ(fields.number(at + 66), image.size());
        EXPECT_EQ(file.substr(at + 70, image.size()), image);
    }
}

TEST(Goo, UsesTheTimeWithoutLightInsteadOfWaits) {
    LayerWriteOptions options = goo_options();
    options.resin.light_off_s = 7;
    const std::string file = job_of("goo", squares(1), options);
    const FieldsOfFile fields(file, true);
    EXPECT_EQ(fields.number(195340, 1), 0U);
    EXPECT_EQ(fields.reals(195341, 7), (std::vector<float>{7, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(fields.reals(first_layer + 14, 4), (std::vector<float>{7, 0, 0, 0}));
}

} // namespace
} // namespace lamella::goo_cases
