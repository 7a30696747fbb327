#include "lamella/core/error.hpp"
#include "lamella/mesh/shapes.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/pipeline/processes.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/write/mesh_writer.hpp"

#include "fixtures/rounds.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <barrier>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <thread>

// Processes as threads of one process: all of slice_file by several but the messages themselves.

namespace lamella {
namespace {

/// What is sliced. With a sanitizer it is a part with fewer triangles.
TriangleSoup part() {
    return test::sanitized ? make_torus(20, 10, 120, 60) : make_rook();
}

/// What the threads share.
struct Meeting {
    explicit Meeting(std::size_t processes)
        : said(processes), sums(processes), outgoing(processes), sizes(processes),
          barrier(static_cast<std::ptrdiff_t>(processes)) {}

    std::vector<std::string> said;
    std::vector<std::span<std::uint64_t>> sums;
    std::vector<std::span<const std::span<const std::byte>>> outgoing;
    std::vector<std::span<const std::uint64_t>> sizes;
    std::barrier<> barrier;
    std::mutex mutex;
    std::condition_variable arrived;
    std::map<std::pair<std::size_t, std::size_t>, std::deque<std::string>> messages;
};

class ThreadProcesses final : public Communicator {
  public:
    ThreadProcesses(Meeting& meeting, std::size_t process) : meeting_(meeting), process_(process) {}

    [[nodiscard]] std::size_t process() const noexcept override { return process_; }
    [[nodiscard]] std::size_t size() const noexcept override { return meeting_.said.size(); }

    void sum(std::span<std::uint64_t> values) override {
        meeting_.sums[process_] = values;
        meeting_.barrier.arrive_and_wait();
        std::vector<std::uint64_t> total(values.size(), 0);
        for (const auto& other : meeting_.sums)
            for (std::size_t i = 0; i < total.size(); ++i)
                total[i] += other[i];
        meeting_.barrier.arrive_and_wait();
        std::copy(total.begin(), total.end(), values.begin());
        meeting_.barrier.arrive_and_wait();
    }

    std::vector<std::string> gather(std::string_view mine) override {
        meeting_.said[process_] = mine;
        meeting_.barrier.arrive_and_wait();
        std::vector<std::string> all = meeting_.said;
        meeting_.barrier.arrive_and_wait();
        return all;
    }

    std::vector<std::uint64_t> exchange(std::span<const std::uint64_t> outgoing) override {
        meeting_.sizes[process_] = outgoing;
        meeting_.barrier.arrive_and_wait();
        std::vector<std::uint64_t> incoming;
        for (const auto& from : meeting_.sizes)
            incoming.push_back(from[process_]);
        meeting_.barrier.arrive_and_wait();
        return incoming;
    }

    void exchange(std::span<const std::span<const std::byte>> outgoing,
                  std::span<const std::span<std::byte>> incoming) override {
        meeting_.outgoing[process_] = outgoing;
        meeting_.barrier.arrive_and_wait();
        for (std::size_t from = 0; from < size(); ++from) {
            const auto sent = meeting_.outgoing[from][process_];
            ASSERT_EQ(sent.size(), incoming[from].size());
            if (!sent.empty())
                std::memcpy(incoming[from].data(), sent.data(), sent.size());
        }
        meeting_.barrier.arrive_and_wait();
    }

    void send(std::size_t to, std::string_view bytes) override {
        const std::lock_guard lock(meeting_.mutex);
        meeting_.messages[{process_, to}].emplace_back(bytes);
        meeting_.arrived.notify_all();
    }

    std::string receive(std::size_t from) override {
        std::unique_lock lock(meeting_.mutex);
        auto& queue = meeting_.messages[{from, process_}];
        meeting_.arrived.wait(lock, [&] { return !queue.empty(); });
        std::string message = std::move(queue.front());
        queue.pop_front();
        return message;
    }

  private:
    Meeting& meeting_;
    std::size_t process_;
};

class Processes : public testing::Test {
  protected:
    [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }

    [[nodiscard]] std::string content(const std::string& name) const { return file_bytes(path(name)); }

    static FileJob job_of(std::vector<PlateInput> inputs, double layer_height) {
        FileJob job;
        job.inputs = std::move(inputs);
        job.layering.cut = UniformLayers{.layer_height = layer_height};
        job.layer_statistics = true;
        return job;
    }

    /// All processes' results, or the text of their errors.
    static std::vector<FileResult> slice_by(std::size_t processes, const FileJob& job,
                                            std::vector<std::string>* errors = nullptr) {
        Meeting meeting(processes);
        std::vector<FileResult> results(processes);
        std::vector<std::string> failed(processes);
        {
            std::vector<std::jthread> threads;
            for (std::size_t r = 0; r < processes; ++r)
                threads.emplace_back([&, r] {
                    ThreadProcesses own(meeting, r);
                    try {
                        results[r] = slice_file(job, {.threads = 2}, own);
                    } catch (const Error& error) {
                        failed[r] = error.what();
                    }
                });
        }
        if (errors != nullptr)
            *errors = failed;
        else
            for (const std::string& error : failed)
                EXPECT_EQ(error, "");
        return results;
    }

