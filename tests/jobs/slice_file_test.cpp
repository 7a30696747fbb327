#include "lamella/core/error.hpp"
#include "lamella/jobs/slice_file.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/meshes/mesh_writer.hpp"

#include "expect_same_result.hpp"
#include "fixtures/any_printer.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/packages.hpp"
#include "fixtures/rounds.hpp"
#include "parts/shapes.hpp"
#include "temporary_folder.hpp"
#include "thread_processes.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <ios>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

// Processes as threads of one process: all of slice_file by several but the messages themselves.

namespace lamella {
namespace {

/// What is sliced. With a sanitizer it is a part with fewer triangles.
TriangleSoup part() {
    return test::slowed ? make_torus(20, 10, 120, 60) : make_rook();
}

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

    TemporaryFolder folder_;
};

TEST_F(Processes, WriteTheBytesOfOneProcessWithAnyNumberOfThem) {
    write_stl(path("part.stl"), part());
    const auto numbers_of_processes =
        test::slowed ? std::vector<std::size_t>{3} : std::vector<std::size_t>{1, 2, 3, 5, 50};
    for (const LayerFormat& format : layer_formats()) {
        if (format.directory)
            continue;
        if (test::slowed &&
            format.name == "3mf-toolpath") // has no heights below 0, to where the torus reaches
            continue;
        FileJob job = job_of({{.path = path("part.stl")}}, 1.5);
        job.format = format.name;
        job.write.printer = &test::any_printer;
        job.write.page.viewer = "<!--lamella-data-->"; // what the library asks of a viewer
        job.output = path("one");
        const FileResult one = slice_file(job);
        const std::string expected = content("one");
        for (const std::size_t processes : numbers_of_processes) {
            SCOPED_TRACE(testing::Message() << format.name << " by " << processes);
            job.output = path("one"); // some formats repeat the name
            for (const FileResult& many : test::slice_by(processes, job))
                test::expect_same(one, many);
            EXPECT_EQ(content("one"), expected);
        }
    }
}

TEST_F(Processes, WriteTheBytesOfAMeshInMemoryIfTheySliceWhileTheyRead) {
    write_stl(path("part.stl"), part());
    FileJob job = job_of({{.path = path("part.stl")}}, 1.5);
    for (const double degrees : {0, 15}) {
        job.inputs.front().placement = rotation('y', degrees);
        job.output = path("part.cli");
        const FileResult expected = slice_file(job, load_plate(job.inputs));
        const std::string bytes = content("part.cli");
        for (const unsigned threads : test::thread_counts()) {
            test::expect_same(slice_file(job, {.threads = threads}), expected);
            EXPECT_EQ(content("part.cli"), bytes);
        }
    }
}

TEST_F(Processes, SubtractNegativeVolumesAlike) {
    using package_test::box_mesh;
    using package_test::components;
    using package_test::object;
    const std::string moved = "transform=\"1 0 0 0 1 0 0 0 1 2 2 4\"";
    const std::string bytes = package_test::package(
        package_test::model(object(1, box_mesh(10, 10, 10)) +
                                object(2, box_mesh(4, 4, 20), "type=\"other\"") +
                                object(3, components({{1, ""}, {2, moved}})),
                            "<item objectid=\"3\"/>"),
        {{"Metadata/model_settings.config", "<config><object id=\"3\"><part id=\"1\"/><part id=\"2\" "
                                            "subtype=\"negative_part\"/></object></config>"}});
    std::ofstream(path("part.3mf"), std::ios::binary) << bytes;
    FileJob job = job_of({{.path = path("part.3mf"), .copies = 3}}, 0.5);
    job.output = path("one.cli");
    const FileResult one = slice_file(job);
    ASSERT_EQ(one.layers.size(), 20U);
    EXPECT_NEAR(one.layers[0].measure.area_mm2, 300, 1e-9);
    EXPECT_NEAR(one.layers[19].measure.area_mm2, 3 * (100 - 16), 1e-9);
    const std::string expected = content("one.cli");
    for (const std::size_t processes : {2U, 3U, 50U}) {
        for (const FileResult& many : test::slice_by(processes, job))
            test::expect_same(one, many);
        EXPECT_EQ(content("one.cli"), expected);
    }
    job.max_memory = 100'000'000;
    static_cast<void>(slice_file(job));
    EXPECT_EQ(content("one.cli"), expected);
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
        test::slowed ? std::vector<std::size_t>{3} : std::vector<std::size_t>{2, 5};
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const FileResult one = slice_file(jobs[i]);
        const std::string expected = content("out.cli");
        for (const std::size_t processes : numbers_of_processes) {
            SCOPED_TRACE(testing::Message() << "job " << i << " by " << processes);
            for (const FileResult& many : test::slice_by(processes, jobs[i]))
                test::expect_same(one, many);
            EXPECT_EQ(content("out.cli"), expected);
        }
    }
}

