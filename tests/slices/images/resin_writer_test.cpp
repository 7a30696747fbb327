#include "fixtures/expect_error.hpp"
#include "resin_jobs.hpp"
#include "slices/images/resin_writer.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace lamella::resin_writer_cases {
namespace {

/// Formats for printers.
std::vector<std::string_view> printer_formats() {
    std::vector<std::string_view> names;
    for (const LayerFormat& format : layer_formats())
        if (format.exposure)
            names.push_back(format.name);
    return names;
}

std::string refusal(std::string_view format, const LayerStack& layers,
                    const LayerWriteOptions& options = {}) {
    return test::error_of(ErrorKind::usage, [&] { static_cast<void>(job_of(format, layers, options)); });
}

TEST(ResinWriter, RefusesPartsThatAreTooHigh) {
    LayerStack layers = squares(2);
    layers[1].z = 6;
    layers[1].top = 11.5;
    for (const std::string_view format : printer_formats())
        EXPECT_NE(refusal(format, layers)
                      .find("the part is 10.5 mm high, and the Elegoo Tiny makes parts of up to "
                            "10 mm: it is 0.5 mm too high"),
                  std::string::npos);
}

TEST(ResinWriter, RefusesGapsBetweenLayers) {
    LayerStack layers = squares(3);
    layers[2].bottom += 0.25;
    layers[2].z += 0.25;
    layers[2].top += 0.25;
    ResinPrinter printer = tiny_printer;
    printer.bottom_layers = 3;
    for (const std::string_view format : printer_formats())
        EXPECT_NE(refusal(format, layers, {.printer = &printer}).find("layer 2 begins at 2.25 mm"),
                  std::string::npos);
}

TEST(ResinWriter, TakesLayersOfAnyHeightWhereTheFormatDoes) {
    LayerStack layers = squares(3);
    layers[2].top += 0.25;
    ResinPrinter printer = tiny_printer;
    printer.bottom_layers = 3;
    for (const std::string_view format : printer_formats()) {
        if (format == "goo" || format == "ctb" || format == "cbddlp" || format == "anycubic" ||
            format == "chitubox-zip")
            EXPECT_NE(job_of(format, layers, {.printer = &printer}), "");
        else
            EXPECT_NE(refusal(format, layers, {.printer = &printer}).find("has one layer height"),
                      std::string::npos);
    }
}

TEST(ResinWriter, RefusesRangesWhereThereIsOneExposure) {
    ResinPrinter printer = tiny_printer;
    printer.bottom_layers = 3;
    for (const std::string_view format : {"sl1", "nanodlp"})
        EXPECT_NE(refusal(format, squares(2), {.printer = &printer, .resin = {.ranges = {{0, 1, 3}}}})
                      .find("has one exposure for all layers above the first ones"),
                  std::string::npos);
}

TEST(PrinterFor, SaysWhatIsMissing) {
    const auto text = [](const LayerWriteOptions& options) {
        return test::error_of(ErrorKind::usage, [&] { static_cast<void>(printer_for({}, options, "goo")); });
    };
    EXPECT_NE(text({}).find("give `printer`, or `pixels` and `display_mm`"), std::string::npos);
    EXPECT_NE(text({.image = {.pixel_mm = {{0.1, 0.1}}}}).find("`printer`"), std::string::npos);
    EXPECT_TRUE(printer_for({}, {.image = {.pixels = {{80, 40}}}}, "goo").mirror_x);
    const LayerWriteOptions other{.printer = &find_resin_printer("Mono X")};
    EXPECT_NE(
        text(other).find("the Anycubic Photon Mono X reads files of the format anycubic (.pwmx), not goo"),
        std::string::npos);
}

TEST(MachineName, IsWrittenAsTheMakerDoes) {
    EXPECT_EQ(machine_name_of({}, tiny_printer), "ELEGOO Tiny");
    EXPECT_EQ(machine_name_of({}, find_resin_printer("Mono X")), "Anycubic Photon Mono X");
}

} // namespace
} // namespace lamella::resin_writer_cases
