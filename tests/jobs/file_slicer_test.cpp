#include "lamella/jobs/slice_file.hpp"
#include "lamella/meshes/mesh_writer.hpp"

#include "expect_same_result.hpp"
#include "jobs/file_slicer.hpp"
#include "parts/shapes.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace lamella::file_slicer_cases {
namespace {

TEST(FileSlicer, OfSharesHasTogetherTheFiguresOfTheWholeJob) {
    const TemporaryFolder folder;
    write_stl(folder.file("part.stl"), make_torus(20, 8, 60, 40));
    FileJob job;
    job.inputs = {{.path = folder.file("part.stl"), .copies = 2}};
    job.layering.cut = UniformLayers{.layer_height = 1};
    job.layer_statistics = true;
    const FileResult whole = slice_file(job);
    for (const std::uint32_t count : {1U, 3U, 30U}) { // of the last, some have no planes
        FileSlicer all(job, {}, nullptr, {1, count});
        JobOutput nothing(all.files(), all.info());
        std::uint32_t next = 0;
        for (std::uint32_t number = 1; number <= count; ++number) {
            FileSlicer one(job, {}, nullptr, {number, count});
            EXPECT_EQ(one.mine().begin, next);
            next = one.mine().end;
            FileSlicer& slicer = number == 1 ? all : one;
            slicer.slice(nothing);
            Packer figures;
            slicer.move_to(figures);
            const std::string message = figures.take();
            Unpacker from(message);
            all.add(from);
        }
        EXPECT_EQ(next, whole.planned_layers);
        test::expect_same(all.finish(nothing), whole);
    }
}

} // namespace
} // namespace lamella::file_slicer_cases
