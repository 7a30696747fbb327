// Files that lose their last bytes while they are read, which shows neither as an error nor as a signal.

#include "lamella/read/layer_file.hpp"
#include "lamella/read/mesh_file.hpp"
#include "lamella/read/mesh_input.hpp"

#include "fixtures/expect_error.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>

namespace lamella::shortened_file {
namespace {

std::string repeated(const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i)
        all += text;
    return all;
}

/// Reads a file which has lost its end by the time of the last report.
void expect_refusal(const std::string& bytes,
                    const std::function<void(const std::string&, const Execution&)>& read) {
    const TemporaryFolder folder;
    const std::string path = folder.file("file");
    write_file(path, bytes);
    read(path, {});
    const Execution execution{.threads = 1, .progress = [&](const Progress& progress) {
                                  if (progress.done == progress.total)
                                      std::filesystem::resize_file(path, bytes.size() - 10);
                              }};
    test::expect_error(ErrorKind::input, {"was cut off while it was read"}, [&] { read(path, execution); });
}

const std::string facet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

TEST(ShortenedFile, OfAMeshIsRefused) {
    expect_refusal(
        "solid\n" + repeated(facet, 1000) + "endsolid\n",
        [](const std::string& path, const Execution& execution) { (void)read_mesh(path, {}, execution); });
}

TEST(ShortenedFile, OfAMeshThatPassesByIsRefused) {
    expect_refusal("solid\n" + repeated(facet, 1000) + "endsolid\n",
                   [](const std::string& path, const Execution& execution) {
                       const auto ignore = [](const TriangleSoup&, std::uint64_t) {
                       };
                       (void)MeshInput(path).stream(ignore, {}, execution);
                   });
}

TEST(ShortenedFile, OfLayersIsRefused) {
    std::string layers = "$$LAYER/0\n";
    for (int i = 1; i < 2000; ++i)
        layers += "$$LAYER/" + std::to_string(i) + "\n$$POLYLINE/1,1,5,0,0,2,0,2,2,0,2,0,0\n";
    expect_refusal(
        "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$VERSION/200\n$$HEADEREND\n$$GEOMETRYSTART\n" + layers +
            "$$GEOMETRYEND\n",
        [](const std::string& path, const Execution& execution) { (void)read_layers(path, {}, execution); });
}

} // namespace
} // namespace lamella::shortened_file
