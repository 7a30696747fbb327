// Limits hold while a file is read, not afterwards: each file here would take far more memory than the
// process that reads it may have.

#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"

#include "container/zip_writer.hpp"
#include "fixtures/packages.hpp"
#include "temporary_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <new>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace lamella {
namespace {

/// Bytes that this process has of its own, and that RLIMIT_DATA counts.
std::size_t data_bytes() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        std::size_t kilobytes = 0;
        if (word == "VmData:" && status >> kilobytes)
            return kilobytes * 1024;
    }
    return 0;
}

/// What reading ends with in a process that may take so many bytes more than it has.
std::string outcome(std::size_t more, const std::function<void()>& read) {
    std::array<int, 2> ends{};
    EXPECT_EQ(pipe(ends.data()), 0);
    const pid_t child = fork();
    if (child == 0) {
        const std::size_t most = data_bytes() + more;
        const rlimit limit{most, most};
        std::string text = "read";
        if (setrlimit(RLIMIT_DATA, &limit) != 0)
            _exit(1);
        try {
            read();
        } catch (const Error& error) {
            text = error.what();
        } catch (const std::bad_alloc&) {
            text = "memory ran out";
        }
        _exit(write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size()) ? 0 : 1);
    }
    close(ends[1]);
    std::string text;
    std::array<char, 4096> buffer{};
    for (ssize_t n = 0; (n = ::read(ends[0], buffer.data(), buffer.size())) > 0;)
        text.append(buffer.data(), static_cast<std::size_t>(n));
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    return text;
}

std::string outcome(const std::string& path, const MeshReadOptions& options, std::size_t more) {
    return outcome(more, [&] { static_cast<void>(read_mesh(path, options, {.threads = 1})); });
}

std::string layers_outcome(const std::string& path, const LayerReadOptions& options, std::size_t more) {
    return outcome(more, [&] { static_cast<void>(read_layers(path, options, {.threads = 1})); });
}

constexpr std::size_t megabyte = 1'000'000;

class LimitsOfReading : public ::testing::Test {
  protected:
    std::string file(const std::string& name, const std::string& bytes) {
        std::string path = folder_.file(name);
        std::ofstream(path, std::ios::binary) << bytes;
        return path;
    }

    std::string archive(const std::string& name,
                        const std::vector<std::pair<std::string, std::string>>& entries) {
        ZipWriter zip(folder_.file(name));
        for (const auto& [entry, content] : entries)
            zip.add(entry, content, ZipMethod::deflated);
        zip.finish();
        return folder_.file(name);
    }

    /// With a limit, layers are refused at a place that begins so; without one, there is no room for them.
    static void expect_refused(const std::string& path, const std::string& location) {
        EXPECT_EQ(layers_outcome(path, {}, 32 * megabyte), "memory ran out");
        const std::string text = layers_outcome(path, {.max_memory = 10 * megabyte}, 32 * megabyte);
        EXPECT_TRUE(text.starts_with(
            path + ": takes more than the 10000000 bytes of `max_memory` (counted up to " + location))
            << text;
    }

  private:
    TemporaryFolder folder_;
};

TEST_F(LimitsOfReading, MeshesThatComeThroughAPipeWaitInAFileWhereTheyAreTooLong) {
    const auto before = std::signal(SIGPIPE, SIG_IGN);
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    while (text.size() < 60 * megabyte)
        text += "# nothing but a remark\n";
    const std::string path = file("part.obj", "") + ".pipe";
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    std::thread writer([&] { std::ofstream(path, std::ios::binary) << text; });
    EXPECT_EQ(outcome(path, {.max_memory = 10 * megabyte}, 40 * megabyte), "read");
    ::close(::open(path.c_str(), O_RDONLY | O_NONBLOCK)); // for a writer that nobody came to
    writer.join();
    static_cast<void>(std::signal(SIGPIPE, before));
}

