// A file read batch by batch says the same as one read whole.

#include "lamella/read/mesh_input.hpp"

#include "fixtures/mutations.hpp"
#include "fixtures/rounds.hpp"
#include "parts/shapes.hpp"
#include "read/stl_text.hpp"
#include "temporary_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <limits>
#include <map>
#include <mutex>
#include <random>
#include <stdexcept>
#include <thread>

namespace lamella::mesh_input_posix_cases {
namespace {

/// The triangles that a file streams, in the order of its batches.
struct Streamed {
    Triangles triangles;
    MeshFile file;
};

Streamed stream(const MeshInput& input, const MeshReadOptions& options = {}, unsigned threads = 1,
                const std::optional<RecordRange>& share = {}) {
    std::mutex mutex;
    std::map<std::uint64_t, Triangles> batches;
    const TriangleSink sink = [&](const TriangleSoup& batch, std::uint64_t number) {
        Triangles triangles;
        for (std::size_t i = 0; i < batch.size(); ++i)
            triangles.push_back(batch.stored(i));
        const std::lock_guard lock(mutex);
        EXPECT_TRUE(batches.emplace(number, std::move(triangles)).second) << "batch " << number << " twice";
    };
    Streamed streamed;
    streamed.file = input.stream(sink, options, {.threads = threads}, share);
    for (const auto& [number, triangles] : batches)
        streamed.triangles.insert(streamed.triangles.end(), triangles.begin(), triangles.end());
    return streamed;
}

std::string error_text(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

/// Read whole and streamed: the same triangles, counts, warnings and errors.
void expect_agreement(const std::string& bytes) {
    const TemporaryFolder folder;
    const std::string path = folder.file("part.stl");
    write_file(path, bytes);
    const MeshInput input(path);
    for (const bool strict : {false, true}) {
        MeshFile whole;
        Triangles expected;
        const std::string error = error_text([&] {
            whole = input.read({.strict = strict});
            expected = triangles_of(whole);
        });
        for (const unsigned threads : {1U, 2U, 7U}) {
            Streamed streamed;
            EXPECT_EQ(error_text([&] { streamed = stream(input, {.strict = strict}, threads); }), error);
            if (error != "no error")
                continue;
            EXPECT_EQ(streamed.triangles, expected);
            EXPECT_EQ(streamed.file.path, whole.path);
            EXPECT_EQ(streamed.file.format, whole.format);
            EXPECT_EQ(streamed.file.name, whole.name);
            EXPECT_EQ(streamed.file.stored_triangles, whole.stored_triangles);
            EXPECT_EQ(streamed.file.nonfinite_triangles, whole.nonfinite_triangles);
            EXPECT_EQ(streamed.file.warnings, whole.warnings);
            ASSERT_EQ(streamed.file.objects.size(), 1U);
            EXPECT_TRUE(streamed.file.objects.front().mesh.empty());
        }
    }
}

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Standard input is a pipe that delivers these bytes.
class PipedInput {
  public:
    explicit PipedInput(std::string bytes) : saved_(dup(STDIN_FILENO)) {
        int ends[2];
        EXPECT_EQ(pipe(ends), 0);
        dup2(ends[0], STDIN_FILENO);
        close(ends[0]);
        writer_ = std::thread([to = ends[1], sent = std::move(bytes)] {
            for (std::size_t at = 0; at < sent.size();) {
                const ssize_t written = write(to, sent.data() + at, sent.size() - at);
                if (written <= 0)
                    break;
                at += static_cast<std::size_t>(written);
            }
            close(to);
        });
    }
    ~PipedInput() {
        writer_.join();
        dup2(saved_, STDIN_FILENO);
        close(saved_);
    }
    PipedInput(const PipedInput&) = delete;
    PipedInput& operator=(const PipedInput&) = delete;

  private:
    int saved_;
    std::thread writer_;
};

TEST(MeshInput, SpoolsWhatComesThroughAPipe) {
    const Triangles many =
        some_triangles(test::slowed ? 25'000 : 60'000); // more than the limit of 2^20 bytes
    for (const std::string& bytes : {binary(many), solid(many)})
        for (const std::uint64_t most : {std::uint64_t{0}, std::uint64_t{1} << 20, std::uint64_t{1} << 40}) {
            const PipedInput piped(bytes);
            const MeshInput input("-", most);
            EXPECT_EQ(input.bytes(), bytes.size());
            EXPECT_EQ(stream(input, {}, 2).triangles, many);
            EXPECT_EQ(stream(input, {}, 2).triangles, many); // as often as wished
            EXPECT_EQ(triangles_of(input.read()), many);
        }
}

} // namespace
} // namespace lamella::mesh_input_posix_cases
