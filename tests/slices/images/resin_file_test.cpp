#include "resin_jobs.hpp"
#include "slices/images/resin_file.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lamella::resin_file_cases {
namespace {

TEST(ResinFile, HasTheSameBytesInWhateverOrderLayersAreMade) {
    const LayerStack layers = squares(6);
    const LayerWriteOptions options{.printer = &tiny_printer};
    for (const char* format : {"goo", "ctb", "cbddlp", "anycubic"}) {
        const std::string expected = job_of(format, layers);
        std::string bytes;
        LayerFileInfo info = info_of(layers);
        info.memory = &bytes;
        const auto writer = open_layer_writer("job", layer_format(format, ""), info, options);
        std::vector<Commit> ready(layers.size());
        for (std::size_t i = layers.size(); i-- > 0;)
            ready[i] = writer->prepare(layers[i]);
        for (const Commit& write : ready)
            write();
        writer->finish();
        EXPECT_TRUE(bytes == expected) << format;
    }
}

TEST(ResinFile, CountsLayersByTheirPositionWhateverTheirIndices) {
    LayerStack layers = squares(6);
    const std::string expected = job_of("ctb", layers); // whose images depend on it
    for (Layer& layer : layers)
        layer.index += 100;
    EXPECT_TRUE(job_of("ctb", layers) == expected);
}

TEST(ResinFile, IsTheSameOnDiskAndInMemory) {
    const TemporaryFolder folder;
    const LayerStack layers = squares(3);
    write_layers(folder.file("job"), layer_format("goo", ""), test::planes_of(layers), info_of(layers),
                 {.printer = &tiny_printer});
    EXPECT_TRUE(file_bytes(folder.file("job")) == job_of("goo", layers));
}

} // namespace
} // namespace lamella::resin_file_cases
