#include "resin_jobs.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lamella::chitubox_zip_cases {
namespace {

TEST(ChituboxZip, HasTheMovementsOfTheLayersAsMachineCode) {
    LayerWriteOptions options{
        .printer = &tiny_printer,
        .resin = {.bottom_travel = staged_travel(2), .travel = staged_travel(3), .light_power = 100}};
    const std::string code = entry_of(job_of("chitubox-zip", squares(4), options), "run.gcode");
    for (const char* line : {";machineType:Elegoo Tiny\n", ";layerHeight:0.5\n", ";resolutionX:8\n",
                             ";machineZ:10\n", ";normalExposureTime:2\n", ";bottomLayerExposureTime:20\n",
                             ";bottomLayerCount:2\n", ";mirror:1\n", ";totalLayer:4\n"})
        EXPECT_NE(code.find(line), std::string::npos) << line;
    const std::size_t third = code.find(";LAYER_START:2");
    ASSERT_NE(third, std::string::npos);
    EXPECT_EQ(code.substr(third, code.find(";LAYER_START:3") - third),
              ";LAYER_START:2\n;currPos:1.5000\nM6054 \"3.png\";show image\n"
              "G4 P250;\nG0 Z4.0000 F60;\nG0 Z8.0000 F240;\nG4 P500;\nG0 Z2.5000 F180;\nG0 Z1.5000 F30;\n"
              "G4 P1000;\nM106 S100;light on\nG4 P11000;\nM106 S0;light off\n;LAYER_END\n\n");
}

} // namespace
} // namespace lamella::chitubox_zip_cases
