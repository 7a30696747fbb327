#include "fixtures/layers.hpp"
#include "fixtures/sample_layers.hpp"
#include "jobs/job_output.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lamella::job_output_cases {
namespace {

TEST(JobOutput, HasTheBytesOfItsWriter) {
    const LayerStack layers = square_with_hole();
    const TemporaryFolder folder;
    const OutputFiles files{.path = folder.file("out"), .format = &layer_format("cli", "")};
    write_layers(files.path, *files.format, test::planes_of(layers), info_of(layers), files.write);
    const std::string expected = file_bytes(files.path);
    write_file(files.path, "old");
    JobOutput output(files, info_of(layers));
    EXPECT_FALSE(output.has_page());
    for (const Layer& layer : layers)
        output.prepare(layer)();
    EXPECT_EQ(file_bytes(files.path), "old") << "no name before all of it is written";
    FileResult written;
    output.finish_file(written);
    EXPECT_EQ(written.format, "cli");
    EXPECT_EQ(written.bytes, expected.size());
    EXPECT_EQ(file_bytes(files.path), expected);
}

TEST(JobOutput, OfNothingWritesNothing) {
    const LayerStack layers = square_with_hole();
    JobOutput output({}, info_of(layers));
    EXPECT_FALSE(output.prepare(layers.front())) << "there is nothing to do";
    FileResult written;
    output.finish_file(written);
    EXPECT_EQ(written.format, "");
}

TEST(JobOutput, LeavesTheOldFileWhereItIsNotFinished) {
    const TemporaryFolder folder;
    const OutputFiles files{.path = folder.file("out.cli"), .format = &layer_format("cli", "")};
    write_file(files.path, "old");
    const LayerStack layers = square_with_hole();
    { const JobOutput output(files, info_of(layers)); }
    EXPECT_EQ(folder.entries(), std::vector<std::string>{"out.cli"});
    EXPECT_EQ(file_bytes(files.path), "old");
}

} // namespace
} // namespace lamella::job_output_cases
