#include "lamella/core/error.hpp"
#include "lamella/jobs/slice_file.hpp"
#include "lamella/meshes/mesh_writer.hpp"

#include "parts/shapes.hpp"
#include "temporary_folder.hpp"
#include "thread_processes.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace lamella::processes_cases {
namespace {

TEST(SlicingTogether, RefusesJobsThatOnlyASingleProcessCanDo) {
    FileJob shard;
    shard.inputs = {{.path = "part.stl"}};
    FileJob page = shard;
    FileJob input = shard;
    shard.shard = Shard{1, 2};
    page.report.path = "page.html";
    input.inputs.front().path = "-";
    for (const auto& [job, words] :
         {std::pair(shard, "not those of a shard"), std::pair(page, "lamella view"),
          std::pair(input, "standard input reaches one of the processes only")}) {
        const Error error = test::common_failure(
            2, [&, &job = job](Communicator& own) { static_cast<void>(slice_file(job, {}, own)); });
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
}

TEST(SlicingTogether, HasTheFiguresOfEachProcess) {
    const TemporaryFolder folder;
    const TriangleSoup body = make_torus(20, 8, 100, 100);
    write_stl(folder.file("part.stl"), body);
    FileJob job;
    job.inputs = {{.path = folder.file("part.stl")}};
    job.layering.cut = UniformLayers{.layer_height = 1};
    for (const std::size_t count : {1U, 2U, 3U})
        for (const FileResult& result : test::slice_by(count, job)) {
            ASSERT_EQ(result.processes.size(), count);
            ProcessFigures all;
            for (const ProcessFigures& one : result.processes) {
                all.triangles_read += one.triangles_read;
                all.planes += one.planes;
                all.points += one.points;
                EXPECT_EQ(one.bytes_sent > 0, one.triangles_read > 0);
            }
            if (count > 1) {
                EXPECT_EQ(all.triangles_read, body.size());
            }
            EXPECT_EQ(all.planes, result.report.layers);
            EXPECT_EQ(all.points, result.report.points);
        }
}

} // namespace
} // namespace lamella::processes_cases
