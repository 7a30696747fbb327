// Limits hold while a file is read, not afterwards: each file here would take far more memory than the
// process that reads it may have.

#include "lamella/core/error.hpp"
#include "lamella/read/mesh_file.hpp"

#include "read/packages.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <fstream>
#include <functional>
#include <new>
#include <string>

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

/// What reading the file ends with in a process that may take so many bytes more than it has.
std::string outcome(const std::string& path, const MeshReadOptions& options, std::size_t more) {
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
            static_cast<void>(read_mesh(path, options, {.threads = 1}));
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

constexpr std::size_t megabyte = 1'000'000;

class LimitsOfReading : public ::testing::Test {
  protected:
    std::string file(const std::string& name, const std::string& bytes) {
        const std::string path = folder_.file(name);
        std::ofstream(path, std::ios::binary) << bytes;
        return path;
    }

  private:
    TemporaryFolder folder_;
};

TEST_F(LimitsOfReading, AsciiStlIsRefusedAtTheFacetThatIsTooMany) {
    std::string text = "solid many\n";
    for (int i = 0; i < 1'000'000; ++i)
        text +=
            "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    const std::string path = file("many.stl", text + "endsolid\n");
    EXPECT_EQ(outcome(path, {}, 30 * megabyte), "memory ran out");
    EXPECT_EQ(outcome(path, {.max_triangles = 100'000}, 30 * megabyte),
              path + ": holds more than the 100000 triangles of --max-triangles (counted up to line 700002)");
    EXPECT_NE(outcome(path, {.max_memory = 5 * megabyte}, 30 * megabyte)
                  .find(path + ": takes more than the 5000000 bytes of --max-memory (counted up to byte "),
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
                  .find(path + ": takes more than the 12000000 bytes of --max-memory (counted up to part "
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
                  .find(path + ": takes more than the 12000000 bytes of --max-memory (counted up to line "),
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
              ": holds more than the 4999 triangles of --max-triangles (counted up to part "
              "'3D/3dmodel.model', line 3)");
    EXPECT_EQ(answer(plain + small + odd, 12010).substr(0, 5), "12010");
    const std::string refused = answer(plain + small + odd, 12009);
    EXPECT_NE(refused.find("--max-triangles (counted up to part '3D/3dmodel.model', line "),
              std::string::npos)
        << refused;
}

} // namespace
} // namespace lamella
