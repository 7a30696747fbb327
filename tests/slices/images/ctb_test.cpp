#include "resin_jobs.hpp"
#include "slices/images/run_codes.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lamella::ctb_cases {
namespace {

LayerWriteOptions options_of(const ResinPrinter& printer, unsigned antialias = 1) {
    return {.image = {.raster = {.antialias = antialias}},
            .printer = &printer,
            .resin = {.bottom_travel = staged_travel(2), .travel = staged_travel(3), .light_power = 100}};
}

/// The first image, decrypted.
std::string first_image(const std::string& file) {
    const FieldsOfFile fields(file, false);
    const std::size_t table = fields.number(0x40);
    std::string image = file.substr(fields.number(table + 12), fields.number(table + 16));
    apply_ctb_cipher(fields.number(0x64), 0, image.data(), image.size());
    return image;
}

TEST(Ctb, HasTheFieldsOfVersion3) {
    const std::string file = job_of("ctb", squares(4), options_of(tiny_printer));
    const FieldsOfFile fields(file, false);
    EXPECT_EQ(fields.number(0), 0x12FD0086U);
    EXPECT_EQ(fields.number(4), 3U);
    EXPECT_EQ(fields.reals(8, 3), (std::vector<float>{8, 4, 10}));
    EXPECT_EQ(fields.reals(0x1c, 5), (std::vector<float>{2, 0.5F, 2, 20, 0}));
    EXPECT_EQ(fields.number(0x30), 2U);
    EXPECT_EQ(fields.number(0x34), 8U);
    EXPECT_EQ(fields.number(0x38), 4U);
    EXPECT_EQ(fields.number(0x44), 4U);
    EXPECT_EQ(fields.number(0x50), 1U);
    EXPECT_EQ(fields.number(0x60), 255U << 16U | 100U);
    EXPECT_NE(fields.number(0x64), 0U);
    // One stage, at the lower speed.
    const std::size_t print = fields.number(0x54);
    EXPECT_EQ(fields.reals(print, 5), (std::vector<float>{6, 60, 7, 60, 30}));
    const std::size_t slicer = fields.number(0x68);
    EXPECT_EQ(fields.reals(slicer, 7), std::vector<float>(7));
    EXPECT_EQ(file.substr(fields.number(slicer + 0x1c), fields.number(slicer + 0x20)), "ELEGOO Tiny");
    EXPECT_EQ(fields.number(slicer + 0x27, 1), 0x30U);
    EXPECT_EQ(fields.reals(slicer + 0x34, 2), (std::vector<float>{1, 0.5F}));
    EXPECT_EQ(fields.number(slicer + 0x40), 0U);
    EXPECT_EQ(first_image(file), "\x80\x0B\xFF\x02\x80\x06\xFF\x02\x80\x0B");
}

TEST(Ctb, HasARecordBeforeEachImage) {
    const std::string file = job_of("ctb", squares(4), options_of(tiny_printer));
    const FieldsOfFile fields(file, false);
    const float exposures[] = {20, 20, 11, 2};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t entry = fields.number(0x40) + 36 * i;
        EXPECT_EQ(fields.reals(entry, 3),
                  (std::vector<float>{0.5F * static_cast<float>(i + 1), exposures[i], 0}));
        const std::size_t record = fields.number(entry + 12) - 84;
        EXPECT_EQ(fields.number(entry + 24), 84U);
        EXPECT_EQ(file.substr(record, 36), file.substr(entry, 36));
        EXPECT_EQ(fields.number(record + 36), 84 + fields.number(entry + 16));
        EXPECT_EQ(fields.reals(record + 40, 9),
                  (std::vector<float>{i < 2 ? 6.F : 7.F, 60, 0, 0, 30, 0, 0, 0.25F, 0.5F}));
        EXPECT_EQ(fields.real(record + 80), i < 2 ? 255 : 100);
    }
}

TEST(Ctb, HasStagesInVersion4) {
    ResinPrinter printer = tiny_printer;
    printer.version = 4;
    const std::string file = job_of("ctb", squares(4), options_of(printer));
    const FieldsOfFile fields(file, false);
    EXPECT_EQ(fields.number(0), 0x12FD0106U);
    EXPECT_EQ(fields.number(4), 4U);
    const std::size_t slicer = fields.number(0x68);
    EXPECT_EQ(fields.reals(slicer, 6), (std::vector<float>{4, 240, 4, 240, 1, 30}));
    const std::size_t block = fields.number(slicer + 0x40);
    EXPECT_EQ(fields.reals(block, 2), (std::vector<float>{180, 30}));
    EXPECT_EQ(fields.reals(block + 24, 4), (std::vector<float>{1, 0.5F, 0.25F, 1}));
    EXPECT_EQ(fields.number(block + 52), 3U) << "the last layer";
    EXPECT_EQ(fields.number(block + 72), 0U) << "no text";
    EXPECT_EQ(fields.number(0x40), block + 464);
    const std::size_t record = fields.number(fields.number(0x40) + 12) - 84;
    EXPECT_EQ(fields.reals(record + 40, 11),
              (std::vector<float>{6, 60, 4, 240, 180, 1, 30, 0.25F, 0.5F, 1, 255}));
}

TEST(Cbddlp, HasOneSetOfImagesWithoutAntiAliasing) {
    const std::string file = job_of("cbddlp", squares(3), options_of(tiny_printer));
    const FieldsOfFile fields(file, false);
    EXPECT_EQ(fields.number(0), 0x12FD0019U);
    EXPECT_EQ(fields.number(4), 2U);
    EXPECT_EQ(fields.number(0x5c), 1U);
    EXPECT_EQ(fields.number(0x64), 0U);
    EXPECT_EQ(fields.number(0x68), 0U);
    EXPECT_EQ(fields.real(0x2c), 1) << "the wait after the way back";
    EXPECT_EQ(first_image(file), "\x0B\x82\x06\x82\x0B");
}

TEST(Cbddlp, HasASetOfImagesForEachShade) {
    // One pixel lacks a quarter, so it is white in all sets but the first.
    LayerBuilder builder;
    add_contour(builder, {{0, 0}, {2, 0}, {2, 2}, {1.25, 2}, {1.25, 1}, {1, 1}, {1, 2}, {0, 2}});
    const LayerStack layers{builder.finish(0, 0.25, 0, 0.5)};
    const std::string file = job_of("cbddlp", layers, options_of(tiny_printer, 8));
    const FieldsOfFile fields(file, false);
    ASSERT_EQ(fields.number(0x5c), 4U);
    const std::size_t table = fields.number(0x40);
    std::vector<std::string> images;
    for (std::size_t set = 0; set < 4; ++set)
        images.push_back(
            file.substr(fields.number(table + 36 * set + 12), fields.number(table + 36 * set + 16)));
    EXPECT_NE(images[0], images[1]);
    EXPECT_EQ(images[1], images[3]);
    EXPECT_EQ(fields.number(table + 36 + 12), fields.number(table + 3 * 36 + 12))
        << "equal images are stored once";
}

} // namespace
} // namespace lamella::ctb_cases
