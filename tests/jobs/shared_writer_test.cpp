#include "fixtures/layers.hpp"
#include "fixtures/sample_layers.hpp"
#include "jobs/shared_writer.hpp"
#include "temporary_folder.hpp"
#include "thread_processes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lamella::shared_writer_cases {
namespace {

/// The planes of a process. If there are more processes than planes, the last ones have none.
PlaneRange range_of(std::size_t planes, const Communicator& own) {
    const std::size_t busy = std::min(planes, own.size());
    const auto bound = [&](std::size_t p) {
        return static_cast<std::uint32_t>(planes * std::min(p, busy) / busy);
    };
    return {bound(own.process()), bound(own.process() + 1)};
}

TEST(SharedWriter, WritesTheBytesOfOneWriterForAnyNumberOfProcesses) {
    const LayerStack layers = random_layers(7, 30, 20, {25, 25}, false);
    for (const LayerFormat& format : layer_formats()) {
        if (format.directory || format.exposure)
            continue;
        const TemporaryFolder folder;
        const OutputFiles files{.path = folder.file("out"), .format = &format, .write = options_for_any()};
        const std::vector<std::string> warnings =
            write_layers(files.path, format, test::planes_of(layers), info_of(layers), files.write);
        const std::string expected = file_bytes(files.path);
        for (const std::size_t processes : {1U, 2U, 5U, 40U})
            for (const std::uint64_t in_memory : {std::uint64_t{0}, std::uint64_t{1} << 20}) {
                write_file(files.path, "old");
                test::run_processes(processes, [&](Communicator& own) {
                    Agreement agreement(own);
                    const PlaneRange mine = range_of(layers.size(), own);
                    SharedWriter writer(files, info_of(layers), mine, agreement, in_memory);
                    for (std::uint32_t i = mine.begin; i < mine.end; ++i)
                        writer.prepare(layers[i])();
                    EXPECT_EQ(file_bytes(files.path), "old") << "no name before all of it is written";
                    writer.finish();
                    EXPECT_EQ(writer.bytes(), expected.size()) << format.name;
                    EXPECT_EQ(writer.warnings(), warnings) << format.name;
                    agreement.gather({}); // process 0 has given the file its name
                });
                EXPECT_EQ(file_bytes(files.path), expected) << format.name << ' ' << processes;
            }
    }
}

TEST(SharedWriter, LeavesTheOldFileWhereItIsNotFinished) {
    const TemporaryFolder folder;
    const LayerStack layers = square_with_hole();
    for (const std::string name : {"cli", "npz"}) {
        const OutputFiles files{.path = folder.file("out"), .format = &layer_format(name, "")};
        write_file(files.path, "old");
        test::run_processes(3, [&](Communicator& own) {
            Agreement agreement(own);
            const SharedWriter writer(files, info_of(layers), range_of(layers.size(), own), agreement, 0);
        });
        EXPECT_EQ(folder.entries(), std::vector<std::string>{"out"});
        EXPECT_EQ(file_bytes(files.path), "old");
    }
}

} // namespace
} // namespace lamella::shared_writer_cases