/// Two boxes on one another, 10 x 10 x 2.5 and 5 x 8 x 2.5 mm, rotated by 30 degrees to single precision.
TriangleSoup tilted_steps() {
    std::vector<Triangle3f> triangles;
    const auto add = [&](const TriangleSoup& box) {
        const TriangleSoup tilted = box.transformed(rotation('x', 30));
        for (std::size_t i = 0; i < tilted.size(); ++i) {
            const Triangle3 t = tilted.placed(i);
            Triangle3f& to = triangles.emplace_back();
            for (std::size_t k = 0; k < 3; ++k)
                to.at(k) = {static_cast<float>(t.at(k).x), static_cast<float>(t.at(k).y),
                            static_cast<float>(t.at(k).z)};
        }
    };
    add(make_box(10, 10, 2.5));
    add(make_box(5, 8, 2.5).transformed(translation(2, 1, 2.5)));
    return TriangleSoup(triangles);
}

TEST_F(Processes, SnapAndWarnOfLevelFacesNearPlanesAlike) {
    write_stl(path("tilted.stl"), tilted_steps());
    const PlateInput input{.path = path("tilted.stl"), .placement = rotation('x', -30)};
    FileJob job = job_of({input}, 0.5);
    job.layering.at = SliceAt::bottom;
    job.output = path("out.json");
    const FileResult bent = slice_file(job);
    const Finding& near = bent.findings.of(FindingKind::near_faces, 0);
    EXPECT_EQ(near.first_z, bent.layers.front().z);
    EXPECT_GE(near.amount, 100);
    EXPECT_LT(near.largest, 1e-5);
    const std::string text = near.text();
    EXPECT_NE(text.find("`snap_mm` 1e-"), std::string::npos) << text;
    EXPECT_LT(bent.layers.front().measure.area_mm2, 99);
    std::vector<FileResult> expected{bent};
    job.layering.snap_mm = 1e-5;
    expected.push_back(slice_file(job));
    const FileResult& snapped = expected.back();
    EXPECT_EQ(snapped.findings.of(FindingKind::near_faces).layers, 0U);
    EXPECT_NEAR(snapped.layers.front().measure.area_mm2, 100, 1e-3);
    EXPECT_NEAR(snapped.layers[5].measure.area_mm2, 40, 1e-3);
    const std::string bytes = content("out.json");
    for (const std::size_t processes : {2, 5})
        for (const FileResult& one : expected) {
            SCOPED_TRACE(testing::Message() << "by " << processes);
            job.layering.snap_mm = &one == &snapped ? 1e-5 : 0;
            for (const FileResult& many : test::slice_by(processes, job))
                test::expect_same(one, many);
        }
    EXPECT_EQ(content("out.json"), bytes);
    // Of each shard its own layers; strict refuses them.
    std::uint64_t layers = 0;
    job.layering.snap_mm = 0;
    for (std::uint32_t number = 1; number <= 3; ++number) {
        job.shard = Shard{.number = number, .count = 3};
        layers += slice_file(job).findings.of(FindingKind::near_faces).layers;
    }
    EXPECT_EQ(layers, near.layers);
    job.shard.reset();
    job.strict = true;
    const std::string refusal =
        test::error_of(ErrorKind::defect, [&] { static_cast<void>(slice_file(job)); });
    EXPECT_NE(refusal.find("tilted.stl: "), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("mm2 of level faces"), std::string::npos) << refusal;
    job.layering.snap_mm = 1e-5;
    EXPECT_NO_THROW(static_cast<void>(slice_file(job)));
}

TEST_F(Processes, CountTheLossesOfAFormatTogether) {
    write_stl(path("part.stl"), make_box(10, 10, 2.05).transformed(rotation('z', 20)));
    FileJob job = job_of({{.path = path("part.stl"), .label = "a, \"b\""}}, 0.1);
    job.layering.at = SliceAt::top;
    job.write.units_mm = 0.05;
    for (const std::string name : {"cli", "cli-ascii", "dxf", "3mf"}) {
        job.format = name;
        job.output = path("out");
        const FileResult one = slice_file(job);
        EXPECT_FALSE(one.losses.empty()) << name;
        for (const std::size_t processes : {2, 3, 50}) {
            SCOPED_TRACE(testing::Message() << name << " by " << processes);
            for (const FileResult& many : test::slice_by(processes, job))
                EXPECT_EQ(many.losses.by_file, one.losses.by_file);
        }
    }
    job.format = "cli";
    job.output = path("strict.cli");
    job.strict = job.write.strict = true;
    std::string refusal;
    try {
        static_cast<void>(slice_file(job));
    } catch (const Error& error) {
        refusal = error.what();
    }
    EXPECT_NE(refusal, "");
    for (const std::size_t processes : {2, 50}) {
        const Error error = test::common_failure(
            processes, [&](Communicator& own) { static_cast<void>(slice_file(job, {}, own)); });
        EXPECT_EQ(error.kind(), ErrorKind::defect);
        EXPECT_EQ(error.what(), refusal);
    }
    EXPECT_FALSE(std::filesystem::exists(path("strict.cli")));
}

