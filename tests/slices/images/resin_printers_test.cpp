#include "lamella/slices/layer_writer.hpp"
#include "lamella/slices/resin_printer.hpp"

#include "fixtures/expect_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

namespace lamella::resin_printers_cases {
namespace {

TEST(ResinPrinters, ReadFormatsThatAreWritten) {
    std::set<std::string_view> names;
    for (const ResinPrinter& printer : resin_printers()) {
        SCOPED_TRACE(printer.name);
        EXPECT_TRUE(names.insert(printer.name).second);
        const LayerFormat& format = layer_format(printer.format, "");
        EXPECT_TRUE(format.image && format.exposure);
        if (printer.extension != ".zip") {
            EXPECT_EQ(layer_format("", "job" + std::string(printer.extension)).name, printer.format);
        }
        EXPECT_GT(printer.height_mm, 100);
        // Pixels are nearly square.
        const double x = printer.display_mm.x / printer.pixels.x;
        const double y = printer.display_mm.y / printer.pixels.y;
        EXPECT_TRUE(std::abs(x - y) < 0.3 * x || printer.name == "Wanhao CGR Mono") << x << ' ' << y;
        EXPECT_LT(printer.exposure_s, printer.bottom_exposure_s);
    }
    EXPECT_GT(names.size(), 60U);
}

TEST(ResinPrinters, AreFoundByNameOrAPartOfIt) {
    for (const ResinPrinter& printer : resin_printers())
        EXPECT_EQ(&find_resin_printer(printer.name), &printer);
    EXPECT_EQ(find_resin_printer("elegoo MARS 4").name, "Elegoo Mars 4");
    EXPECT_EQ(find_resin_printer("mars 4").name, "Elegoo Mars 4") << "although others begin with this";
    EXPECT_EQ(find_resin_printer("SL1").name, "Original Prusa SL1");
    EXPECT_EQ(find_resin_printer("4 max").name, "Elegoo Mars 4 Max");
    EXPECT_EQ(find_resin_printer("ibee").name, "Uniz IBEE (Klipper)");
}

TEST(ResinPrinters, SaysWhichMayBeMeant) {
    const auto refusal = [](const char* name) {
        return test::error_of(ErrorKind::usage, [&] { static_cast<void>(find_resin_printer(name)); });
    };
    EXPECT_NE(refusal("saturn 3 u x").find("Elegoo Saturn 3"), std::string::npos);
    EXPECT_NE(refusal("Mras 4").find("did you mean Elegoo Mars 4?"), std::string::npos);
    EXPECT_NE(refusal("photon mono ").find("several printers: Anycubic Photon Mono 4K"), std::string::npos);
    EXPECT_NE(refusal("a").find(" more"), std::string::npos);
    EXPECT_LT(refusal("a").size(), 450U);
    EXPECT_NE(refusal("").find("give a part of its name"), std::string::npos);
    EXPECT_NE(refusal("typewriter").find("there is no printer 'typewriter'"), std::string::npos);
}

} // namespace
} // namespace lamella::resin_printers_cases
