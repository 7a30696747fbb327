#include "resin_jobs.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lamella::anycubic_cases {
namespace {

LayerWriteOptions options_of(const ResinPrinter& printer) {
    return {.image = {.raster = {.antialias = 1}},
            .printer = &printer,
            .resin = {.bottom_travel = staged_travel(2), .travel = staged_travel(3)}};
}

const std::string image("\x00\x0B\xF0\x02\x00\x06\xF0\x02\x00\x0B", 10);

TEST(Anycubic, HasTheTablesOfVersion516) {
    const std::string file = job_of("anycubic", squares(4), options_of(tiny_printer));
    const FieldsOfFile fields(file, false);
    EXPECT_EQ(file.substr(0, 12), std::string("ANYCUBIC\0\0\0\0", 12));
    EXPECT_EQ(fields.number(12), 516U);
    EXPECT_EQ(fields.number(16), 8U);
    const std::size_t header = fields.number(20);
    EXPECT_EQ(file.substr(header, 6), "HEADER");
    EXPECT_EQ(fields.number(header + 12), 84U);
    EXPECT_EQ(fields.reals(header + 16, 9), (std::vector<float>{1000, 0.5F, 2, 1, 20, 2, 7, 1, 0.5F}));
    EXPECT_NEAR(fields.real(header + 52), 0.008, 1e-7);
    EXPECT_EQ(fields.number(header + 60), 8U);
    EXPECT_EQ(fields.number(header + 64), 4U);
    EXPECT_EQ(fields.number(header + 80), 0U) << "the settings of all layers follow from these";
    EXPECT_EQ(fields.number(header + 88), 1U) << "layers of transition";
    EXPECT_EQ(fields.number(header + 96), 1U) << "two stages";
    const std::size_t extra = fields.number(40);
    EXPECT_EQ(file.substr(extra, 5), "EXTRA");
    EXPECT_EQ(fields.reals(extra + 20, 6), (std::vector<float>{2, 1, 3, 4, 4, 0.5F}));
    EXPECT_EQ(fields.reals(extra + 48, 6), (std::vector<float>{3, 1, 3, 4, 4, 0.5F}));
    const std::size_t machine = fields.number(44);
    EXPECT_EQ(file.substr(machine + 16, 12), std::string("ELEGOO Tiny\0", 12));
    EXPECT_EQ(file.substr(machine + 112, 6), "pw0Img");
    EXPECT_EQ(fields.reals(machine + 136, 3), (std::vector<float>{8, 4, 10}));
    EXPECT_EQ(fields.number(48), machine + 156);
    EXPECT_EQ(file.substr(fields.number(28), 7), "PREVIEW");
}

TEST(Anycubic, HasLayersWithTheirThicknessAndExposure) {
    const std::string file = job_of("anycubic", squares(4), options_of(tiny_printer));
    const FieldsOfFile fields(file, false);
    const std::size_t table = fields.number(36);
    EXPECT_EQ(file.substr(table, 8), "LAYERDEF");
    EXPECT_EQ(fields.number(table + 12), 4U + 4 * 32);
    EXPECT_EQ(fields.number(table + 16), 4U);
    const float exposures[] = {20, 20, 11, 2};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t entry = table + 20 + 32 * i;
        EXPECT_EQ(file.substr(fields.number(entry), fields.number(entry + 4)), image);
        EXPECT_EQ(fields.reals(entry + 8, 4), (std::vector<float>{i < 2 ? 6.F : 7.F, 1, exposures[i], 0.5F}));
        EXPECT_EQ(fields.number(entry + 24), 4U) << "pixels that are not black";
    }
    EXPECT_EQ(file.size(), fields.number(48) + 4 * image.size());
}

TEST(Anycubic, HasOneStageAndFewerTablesInVersion515) {
    ResinPrinter printer = tiny_printer;
    printer.version = 515;
    const std::string file = job_of("anycubic", squares(4), options_of(printer));
    const FieldsOfFile fields(file, false);
    EXPECT_EQ(fields.number(12), 515U);
    EXPECT_EQ(fields.number(16), 5U);
    EXPECT_EQ(fields.number(20), 48U);
    EXPECT_EQ(fields.number(48 + 12), 80U);
    EXPECT_EQ(fields.reals(48 + 16 + 24, 3), (std::vector<float>{7, 1, 0.5F}));
    EXPECT_EQ(fields.number(40), 0U) << "no table of stages";
    EXPECT_EQ(file.size(), fields.number(44) + 4 * image.size());
}

TEST(Anycubic, SaysThatLayersHaveSettingsOfTheirOwnIfRangesDo) {
    LayerWriteOptions options = options_of(tiny_printer);
    options.resin.ranges = {{1, 1.5, 5}};
    const std::string file = job_of("anycubic", squares(4), options);
    const FieldsOfFile fields(file, false);
    EXPECT_EQ(fields.number(fields.number(20) + 80), 1U);
    EXPECT_EQ(fields.number(fields.number(20) + 88), 0U);
    EXPECT_EQ(fields.real(fields.number(36) + 20 + 64 + 16), 5);
}

} // namespace
} // namespace lamella::anycubic_cases