    static void expect_same(const FileResult& one, const FileResult& many) {
        EXPECT_EQ(one.triangles, many.triangles);
        EXPECT_EQ(one.box.min, many.box.min);
        EXPECT_EQ(one.box.max, many.box.max);
        EXPECT_EQ(one.mesh_volume_mm3, many.mesh_volume_mm3);
        EXPECT_EQ(one.volume_mm3, many.volume_mm3);
        EXPECT_EQ(one.report.contours, many.report.contours);
        EXPECT_EQ(one.report.open_chains, many.report.open_chains);
        EXPECT_EQ(one.report.points, many.report.points);
        EXPECT_EQ(one.report.layers, many.report.layers);
        EXPECT_EQ(one.bytes, many.bytes);
        EXPECT_EQ(one.open.layers, many.open.layers);
        EXPECT_EQ(one.open.first_z, many.open.first_z);
        ASSERT_EQ(one.layers.size(), many.layers.size());
        for (std::size_t i = 0; i < one.layers.size(); ++i) {
            EXPECT_EQ(one.layers[i].hash, many.layers[i].hash) << i;
            EXPECT_EQ(one.layers[i].index, many.layers[i].index);
            EXPECT_EQ(one.layers[i].measure.area_mm2, many.layers[i].measure.area_mm2);
        }
        ASSERT_EQ(one.parts.size(), many.parts.size());
        for (std::size_t i = 0; i < one.parts.size(); ++i)
            EXPECT_EQ(one.parts[i].points, many.parts[i].points);
    }

    TemporaryFolder folder_;
};

TEST_F(Processes, WriteTheBytesOfOneProcessWithAnyNumberOfThem) {
    write_stl(path("part.stl"), part());
    const auto numbers_of_processes =
        test::sanitized ? std::vector<std::size_t>{3} : std::vector<std::size_t>{1, 2, 3, 5, 50};
    for (const LayerFormat& format : layer_formats()) {
        if (format.directory)
            continue;
        FileJob job = job_of({{.path = path("part.stl")}}, 1.5);
        job.format = format.name;
        job.write.page.viewer = "<!--lamella-data-->"; // what the library asks of a viewer
        job.output = path("one");
        const FileResult one = slice_file(job);
        const std::string expected = content("one");
        for (const std::size_t processes : numbers_of_processes) {
            SCOPED_TRACE(testing::Message() << format.name << " by " << processes);
            job.output = path("one"); // some formats repeat the name
            for (const FileResult& many : slice_by(processes, job))
                expect_same(one, many);
            EXPECT_EQ(content("one"), expected);
        }
    }
}

TEST_F(Processes, TakePlatesBrokenMeshesAndWhateverNeedsTheWholeMesh) {
    write_stl(path("part.stl"), part());
    // Every seventh triangle is missing: chains everywhere.
    const TriangleSoup whole = part();
    std::vector<Triangle3f> some;
    for (std::size_t i = 0; i < whole.size(); ++i)
        if (i % 7 != 0)
            some.push_back(whole.stored(i));
    write_stl(path("broken.stl"), TriangleSoup(some));
    write_stl_ascii(path("ascii.stl"), whole, "part");

    FileJob plain = job_of({}, 2);
    plain.output = path("out.cli");
    std::vector<FileJob> jobs(6, plain);
    jobs[0].inputs = {{.path = path("part.stl"), .copies = 3}, {.path = path("broken.stl")}};
    jobs[1].inputs = {{.path = path("broken.stl")}};
    jobs[1].repair.close_gaps_mm = 0.5;
    jobs[2].inputs = {{.path = path("ascii.stl")}};
    jobs[3].inputs = {{.path = path("part.stl")}};
    jobs[3].engine = "eecc";
    jobs[4].inputs = {{.path = path("part.stl"), .placement = rotation('x', 40)}};
    jobs[4].layering.cut = AdaptiveLayers{.min_height = 0.5, .max_height = 2};
    jobs[5].inputs = {{.path = path("part.stl"), .unit_mm = 25.4, .placement = rotation('y', 30)}};
    jobs[5].steps.offset_mm = -0.1;
    const auto numbers_of_processes =
        test::sanitized ? std::vector<std::size_t>{3} : std::vector<std::size_t>{2, 5};
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const FileResult one = slice_file(jobs[i]);
        const std::string expected = content("out.cli");
        for (const std::size_t processes : numbers_of_processes) {
            SCOPED_TRACE(testing::Message() << "job " << i << " by " << processes);
            for (const FileResult& many : slice_by(processes, jobs[i]))
                expect_same(one, many);
            EXPECT_EQ(content("out.cli"), expected);
        }
    }
}

TEST_F(Processes, FailOnAllWithTheSameWords) {
    write_stl(path("part.stl"), part());
    FileJob plain = job_of({{.path = path("part.stl")}}, 0.1);
    plain.output = path("out.cli");
    const auto expect_failure = [&](const FileJob& job, const std::string& words) {
        for (const std::size_t processes : {1, 3}) {
            std::vector<std::string> errors;
            static_cast<void>(slice_by(processes, job, &errors));
            for (const std::string& error : errors) {
                EXPECT_NE(error.find(words), std::string::npos) << error;
                EXPECT_EQ(error, errors.front());
            }
            EXPECT_EQ(folder_.entries(), std::vector<std::string>{"part.stl"});
        }
    };
    FileJob job = plain;
    job.inputs.front().path = path("missing.stl");
    expect_failure(job, "no such file");
    job = plain;
    job.inputs.front().path = "-";
    expect_failure(job, "standard input");
    job = plain;
    job.layering.cut = UniformLayers{.layer_height = 1000};
    expect_failure(job, "layer height");
    job = plain;
    job.output = path("nowhere/out.cli");
    expect_failure(job, "does not exist");
    job = plain;
    job.write.most_bytes = 1000;
    expect_failure(job, "more than the 1000"); // bytes, as one process says it, or several of all pieces
    job.format = "npz";
    expect_failure(job, "1000 bytes that it may");
}

} // namespace
} // namespace lamella
