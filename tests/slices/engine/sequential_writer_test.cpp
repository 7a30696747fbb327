#include "lamella/core/error.hpp"

#include "container/gzip.hpp"
#include "fixtures/sample_layers.hpp"
#include "slices/engine/sequential_writer.hpp"
#include "system/byte_source.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::sequential_writer_cases {
namespace {

/// Writes "(header", then for each plane its position and the index of its layer, then "tail)".
class Sample final : public SequentialWriter {
  public:
    Sample(const std::string& path, const LayerFileInfo& info)
        : SequentialWriter(path, info, "(header", {}) {}

  private:
    std::string layer_header(const PlanePosition& plane) override {
        return fmt::format(" {}:", plane.position);
    }
    void format(const Plane& plane, ByteBuffer& out) const override {
        out.append(fmt::format("{}", plane.polylines.front().index));
    }
    std::string tail() override { return " tail)"; }
};

const LayerStack layers = random_layers(1, 6, 10, {0, 0}, false);
const std::string expected = "(header 0:0 1:1 2:2 3:3 4:4 5:5 tail)";

TEST(SequentialWriter, WritesHeaderLayersAndTailInOrder) {
    const TemporaryFolder folder;
    Sample writer(folder.file("x"), info_of(layers));
    std::vector<Commit> prepared(layers.size());
    for (std::size_t i = layers.size(); i-- > 0;) // prepared in any order
        prepared[i] = writer.prepare(layers[i]);
    for (const auto& write : prepared)
        write();
    EXPECT_FALSE(std::filesystem::exists(folder.file("x"))) << "no name before the end";
    writer.finish();
    EXPECT_EQ(file_bytes(folder.file("x")), expected);
    EXPECT_EQ(writer.bytes(), expected.size());
}

TEST(SequentialWriter, CompressesEachLayerIfTheNameAsksForIt) {
    const TemporaryFolder folder;
    Sample writer(folder.file("x.gz"), info_of(layers));
    for (const Layer& layer : layers)
        writer.prepare(layer)();
    writer.finish();
    const std::string bytes = file_bytes(folder.file("x.gz"));
    EXPECT_EQ(writer.bytes(), bytes.size());
    const ByteSource plain =
        unpacked(copy_bytes(std::as_bytes(std::span(bytes.data(), bytes.size())), "x.gz"), 0);
    EXPECT_EQ(std::string(plain.text()), expected);
}

TEST(SequentialWriter, WritesChunksThatMakeUpTheFile) {
    for (std::size_t first = 0; first <= layers.size(); ++first)
        for (std::size_t second = first; second <= layers.size(); ++second) {
            std::string all;
            std::size_t begin = 0;
            for (const std::size_t end : {first, second, layers.size()}) {
                std::string bytes;
                LayerFileChunk chunk;
                chunk.before = begin;
                chunk.layers = end - begin;
                chunk.put = [&](std::string_view some, const std::shared_ptr<const void>&, Completions&) {
                    bytes += some;
                };
                LayerFileInfo info = info_of(layers);
                info.chunk = &chunk;
                Sample writer("", info);
                for (; begin < end; ++begin)
                    writer.prepare(layers[begin])();
                writer.finish();
                EXPECT_EQ(writer.bytes(), bytes.size());
                all += bytes;
            }
            if (first > 0 && second > first && second < layers.size()) {
                EXPECT_EQ(all, expected) << first << ' ' << second;
            }
        }
}

} // namespace
} // namespace lamella::sequential_writer_cases
