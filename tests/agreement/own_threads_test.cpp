// Threads of the caller give what threads of Lamella give, and Lamella starts none then.

#include "parts/shapes.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>
#include <lamella/jobs.hpp>

#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

namespace lamella::own_threads_cases {
namespace {

using RunTasks = std::function<void(unsigned, const std::function<void(unsigned)>&)>;

/// Tasks one after the other, the last one first.
void run_backwards(unsigned tasks, const std::function<void(unsigned)>& task) {
    for (unsigned i = tasks; i > 0; --i)
        task(i - 1);
}

/// Two threads for all tasks, as a pool has fewer threads than tasks.
void run_in_pairs(unsigned tasks, const std::function<void(unsigned)>& task) {
    std::thread odd([&] {
        for (unsigned i = 1; i < tasks; i += 2)
            task(i);
    });
    for (unsigned i = 0; i < tasks; i += 2)
        task(i);
    odd.join();
}

std::string job(const std::string& mesh, const Execution& execution) {
    const TemporaryFolder folder;
    FileJob job;
    job.inputs = {{.path = mesh}};
    job.layering.cut = UniformLayers{.layer_height = 0.05};
    job.output = folder.file("layers.cli");
    job.scan = ScanStrategy{};
    static_cast<void>(slice_file(job, execution));
    const LayerFile layers = read_layers(job.output, {}, execution);
    write_layers(folder.file("again.svg"), layers.merged(execution), {}, execution);
    std::string bytes;
    for (const std::string& path : {job.output, folder.file("again.svg")}) {
        std::ifstream file(path, std::ios::binary);
        bytes.append(std::istreambuf_iterator<char>(file), {});
    }
    return bytes;
}

TEST(OwnThreads, GiveTheSameBytesHoweverTheyRun) {
    const TemporaryFolder folder;
    const std::string mesh = folder.file("lattice.stl");
    write_stl(mesh, make_lattice({.cells_x = 3, .cells_y = 3, .cells_z = 3}));
    const std::string expected = job(mesh, {.threads = 3});
    EXPECT_GT(expected.size(), 100'000U);
    for (const RunTasks& run : {RunTasks(run_backwards), RunTasks(run_in_pairs)})
        for (const unsigned threads : {1U, 2U, 7U})
            EXPECT_TRUE(job(mesh, {.threads = threads, .run_tasks = run}) == expected) << threads;
}

} // namespace
} // namespace lamella::own_threads_cases
