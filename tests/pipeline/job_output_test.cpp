#include "pipeline/job_output.hpp"
#include "temporary_folder.hpp"
#include "thread_processes.hpp"
#include "write/sample_layers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lamella::job_output_cases {
namespace {

/// The planes of a process. If there are more processes than planes, the last ones have none.
PlaneRange range_of(std::size_t planes, const Communicator& own) {
    const std::size_t busy = std::min(planes, own.size());
    const auto bound = [&](std::size_t p) {
        return static_cast<std::uint32_t>(planes * std::min(p, busy) / busy);
    };
    return {bound(own.process()), bound(own.process() + 1)};
}

TEST(JobOutput, HasTheBytesOfOneWriterForAnyNumberOfProcesses) {
    const LayerStack layers = random_layers(7, 30, 20, {25, 25}, false);
    for (const LayerFormat& format : layer_formats()) {
        if (format.directory || format.name.starts_with("sl1"))
            continue;
        const TemporaryFolder folder;
        const OutputFiles files{.path = folder.file("out"), .format = &format, .write = options_for_any()};
        write_layers(files.path, format, layers, info_of(layers), files.write);
        const std::string expected = file_bytes(files.path);
        for (const std::size_t processes : {1U, 2U, 5U, 40U})
            for (const std::uint64_t in_memory : {std::uint64_t{0}, std::uint64_t{1} << 20}) {
                write_file(files.path, "old");
                test::run_processes(processes, [&](Communicator& own) {
                    const PlaneRange mine = range_of(layers.size(), own);
                    JobOutput output(files, info_of(layers), mine, own, in_memory);
                    EXPECT_FALSE(output.has_page());
                    for (std::uint32_t i = mine.begin; i < mine.end; ++i)
                        output.prepare({&layers[i], 1})();
                    EXPECT_EQ(file_bytes(files.path), "old") << "no name before all of it is written";
                    FileResult written;
                    output.finish_file(written);
                    EXPECT_EQ(written.format, format.name);
                    EXPECT_EQ(written.bytes, expected.size()) << format.name;
                });
                EXPECT_EQ(file_bytes(files.path), expected) << format.name << ' ' << processes;
            }
    }
}

TEST(JobOutput, OfNothingWritesNothing) {
    const LayerStack layers = square_with_hole();
    JobOutput output({}, info_of(layers), {0, 2});
    EXPECT_FALSE(output.prepare(layers)) << "there is nothing to do";
    FileResult written;
    output.finish_file(written);
    EXPECT_EQ(written.format, "");
}

TEST(JobOutput, LeavesTheOldFileWhereItIsNotFinished) {
    const TemporaryFolder folder;
    const OutputFiles files{.path = folder.file("out.cli"), .format = &layer_format("cli", "")};
    write_file(files.path, "old");
    const LayerStack layers = square_with_hole();
    for (const std::size_t processes : {1U, 3U})
        test::run_processes(processes, [&](Communicator& own) {
            JobOutput output(files, info_of(layers), range_of(layers.size(), own), own, 0);
        });
    EXPECT_EQ(folder.entries(), std::vector<std::string>{"out.cli"});
    EXPECT_EQ(file_bytes(files.path), "old");
}

} // namespace
} // namespace lamella::job_output_cases
