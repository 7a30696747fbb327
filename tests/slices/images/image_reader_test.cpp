// Readers of files with images, on what our writers make.

#include "lamella/contour/measure.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/raster/image.hpp"
#include "lamella/slices/resin_job.hpp"

#include "fixtures/expect_error.hpp"
#include "resin_jobs.hpp"
#include "slices/images/binary_fields.hpp"
#include "slices/images/display.hpp"
#include "slices/images/image_reader.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::image_reader_cases {
namespace {

using test::any_printer;

constexpr std::uint32_t columns = 60;
constexpr std::uint32_t rows = 45;

ResinPrinter printer_of(bool mirror_x, bool mirror_y) {
    ResinPrinter printer = any_printer;
    printer.pixels = {columns, rows};
    printer.display_mm = {30, 22.5};
    printer.mirror_x = mirror_x;
    printer.mirror_y = mirror_y;
    return printer;
}

/// Triangles without a symmetry, with edges that cover parts of pixels.
LayerStack triangles(std::size_t count) {
    LayerStack layers;
    for (std::size_t i = 0; i < count; ++i) {
        LayerBuilder builder;
        const double grown = 0.13 * static_cast<double>(i);
        add_contour(builder, {{0, 0}, {20.3, 2.1 + grown}, {3.7, 15.2 - grown}});
        const double bottom = 0.05 * static_cast<double>(i);
        layers.push_back(builder.finish(i, bottom + 0.025, bottom, bottom + 0.05));
    }
    return layers;
}

LayerFile read(const std::string& bytes, const std::string& name = "job", unsigned threads = 3) {
    return read_layers(std::as_bytes(std::span(bytes)), name, {}, {.threads = threads});
}

std::vector<std::uint8_t> values_of(const RunImage& image) {
    std::vector<std::uint8_t> values;
    for (const ImageRun& run : image.runs)
        values.resize(static_cast<std::size_t>(run.end), run.value);
    return values;
}

struct ImageFormatCase {
    std::string_view format;
    std::function<unsigned(unsigned)> shown; ///< the value that the file shows for a value of 8 bits
    std::uint32_t version = 0;               ///< of the printer
};

/// Adds up the images of four thresholds.
unsigned of_four_sets(unsigned v) {
    const unsigned sets = (v >= 63 ? 1 : 0) + (v >= 127 ? 1 : 0) + (v >= 191 ? 1 : 0) + (v >= 255 ? 1 : 0);
    return sets == 0 ? 0 : sets * 64 - 1;
}

std::vector<ImageFormatCase> cases() {
    const auto all = [](unsigned v) {
        return v;
    };
    const auto seven_bits = [](unsigned v) {
        return v < 2 ? 0 : v | 1U;
    };
    const auto four_bits = [](unsigned v) {
        return v / 16 * 17;
    };
    return {{"goo", all},
            {"ctb", seven_bits},
            {"ctb", seven_bits, 4},
            {"cbddlp", of_four_sets},
            {"anycubic", four_bits},
            {"anycubic", four_bits, 515},
            {"chitubox-zip", all},
            {"nanodlp", all},
            {"png-zip", all}};
}

TEST(ImageReaders, GiveTheImagesThatWereWritten) {
    const LayerStack layers = triangles(9);
    for (const ImageFormatCase& one : cases())
        for (const bool mirror_x : {true, false}) {
            SCOPED_TRACE(std::string(one.format));
            // An Anycubic file does not say whether its images are mirrored, and those of nearly all printers
            // are.
            ResinPrinter printer = printer_of(mirror_x || one.format == "anycubic", false);
            printer.version = one.version;
            const LayerFile file = read(job_of(one.format, layers, {.printer = &printer}));
            EXPECT_EQ(file.format, one.format);
            EXPECT_TRUE(file.warnings.empty());
            ASSERT_TRUE(file.grid && file.resin);
            ASSERT_EQ(file.planes.size(), layers.size());
            const PixelGrid grid = display_for(info_of(layers).box, {}, printer).grid(info_of(layers).box);
            std::uint64_t points = 0;
            for (std::size_t i = 0; i < layers.size(); ++i) {
                const Plane plane = file.plane(i);
                ASSERT_TRUE(plane.image);
                const GreyImage expected = paint({&layers[i], 1}, grid);
                std::vector<std::uint8_t> shown;
                for (const std::uint8_t value : expected.values)
                    shown.push_back(static_cast<std::uint8_t>(one.shown(value)));
                EXPECT_EQ(values_of(*plane.image), shown) << i;
                EXPECT_NEAR(file.planes[i].top, layers[i].top, 1e-9);
                EXPECT_NEAR(file.planes[i].z, layers[i].z, 1e-9);
                EXPECT_EQ(file.contents[i].points, plane.polylines.front().points.size());
                points += file.contents[i].points;
            }
            EXPECT_GT(points, 100U);
        }
}

TEST(ImageReaders, ShowThePartAsItWasSliced) {
    const LayerStack layers = triangles(4);
    for (const ImageFormatCase& one : cases()) {
        const bool knows = one.format != "anycubic";
        for (const bool mirror_y : {false, true}) {
            if (mirror_y && one.format != "goo" && one.format != "nanodlp" && one.format != "png-zip")
                continue;
            ResinPrinter printer = printer_of(knows ? mirror_y : true, mirror_y);
            printer.version = one.version;
            const LayerFile file = read(job_of(one.format, layers, {.printer = &printer}));
            const Box3 box = file.parts.front().box;
            const Box3 sliced = info_of(layers).box;
            // The corner of the triangle that is farthest to the right is at the bottom.
            double right = box.min.y;
            for (const Point2& p : file.plane(2).polylines.front().points)
                if (p.x > box.max.x - 0.75)
                    right = std::max(right, p.y);
            EXPECT_NEAR(measure(file.plane(2).polylines.front()).area_mm2, measure(layers[2]).area_mm2, 2);
            EXPECT_NEAR(right - box.min.y, 2.4, 0.8) << one.format;
            EXPECT_NEAR(box.max.x - box.min.x, sliced.max.x - sliced.min.x, 1);
        }
    }
}

TEST(ImageReaders, GiveTheSettingsThatWereWritten) {
    const LayerStack layers = triangles(9);
    ResinPrinter printer = printer_of(true, false);
    const LayerWriteOptions options{.printer = &printer,
                                    .resin = {.exposure_s = 2.25,
                                              .bottom_exposure_s = 31,
                                              .bottom_layers = 3,
                                              .transition_layers = 2,
                                              .price_per_litre = 40}};
    for (const ImageFormatCase& one : cases()) {
        if (one.format == "png-zip")
            continue;
        SCOPED_TRACE(std::string(one.format));
        printer.version = one.version;
        const LayerFile file = read(job_of(one.format, layers, options));
        const ResinJob& job = *file.resin;
        EXPECT_EQ(job.pixels.x, columns);
        EXPECT_EQ(job.pixels.y, rows);
        EXPECT_NEAR(job.display_mm.x, 30, 1e-4);
        EXPECT_NEAR(job.display_mm.y, 22.5, 1e-4);
        EXPECT_EQ(job.settings.exposure_s, 2.25);
        EXPECT_EQ(job.settings.bottom_exposure_s, 31);
        EXPECT_EQ(job.settings.bottom_layers, 3U);
        ASSERT_EQ(job.exposures_s.size(), layers.size());
        EXPECT_NEAR(job.exposures_s[0], 31, 1e-6);
        EXPECT_NEAR(job.exposures_s[4], 31 - 28.75 * 2 / 3, 1e-3);
        EXPECT_NEAR(job.exposures_s[8], 2.25, 1e-6);
        EXPECT_NEAR(job.volume_ml, 0.0675, 0.01);
        EXPECT_TRUE(settings_of(job, file.planes).ranges.empty() || job.settings.transition_layers == 0U)
            << "the rule gives the exposures if the file has it";
    }
}

TEST(ImageReaders, KeepMovementsInTwoStages) {
    const LayerStack layers = triangles(5);
    ResinPrinter printer = printer_of(true, false);
    const PlateTravel travel = staged_travel(3);
    const LayerWriteOptions options{.printer = &printer,
                                    .resin = {.bottom_travel = staged_travel(2), .travel = travel}};
    printer.version = 4;
    for (const std::string_view format : {"goo", "ctb"}) {
        const ResinSettings found = read(job_of(format, layers, options)).resin->settings;
        EXPECT_EQ(found.travel, travel) << format;
        EXPECT_EQ(found.bottom_travel.lift_mm, 2) << format;
    }
}

TEST(ImageReaders, ConvertPixelsAsTheyAre) {
    const LayerStack layers = triangles(2);
    const ResinPrinter printer = printer_of(true, false);
    for (const ImageFormatCase& from : cases())
        for (const ImageFormatCase& to : cases()) {
            SCOPED_TRACE(fmt::format("{} to {}", from.format, to.format));
            ResinPrinter first = printer;
            first.version = from.version;
            ResinPrinter second = printer;
            second.version = to.version;
            const LayerFile source = read(job_of(from.format, layers, {.printer = &first}));
            std::string bytes;
            LayerFileInfo info = info_of(source);
            ASSERT_TRUE(info.grid);
            info.memory = &bytes;
            const auto writer = open_layer_writer("job", layer_format(to.format, ""), info,
                                                  {.printer = &second,
                                                   .resin = settings_of(*source.resin, source.planes),
                                                   .resin_of_file = true});
            source.run(Stage::write, [&](std::size_t, const Plane& plane) { return writer->prepare(plane); });
            writer->finish();
            const LayerFile result = read(bytes);
            ASSERT_EQ(result.planes.size(), layers.size());
            EXPECT_EQ(display_of(*result.grid).mirror_x, true);
            for (std::size_t i = 0; i < layers.size(); ++i) {
                std::vector<std::uint8_t> expected = values_of(*source.plane(i).image);
                for (std::uint8_t& value : expected)
                    value = static_cast<std::uint8_t>(to.shown(value));
                EXPECT_EQ(values_of(*result.plane(i).image), expected) << i;
            }
        }
}

TEST(ImageReaders, MirrorPixelsForAnotherDisplay) {
    const LayerStack layers = triangles(3);
    const ResinPrinter plain = printer_of(false, false);
    const LayerFile source = read(job_of("goo", layers, {.printer = &plain}));
    for (const bool mirror_x : {false, true})
        for (const bool mirror_y : {false, true}) {
            const ResinPrinter other = printer_of(mirror_x, mirror_y);
            std::string bytes;
            LayerFileInfo info = info_of(source);
            info.memory = &bytes;
            write_layers("job", layer_format("goo", ""),
                         std::vector<Plane>{source.plane(0), source.plane(1), source.plane(2)}, info,
                         {.printer = &other});
            const LayerFile result = read(bytes);
            EXPECT_EQ(result.plane(1).polylines.front().points.size(),
                      source.plane(1).polylines.front().points.size());
            EXPECT_EQ(result.plane(1).polylines.front().points[0],
                      source.plane(1).polylines.front().points[0]);
            const std::vector<std::uint8_t> from = values_of(*source.plane(1).image);
            const std::vector<std::uint8_t> to = values_of(*result.plane(1).image);
            for (std::uint32_t r = 0; r < rows; ++r)
                for (std::uint32_t c = 0; c < columns; ++c)
                    ASSERT_EQ(to[(mirror_y ? rows - 1 - r : r) * columns + (mirror_x ? columns - 1 - c : c)],
                              from[r * columns + c]);
        }
}

TEST(ImageReaders, RefuseADisplayWithOtherPixels) {
    const ResinPrinter printer = printer_of(true, false);
    const LayerFile source = read(job_of("goo", triangles(2), {.printer = &printer}));
    const auto refusal = [&](const ResinPrinter& other) {
        std::string bytes;
        LayerFileInfo info = info_of(source);
        info.memory = &bytes;
        info.printer = "Tester";
        return test::error_of(ErrorKind::usage, [&] {
            static_cast<void>(open_layer_writer("job", layer_format("goo", ""), info, {.printer = &other}));
        });
    };
    ResinPrinter wider = printer;
    wider.name = "Wide";
    wider.pixels.x = 61;
    EXPECT_NE(
        refusal(wider).find("the images of the file (Tester) have 60 x 45 pixels, and Wide has 61 x 45"),
        std::string::npos)
        << refusal(wider);
    ResinPrinter larger = printer;
    larger.display_mm = {33, 22.5};
    EXPECT_NE(refusal(larger).find("the part would get another size"), std::string::npos);
}

TEST(ImageReaders, ReadSl1WithItsDisplay) {
    LayerStack layers = triangles(12);
    for (const std::string_view format : {"sl1", "sl1s"}) {
        const ResinPrinter* const printer =
            &find_resin_printer(format == "sl1" ? "Original Prusa SL1" : "Original Prusa SL1S");
        const LayerFile file = read(job_of(format, layers, {.printer = printer}));
        EXPECT_EQ(file.format, format);
        EXPECT_EQ(file.planes.size(), 12U);
        EXPECT_EQ(display_of(*file.grid).portrait, printer->portrait);
        EXPECT_EQ(display_of(*file.grid).pixels.x, printer->pixels.x);
        EXPECT_NEAR(file.planes.back().top, 0.6, 1e-9);
        const PixelGrid grid = display_for(info_of(layers).box, {}, *printer).grid(info_of(layers).box);
        const GreyImage expected = paint({&layers[5], 1}, grid);
        EXPECT_EQ(values_of(*file.plane(5).image), expected.values);
    }
}

/// A .photon file of version 1 with two layers of 4 x 3 pixels. The heights are those of bottoms, and the
/// first image has this code.
std::string photon_of(const std::string& code) {
    BinaryFields file(ByteOrder::little);
    file.u32(0x12FD0019).u32(1).f32(4).f32(3).f32(100).zeros(12).f32(0.05).f32(5).f32(50).f32(1).u32(1);
    file.u32(4).u32(3).u32(0).u32(108).u32(2).u32(0).u32(60).u32(1).zeros(108 - 0x54);
    file.f32(0).f32(50).f32(1).u32(180).u32(code.size()).zeros(16);
    file.f32(0.05).f32(5).f32(1).u32(180 + code.size()).u32(1).zeros(16);
    file.raw(code).raw("\x8c");
    return std::string(file.view());
}

TEST(ImageReaders, TakeAMissingLastPixelForBlack) {
    const LayerFile whole = read(photon_of("\x03\x89"));
    EXPECT_TRUE(whole.warnings.empty());
    EXPECT_EQ(whole.planes[1].top, 0.1);
    EXPECT_EQ(whole.resin->exposures_s, (std::vector<double>{50, 5}));
    const LayerFile file = read(photon_of("\x03\x88"));
    ASSERT_EQ(file.warnings.size(), 1U);
    EXPECT_EQ(file.warnings.front(), "1 image lacks its last pixel, which is taken for black (layer 0)");
    EXPECT_EQ(values_of(*file.plane(0).image).back(), 0);
    test::expect_error(
        ErrorKind::input,
        {"job, layer 0, byte 180: found an image of 10 pixels; the display has 4 x 3, which is 12"},
        [] { static_cast<void>(read(photon_of("\x03\x87"))); });
    test::expect_error(ErrorKind::input,
                       {"job, layer 0, byte 181: found a run of 10 pixels; the image has only 9"},
                       [] { static_cast<void>(read(photon_of("\x03\x8a"))); });
}

TEST(ImageReaders, RefuseEncryptedFilesInOneLine) {
    std::string file(200, '\0');
    file.replace(0, 4, "\x07\x01\xFD\x12");
    test::expect_error(ErrorKind::input, {"job: found an encrypted .ctb file, which is not read here"},
                       [&] { static_cast<void>(read(file)); });
}

TEST(ImageReaders, SayWhichLayerIsDamaged) {
    const ResinPrinter printer = printer_of(true, false);
    std::string goo = job_of("goo", triangles(5), {.printer = &printer});
    const std::size_t last = goo.size() - 11 - 2 - 1; // the checksum of the last image
    goo[last] = static_cast<char>(goo[last] ^ 1);
    for (const unsigned threads : {1U, 4U})
        test::expect_error(ErrorKind::input,
                           {fmt::format("job, layer 4, byte {}: found the checksum", last).c_str()},
                           [&] { static_cast<void>(read(goo, "job", threads)); });
    std::string many = job_of("goo", triangles(5), {.printer = &printer});
    many.replace(195310, 4, "\x7f\xff\xff\xff");
    test::expect_error(ErrorKind::input, {"byte 195310: found 2147483647 layers"},
                       [&] { static_cast<void>(read(many)); });
}

TEST(ImageReaders, MakeContoursAndPixelsOfOnePart) {
    const ResinPrinter printer = printer_of(true, false);
    const LayerFile file = read(job_of("goo", triangles(3), {.printer = &printer}));
    EXPECT_TRUE(with_parts(file, {0}).plane(0).image);
    EXPECT_FALSE(with_parts(file, {}).grid);
    const LayerPart part = file.in_memory().front();
    EXPECT_EQ(part.layers[1].points.size(), file.plane(1).polylines.front().points.size());
}

} // namespace
} // namespace lamella::image_reader_cases