TEST_F(LimitsOfReading, AsciiStlIsRefusedAtTheFacetThatIsTooMany) {
    std::string text = "solid many\n";
    for (int i = 0; i < 1'000'000; ++i)
        text +=
            "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    const std::string path = file("many.stl", text + "endsolid\n");
    EXPECT_EQ(outcome(path, {}, 30 * megabyte), "memory ran out");
    const std::size_t copied = text.size() + 30 * megabyte;
    EXPECT_EQ(outcome(path, {.max_triangles = 100'000}, copied),
              path + ": holds more than the 100000 triangles of `max_triangles` (counted up to line 700002)");
    EXPECT_NE(outcome(path, {.max_memory = 5 * megabyte}, 30 * megabyte)
                  .find(path + ": takes more than the 5000000 bytes of `max_memory` (counted up to byte "),
              std::string::npos);
    EXPECT_EQ(outcome(path, {.max_triangles = 1'000'000}, 400 * megabyte), "read");
}

TEST_F(LimitsOfReading, ObjectsOf3mfAreCountedBeforeTheyAreMade) {
    std::string resources;
    for (int i = 1; i <= 200'000; ++i)
        resources += fmt::format("<object id=\"{}\"><mesh/></object>", i);
    const std::string path =
        file("many.3mf", package_test::package(package_test::model(resources, "<item objectid=\"1\"/>")));
    EXPECT_EQ(outcome(path, {}, 40 * megabyte), "memory ran out");
    EXPECT_NE(outcome(path, {.max_memory = 12 * megabyte}, 40 * megabyte)
                  .find(path + ": takes more than the 12000000 bytes of `max_memory` (counted up to part "
                               "'3D/3dmodel.model', line 3)"),
              std::string::npos);
}

TEST_F(LimitsOfReading, InstancesOfAmfAreCountedBeforeTheyAreMade) {
    std::string text = "<amf>\n<constellation id=\"1\">\n";
    for (int i = 0; i < 300'000; ++i)
        text += "<instance objectid=\"2\"><rx>1</rx></instance>\n";
    const std::string path = file("many.amf", text + "</constellation></amf>");
    EXPECT_EQ(outcome(path, {}, 40 * megabyte), "memory ran out");
    EXPECT_NE(outcome(path, {.max_memory = 12 * megabyte}, 40 * megabyte)
                  .find(path + ": takes more than the 12000000 bytes of `max_memory` (counted up to line "),
              std::string::npos);
}

std::string triangles(int count) {
    std::string text = "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>"
                       "<vertex x=\"0\" y=\"1\" z=\"0\"/></vertices><triangles>\n";
    for (int i = 0; i < count; ++i)
        text += "<triangle v1=\"0\" v2=\"1\" v3=\"2\"/>\n";
    return text + "</triangles></mesh>";
}

TEST_F(LimitsOfReading, Of3mfCountEachTriangleOnceHoweverItIsWritten) {
    const auto answer = [&](const std::string& meshes, std::uint64_t most) {
        std::string items;
        for (int id = 1; meshes.find(fmt::format("id=\"{}\"", id)) != std::string::npos; ++id)
            items += fmt::format("<item objectid=\"{}\"/>", id);
        const std::string path = file("part.3mf", package_test::package(package_test::model(meshes, items)));
        try {
            return fmt::to_string(read_mesh(path, {.max_triangles = most}).stored_triangles);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::limit);
            return std::string(error.what()).substr(path.size());
        }
    };
    const std::string plain = package_test::object(1, triangles(5000));
    const std::string small = package_test::object(2, triangles(10));
    // A comment is nothing that the fast way could pass over: the whole part is left to a parser.
    std::string odd = package_test::object(3, triangles(7000));
    odd.insert(odd.find("<triangle v1"), "<!-- odd -->\n");
    EXPECT_EQ(answer(plain, 5000), "5000");
    EXPECT_EQ(answer(plain, 4999),
              ": holds more than the 4999 triangles of `max_triangles` (counted up to part "
              "'3D/3dmodel.model', line 5006)");
    EXPECT_EQ(answer(plain + small + odd, 12010).substr(0, 5), "12010");
    const std::string refused = answer(plain + small + odd, 12009);
    EXPECT_NE(refused.find("`max_triangles` (counted up to part '3D/3dmodel.model', line "),
              std::string::npos)
        << refused;
}

std::string repeated(std::string_view text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i)
        all += text;
    return all;
}

TEST_F(LimitsOfReading, LayersOfTheCommonLayerInterfaceAreCountedBeforeTheyAreMade) {
    using namespace std::string_literals;
    const std::string header = "$$HEADERSTART\n$$UNITS/1\n";
    expect_refused(file("binary.cli", header + "$$BINARY\n$$HEADEREND" + repeated("\x80\0\1\0"s, 1'000'000)),
                   "byte ");
    expect_refused(
        file("points.cli", header + "$$BINARY\n$$HEADEREND\x80\0\1\0\x81\0\1\0\1\0\xff\xff"s +
                               std::string(4 * 65535, '\1') +
                               repeated("\x81\0\1\0\1\0\4\0\0\0\0\0\1\0\0\0\1\0\1\0\0\0\0\0"s, 1'000'000)),
        "byte ");
    const std::string text = header + "$$ASCII\n$$HEADEREND\n$$GEOMETRYSTART\n$$LAYER/1\n";
    expect_refused(file("layers.cli", text + repeated("$$LAYER/1\n", 500'000) + "$$GEOMETRYEND"), "line ");
    expect_refused(
        file("rings.cli", text + repeated("$$POLYLINE/1,1,3,0,0,1,0,0,1\n", 1'000'000) + "$$GEOMETRYEND"),
        "line ");
    expect_refused(
        file("hatches.cli", text + repeated("$$HATCHES/1,1,0,0,1,1\n", 2'000'000) + "$$GEOMETRYEND"),
        "line ");
    std::string parts;
    for (int i = 0; i < 400'000; ++i)
        parts += fmt::format("$$POLYLINE/{},1,0\n", i);
    expect_refused(file("parts.cli", text + parts + "$$GEOMETRYEND"), "line ");
}

TEST_F(LimitsOfReading, LayersOfSlcAreCountedBeforeTheyAreMade) {
    using namespace std::string_literals;
    const std::string header =
        "-SLCVER 2.0 -UNIT MM -TYPE PART \r\n\x1a" + std::string(256, '\0') + '\1' + std::string(16, '\0');
    expect_refused(file("layers.slc", header + std::string(8 * 1'000'000, '\0')), "byte ");
    expect_refused(
        file("points.slc", header + "\0\0\0\0\x40\x42\x0f\0"s +
                               repeated("\4\0\0\0\0\0\0\0"s + std::string(8, '\0') + "\0\0\x80\x3f\0\0\0\0"s +
                                            "\0\0\0\0\0\0\x80\x3f"s + std::string(8, '\0'),
                                        1'000'000)),
        "byte ");
}

TEST_F(LimitsOfReading, LayersOfSvgAreCountedBeforeTheyAreMade) {
    expect_refused(file("layers.svg", "<svg>" + repeated("<g slic3r:z='1'/>\n", 500'000) + "</svg>"),
                   "line ");
    expect_refused(
        file("points.svg", "<svg><g slic3r:z='1'>\n" +
                               repeated("<polygon points='" + repeated("0,1 2,3 ", 50'000) + "'/>\n", 50) +
                               "</g></svg>"),
        "line ");
    expect_refused(
        file("paths.svg", "<svg><g slic3r:z='1'>\n" +
                              repeated("<path d='M0,0" + repeated("H1V1H0V0", 25'000) + "'/>\n", 50) +
                              "</g></svg>"),
        "line ");
}

TEST_F(LimitsOfReading, LayersOfJsonAreCountedBeforeTheyAreMade) {
    const std::string header = R"({"format": "lamella layers", "version": 1, "parts": [{"label": "a"})";
    expect_refused(file("parts.json", header + repeated(",{}", 1'500'000) + "]}"), "byte ");
    expect_refused(file("points.json",
                        header + R"(], "layers": [{"z": 1, "bottom": 0, "top": 2, "parts": [{"rings": [[)" +
                            repeated("1,2,2,1,", 3'000'000) + "0,0]]}]}]}"),
                   "byte ");
    std::string layers;
    for (int i = 0; i < 250'000; ++i)
        layers += fmt::format("{}{{\"z\":{},\"bottom\":{},\"top\":{},\"parts\":[{{}}]}}", i == 0 ? "" : ",",
                              i, i, i);
    expect_refused(file("layers.json", header + "], \"layers\": [" + layers + "]}"), "layer ");
}

/// An array of zeros.
std::pair<std::string, std::string> zeros(const std::string& name, const std::string& type, std::size_t bytes,
                                          const std::string& shape) {
    using namespace std::string_literals;
    std::string header =
        fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
    header.resize(117, ' ');
    return {name + ".npy", "\x93NUMPY\1\0v\0"s + header + '\n' + std::string(bytes, '\0')};
}

TEST_F(LimitsOfReading, ArraysAreCountedBeforeThereAreLayers) {
    const auto arrays = [&](const std::string& name, std::size_t planes, std::size_t contours,
                            std::size_t points) {
        const std::string l = fmt::format("{},", planes);
        const std::string c = fmt::format("{},", contours);
        auto offsets = zeros("offsets", "<i4", 4 * (contours + 1), fmt::format("{},", contours + 1));
        for (std::size_t byte = 0; byte < 4; ++byte) // of the last one
            offsets.second[offsets.second.size() - 4 + byte] = static_cast<char>(points >> (8 * byte));
        return archive(name, {zeros("points", "<f4", 8 * points, fmt::format("{}, 2", points)), offsets,
                              zeros("closed", "|b1", contours, c), zeros("layer", "<i4", 4 * contours, c),
                              zeros("part", "<i4", 4 * contours, c), zeros("z", "<f4", 4 * planes, l),
                              zeros("bottom", "<f4", 4 * planes, l), zeros("top", "<f4", 4 * planes, l),
                              zeros("index", "<i4", 4 * planes, l), zeros("labels", "<U1", 4, "1,")});
    };
    const std::string planes = arrays("planes.npz", 400'000, 0, 0);
    EXPECT_LT(std::filesystem::file_size(planes), 100'000U);
    expect_refused(planes, "array 'z')");
    const std::string points = arrays("points.npz", 1, 1, 600'000);
    EXPECT_EQ(layers_outcome(points, {.max_memory = 10 * megabyte}, 32 * megabyte),
              points + ": takes more than the 10000000 bytes of `max_memory` (counted up to contour 0)");
    const std::string bomb = archive("bomb.npz", {zeros("points", "<f8", 100'000'000, "6250000, 2")});
    EXPECT_EQ(layers_outcome(bomb, {}, 32 * megabyte),
              bomb +
                  ": zip entry 'points.npy' of 100000128 bytes brings what is unpacked above 67108864 bytes; "
                  "`max_memory` allows more");
    EXPECT_EQ(layers_outcome(bomb, {.max_memory = 10 * megabyte}, 32 * megabyte),
              bomb +
                  ": zip entry 'points.npy' of 100000128 bytes brings what is unpacked above 10000000 bytes; "
                  "`max_memory` allows more");
}

std::string slices_model(const std::string& resources, const std::string& build) {
    return "<model xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
           "xmlns:t=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\"><resources>\n" +
           resources + "</resources><build>\n" + build + "</build></model>";
}

TEST_F(LimitsOfReading, SlicesOf3mfAreCountedBeforeTheyAreMade) {
    const auto package = [&](const std::string& name, const std::string& resources,
                             const std::string& build) {
        return archive(name, {{"3D/3dmodel.model", slices_model(resources, build)}});
    };
    const auto slices = [](int count) {
        std::string text;
        for (int i = 1; i <= count; ++i)
            text += fmt::format("<t:slice ztop='{}'/>\n", i);
        return text;
    };
    const std::string stack = "<t:slicestack id='1'>";
    const std::string object = "</t:slicestack><object id='1' t:slicestackid='1'/>";
    const std::string item = "<item objectid='1'/>";
    expect_refused(package("slices.3mf", stack + slices(200'000) + object, item), "line ");
    expect_refused(package("components.3mf",
                           stack + slices(1) + object + "<object id='2'><components>" +
                               repeated("<component objectid='1'/>\n", 300'000) + "</components></object>",
                           item),
                   "line ");
    // Few bytes, of which placing makes many heights, many names, and many layers.
    expect_refused(package("heights.3mf", stack + slices(5'000) + object, repeated(item, 5'000)), "part ");
    expect_refused(package("names.3mf",
                           stack + slices(1) + "</t:slicestack><object id='1' name='" +
                               std::string(100'000, 'n') + "' t:slicestackid='1'/>",
                           repeated(item, 5'000)),
                   "line ");
    expect_refused(package("layers.3mf", stack + slices(1'000) + object, repeated(item, 1'000)), "part ");
}

TEST_F(LimitsOfReading, RelationshipsWithoutEndAreRefused) {
    const std::string path =
        archive("many.3mf",
                {{"_rels/.rels",
                  "<Relationships xmlns='http://schemas.openxmlformats.org/package/2006/relationships'>\n" +
                      repeated("<Relationship Target='' Type=''/>", 1'100'000) + "</Relationships>"}});
    EXPECT_EQ(layers_outcome(path, {}, 300 * megabyte),
              path + ", part '_rels/.rels', line 2: found more than 1048576 relationships of one part");
}

TEST_F(LimitsOfReading, WithRoomEnoughLayersAreRead) {
    const std::string path =
        file("small.svg", "<svg><g slic3r:z='1'><polygon points='0,0 1,0 0,1'/></g></svg>");
    EXPECT_EQ(layers_outcome(path, {}, 60 * megabyte), "read");
    EXPECT_EQ(layers_outcome(path, {.max_memory = 2000}, 60 * megabyte), "read");
    EXPECT_NE(layers_outcome(path, {.max_memory = 200}, 60 * megabyte), "read");
}

} // namespace
} // namespace lamella
