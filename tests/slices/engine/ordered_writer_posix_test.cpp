#include "lamella/slices/layer_writer.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/sample_layers.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lamella::ordered_writer_posix_cases {
namespace {

TEST(LayerWriter, ReportsAFullDisk) {
    const LayerStack layers = square_with_hole();
    for (const LayerFormat& format : layer_formats()) {
        if (format.directory)
            continue;
        const std::string text = test::error_of(ErrorKind::output, [&] {
            write_layers("/dev/full", format, test::planes_of(layers), info_of(layers), options_for_any());
        });
        EXPECT_NE(text.find("disk is full"), std::string::npos) << text;
    }
}

} // namespace
} // namespace lamella::ordered_writer_posix_cases
