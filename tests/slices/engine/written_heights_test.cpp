#include "lamella/slices/layer_writer.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/sample_layers.hpp"
#include "plain_formats.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lamella {
namespace {

using test::error_of;

TEST(LayerWriter, RefusesPlanesThatIltReadersWouldTakeForOne) {
    const TemporaryFolder folder;
    LayerStack layers = square_with_hole();
    for (const auto& [thickness, fits] : {std::pair{9e-6, false}, {5e-5, true}}) {
        layers[1].bottom = layers[0].top;
        layers[1].top = layers[0].top + thickness;
        layers[1].z = layers[0].top + thickness / 2;
        const auto write = [&] {
            write_layers(folder.file("a.ilt"), layer_format("ilt", ""), test::planes_of(layers),
                         info_of(layers));
        };
        if (fits)
            EXPECT_NO_THROW(write());
        else
            EXPECT_NE(error_of(ErrorKind::usage, write).find("layer 1: its top"), std::string::npos);
    }
}

TEST(LayerWriter, RefusesHeightsThatTheFileCannotDistinguishOrHold) {
    const TemporaryFolder folder;
    for (const LayerFormat* format : plain_formats()) {
        const auto error_at = [&](double bottom, double thickness) {
            LayerStack layers = square_with_hole();
            layers.pop_back();
            layers[0].bottom = bottom;
            layers[0].top = layers[0].z = bottom + thickness;
            return error_of(ErrorKind::usage, [&] {
                write_layers(folder.file("out"), *format, test::planes_of(layers), info_of(layers),
                             options_for_any());
            });
        };
        if (is_one_of(format->name, {"cli", "slc", "ilt", "ovf"})) {
            EXPECT_NE(error_at(1e39, 1e38).find("beyond single precision"), std::string::npos)
                << format->name;
        }
        if (is_one_of(format->name, {"cli", "cli-ascii", "slc", "3mf", "ilt", "ovf", "3mf-toolpath"})) {
            EXPECT_TRUE(contains(error_at(1, 0), "layer 0: its top")) << format->name;
            EXPECT_TRUE(contains(error_at(1, 0), "a layer has no thickness")) << format->name;
        }
        if (is_one_of(format->name, {"cli", "slc", "ilt"})) {
            EXPECT_NE(error_at(1e6, 0.01).find("layer 0: its top"), std::string::npos) << format->name;
        }
        if (format->name == "cli-ascii") {
            EXPECT_NE(error_at(1, 1e-10).find("layer 0: its top"), std::string::npos);
        }
    }
}

} // namespace
} // namespace lamella
