// Which form a file has, whatever it claims.

#include "lamella/read/mesh_file.hpp"

#include "read/stl_text.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <future>

namespace lamella::stl_test::stl_cases {
namespace {

const Triangles one = some_triangles(1);
const Triangles two = some_triangles(2);
const Triangles many = some_triangles(24);

/// A file of its own for each test, gone afterwards.
class StlOnDisk : public testing::Test {
  protected:
    void SetUp() override {
        const int descriptor = mkstemp(path_.data());
        ASSERT_GE(descriptor, 0);
        close(descriptor);
    }
    void TearDown() override { unlink(path_.c_str()); }

    void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }
    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    std::string path_ = testing::TempDir() + "/lamella-stl-XXXXXX";
};

TEST_F(StlOnDisk, ReadsStandardInputFromAPipe) {
    for (const std::string& bytes : {binary(many), solid(many)}) {
        unlink(path().c_str());
        ASSERT_EQ(mkfifo(path().c_str(), 0600), 0);
        const auto writer = std::async(std::launch::async, [&] { write(bytes); });
        const int saved = dup(STDIN_FILENO);
        const int fifo = open(path().c_str(), O_RDONLY | O_CLOEXEC);
        dup2(fifo, STDIN_FILENO);
        close(fifo);
        const MeshFile file = read_mesh("-");
        dup2(saved, STDIN_FILENO);
        close(saved);
        EXPECT_EQ(file.path, "-");
        EXPECT_EQ(triangles_of(file), many);
    }
}

} // namespace
} // namespace lamella::stl_test::stl_cases
