#include "lamella/slices/layer_writer.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/sample_layers.hpp"
#include "plain_formats.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace lamella {
namespace {

using test::error_of;

TEST(LayerFormat, IsChosenByNameOrElseByExtension) {
    EXPECT_EQ(layer_format("", "out/part.cli").name, "cli");
    EXPECT_EQ(layer_format("", "PART.CLI").name, "cli");
    EXPECT_EQ(layer_format("", "a.svg").name, "svg");
    EXPECT_EQ(layer_format("cli-ascii", "a.svg").name, "cli-ascii");
    EXPECT_EQ(layer_format("svg-layers", "folder").name, "svg-layers");
    for (const LayerFormat& format : layer_formats()) {
        EXPECT_EQ(&layer_format(format.name, ""), &format);
        EXPECT_FALSE(format.summary.empty());
    }
}

TEST(LayerFormat, ListsWhatThereIsWhenItIsUnknown) {
    const auto error = [](const char* name, const char* path) {
        return error_of(ErrorKind::usage, [&] { (void)layer_format(name, path); });
    };
    for (const std::string& text : {error("gcode", "a.cli"), error("", "a.step"), error("", "folder/"),
                                    error("", "-"), error("", "")}) {
        for (const LayerFormat& format : layer_formats())
            EXPECT_NE(text.find(format.name), std::string::npos) << text;
    }
    EXPECT_NE(error("", "a.step").find("a.step"), std::string::npos);
}

TEST(LayerWriter, WritesToMemoryWhatItWritesToFiles) {
    const LayerStack layers = square_with_hole();
    for (const LayerFormat& format : layer_formats()) {
        const TemporaryFolder folder;
        LayerFileInfo info = info_of(layers);
        std::string memory = "before";
        if (format.directory) {
            info.memory = &memory;
            const auto open = [&] {
                (void)open_layer_writer("name", format, info, options_for_any());
            };
            EXPECT_NE(error_of(ErrorKind::usage, open).find("a folder"), std::string::npos);
            continue;
        }
        write_layers(folder.file("layers"), format, test::planes_of(layers), info, options_for_any());
        info.memory = &memory;
        write_layers(folder.file("missing/name"), format, test::planes_of(layers), info, options_for_any());
        EXPECT_TRUE(memory == file_bytes(folder.file("layers"))) << format.name;
        EXPECT_EQ(folder.entries().size(), 1U);
    }
}

/// Notes what it is given to write.
class NotingWriter final : public LayerWriter {
  public:
    /// Throws at this index, and requests to stop at the 100th plane.
    explicit NotingWriter(std::uint64_t fails_at = ~std::uint64_t{0}, CancelFlag* stop = nullptr)
        : fails_at_(fails_at), stop_(stop) {}

    [[nodiscard]] Commit prepare(const Plane& plane) override {
        if (++prepared == 100 && stop_ != nullptr)
            stop_->request();
        return [this, index = plane.polylines.front().index] {
            if (index == fails_at_)
                throw Error(ErrorKind::output, "the disk is full");
            written.push_back(index);
        };
    }
    void finish() override {}
    [[nodiscard]] std::uint64_t bytes() const noexcept override { return 0; }

    std::atomic<unsigned> prepared{0};
    std::vector<std::uint64_t> written;

  private:
    std::uint64_t fails_at_;
    CancelFlag* stop_;
};

std::vector<Plane> empty_planes(std::size_t count) {
    std::vector<Plane> planes;
    for (std::size_t i = 0; i < count; ++i)
        planes.emplace_back(Layer{.index = i});
    return planes;
}

TEST(WritePlanes, WritesInOrderOnAnyNumberOfThreadsAndReportsHowFarItIs) {
    std::vector<std::uint64_t> expected(500);
    std::iota(expected.begin(), expected.end(), 0);
    for (const unsigned threads : {1U, 2U, 7U}) {
        NotingWriter writer;
        std::uint64_t done = 0;
        write_planes(writer, empty_planes(expected.size()),
                     {.threads = threads, .progress = [&](const Progress& p) {
                          EXPECT_EQ(p.stage, Stage::write);
                          EXPECT_GE(p.done, done);
                          done = p.done;
                      }});
        EXPECT_EQ(writer.written, expected);
        EXPECT_EQ(done, expected.size());
        write_planes(writer, {}, {.threads = threads});
        EXPECT_EQ(writer.written, expected);
    }
}

TEST(WritePlanes, EndsAtTheFirstFailureAndWhenItIsCancelled) {
    for (const unsigned threads : {1U, 2U, 7U}) {
        NotingWriter full(100);
        EXPECT_EQ(error_of(ErrorKind::output,
                           [&] { write_planes(full, empty_planes(5000), {.threads = threads}); }),
                  "the disk is full");
        EXPECT_EQ(full.written.size(), 100U);
        EXPECT_LE(full.prepared, 100 + 2 * threads);

        CancelFlag stop;
        NotingWriter writer(~std::uint64_t{0}, &stop);
        (void)error_of(ErrorKind::cancelled, [&] {
            write_planes(writer, empty_planes(5000), {.threads = threads, .cancel = &stop});
        });
        EXPECT_LE(writer.prepared, 100 + 2 * threads);
        EXPECT_LE(writer.written.size(), writer.prepared);
    }
}

TEST(WriteLayers, TakesFormatAndHeaderFromPathAndLayers) {
    const TemporaryFolder folder;
    LayerBuilder nothing;
    const LayerStack empty{nothing.finish(0, 0.5, 0, 1)};
    for (const LayerStack& layers : {random_layers(1, 40, 30, {10, -5}, false), square_with_hole(), empty}) {
        LayerFileInfo header = info_of(layers);
        header.box.min.z = layers.front().bottom;
        header.box.max.z = layers.back().top;
        header.parts.front().box = header.box;
        for (const char* name : {"part.cli", "part.svg", "part.slc", "part.3mf", "part.json"}) {
            write_layers(folder.file(name), layers);
            write_layers(folder.file("expected"), layer_format("", name), test::planes_of(layers), header);
            EXPECT_EQ(file_bytes(folder.file(name)), file_bytes(folder.file("expected"))) << name;
        }
    }
    const auto none = [&] {
        write_layers(folder.file("none.cli"), LayerStack{});
    };
    EXPECT_NE(error_of(ErrorKind::usage, none).find("no layers"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder.file("none.cli")));
}

} // namespace
} // namespace lamella