TEST_F(Processes, FailOnAllWithTheSameWords) {
    write_stl(path("part.stl"), part());
    FileJob plain = job_of({{.path = path("part.stl")}}, 0.1);
    plain.output = path("out.cli");
    const auto expect_failure = [&](const FileJob& job, const std::string& words) {
        for (const std::size_t processes : {1, 3}) {
            const Error error = test::common_failure(processes, [&](Communicator& own) {
                static_cast<void>(slice_file(job, {.threads = 2}, own));
            });
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
            EXPECT_EQ(folder_.entries(), std::vector<std::string>{"part.stl"});
        }
    };
    FileJob job = plain;
    job.inputs.front().path = path("missing.stl");
    expect_failure(job, "no such file");
    // What is impossible in any file is found before that.
    job.inputs.front().copies = 0;
    expect_failure(job, "0 copies");
    job.inputs.front().copies = 1;
    job.repair.close_gaps_mm = -1;
    expect_failure(job, "gaps up to -1 mm");
    job.repair = {};
    job.repair.weld_tolerance_mm = 0;
    expect_failure(job, "weld tolerance");
    job.repair = {};
    job.steps.simplify_mm = -1;
    expect_failure(job, "simplified");
    job.inputs = {};
    expect_failure(job, "at least one");
    job = plain;
    job.inputs.front().path = "-";
    expect_failure(job, "standard input");
    job = plain;
    job.layering.cut = UniformLayers{.layer_height = 1000};
    expect_failure(job, "layer height");
    job = plain;
    job.output = path("nowhere/out.cli");
    expect_failure(job, "does not exist");
    job.output = path("nowhere/out.npz"); // which one of the processes writes
    expect_failure(job, "does not exist");
    job = plain;
    job.write.most_bytes = 1000;
    expect_failure(job, "more than the 1000"); // bytes, as one process says it, or several of all pieces
    job.format = "npz";
    expect_failure(job, "1000 bytes that it may");
}

/// How often each process tells of the progress of each stage, by one thread.
std::vector<std::map<Stage, int>> calls_of(const FileJob& job, std::size_t processes) {
    std::vector<std::map<Stage, int>> calls(processes);
    test::run_processes(processes, [&](Communicator& own) {
        const Execution counted{.threads = 1, .progress = [&](const Progress& progress) {
                                    ++calls[own.process()][progress.stage];
                                }};
        static_cast<void>(slice_file(job, counted, own));
    });
    return calls;
}

TEST_F(Processes, StopTogetherWhicheverOfThemFailsInWhateverStage) {
    write_stl(path("part.stl"), part());
    write_stl_ascii(path("ascii.stl"), make_torus(20, 10, 60, 30), "part");
    const std::vector<std::string> inputs = folder_.entries();
    constexpr std::size_t processes = 3;
    for (const std::string& input : inputs) {
        FileJob job = job_of({{.path = path(input)}}, 2);
        job.output = path("out");
        job.format = input == "part.stl" ? "cli" : "npz"; // written by all processes, by one of them
        const std::vector<std::map<Stage, int>> calls = calls_of(job, processes);
        std::filesystem::remove(path("out"));
        for (std::size_t failing = 0; failing < processes; ++failing)
            for (const auto& [stage, count] : calls[failing])
                for (const int call : std::set{1, count / 2 + 1, 5 * count / 6 + 1, count}) {
                    SCOPED_TRACE(testing::Message() << input << ": process " << failing << " at call " << call
                                                    << " of " << count << " of " << stage_name(stage));
                    const Error error = test::common_failure(processes, [&,
                                                                         stage = stage](Communicator& own) {
                        int left = own.process() == failing ? call : 0;
                        const Execution execution{.threads = 1, .progress = [&](const Progress& progress) {
                                                      if (progress.stage == stage && --left == 0)
                                                          throw Error(ErrorKind::limit, "no further");
                                                  }};
                        static_cast<void>(slice_file(job, execution, own));
                    });
                    EXPECT_EQ(error.kind(), ErrorKind::limit);
                    EXPECT_STREQ(error.what(), "no further");
                    EXPECT_EQ(folder_.entries(), inputs);
                }
    }
}

TEST_F(Processes, LeaveTheFileAsItWasWhereTheyFail) {
    write_stl(path("part.stl"), make_torus(20, 10, 60, 30));
    write_file(path("out.cli"), "what was there");
    FileJob job = job_of({{.path = path("part.stl")}}, 1);
    job.output = path("out.cli");
    job.write.most_bytes = 1000;
    for (const std::size_t processes : {1, 3})
        EXPECT_EQ(test::common_failure(
                      processes, [&](Communicator& own) { static_cast<void>(slice_file(job, {}, own)); })
                      .kind(),
                  ErrorKind::limit);
    EXPECT_EQ(content("out.cli"), "what was there");
}

} // namespace
} // namespace lamella
