#include "lamella/inputs/read_file.hpp"

#include "container/protobuf.hpp"
#include "fixtures/expect_error.hpp"
#include "slices/formats/ovf_format.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::ovf_cases {
namespace {

std::string error_of(const std::string& bytes) {
    return test::error_of(ErrorKind::input, [&] {
        static_cast<void>(read_layers(std::as_bytes(std::span(bytes)), "test.ovf"));
    });
}

void put_position(std::string& file, std::size_t at, std::uint64_t position) {
    std::memcpy(file.data() + at, &position, sizeof position);
}

/// A job without blocks, whose table names its one work plane so many times.
std::string plane_named(std::size_t times) {
    std::string file(ovf::magic);
    file.append(8, '\0');
    const std::size_t job = file.size();
    file += ProtobufMessage().delimited();
    const std::size_t plane = file.size();
    file.append(8, '\0');
    const std::size_t shell = file.size();
    ProtobufMessage header;
    header.real(ovf::work_plane::z, 1);
    header.text(99, std::string(100, 'x'));
    file += header.delimited();
    put_position(file, plane, file.size());
    ProtobufMessage of_plane;
    of_plane.integer(ovf::table::shell, static_cast<std::int64_t>(shell));
    file += of_plane.delimited();
    put_position(file, ovf::magic.size(), file.size());
    ProtobufMessage of_job;
    of_job.integer(ovf::table::shell, static_cast<std::int64_t>(job));
    of_job.integers(ovf::table::positions, std::vector<std::uint64_t>(times, plane));
    return file + of_job.delimited();
}

TEST(ReadOvf, ReadsNoMoreThanTheFileHolds) {
    const std::string once = plane_named(1);
    EXPECT_EQ(read_layers(std::as_bytes(std::span(once)), "test.ovf").in_memory().at(0).layers.size(), 1U);
    EXPECT_NE(error_of(plane_named(1000)).find("found a second table, header or block"), std::string::npos);
}

TEST(ReadOvf, ABrokenListOfPositionsHasItsPlace) {
    std::string file(ovf::magic);
    file.append(8, '\0');
    put_position(file, ovf::magic.size(), file.size());
    ProtobufMessage table;
    table.text(ovf::table::positions, "\xff");
    file += table.delimited();
    EXPECT_EQ(error_of(file), fmt::format("test.ovf, byte {}: found the end of a message within a number; "
                                          "the file is damaged or truncated",
                                          file.size() - 1));
}

struct PlaneMessage {
    double z;
    std::vector<ProtobufMessage> blocks;
    std::int64_t repeats = 0;
    bool backwards = false; ///< the last block comes first in the file; the table has them in order
    std::size_t named = 1;  ///< how often the table has the first block
    std::int64_t announced = 0;
    std::int64_t number = 0;
};

/// A job with the parameters 1, 2 and 3 and these parts, which announces so many planes.
std::string job_of(const std::vector<PlaneMessage>& planes, const std::vector<std::string>& parts = {"AA1"},
                   std::int64_t announced = 0, double speed = 800) {
    std::string file(ovf::magic);
    file.append(8, '\0');
    std::vector<std::uint64_t> locations;
    for (const PlaneMessage& plane : planes) {
        locations.push_back(file.size());
        file.append(8, '\0');
        std::vector<std::uint64_t> blocks(plane.blocks.size());
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            const std::size_t next = plane.backwards ? blocks.size() - 1 - i : i;
            blocks[next] = file.size();
            file += plane.blocks[next].delimited();
        }
        if (!blocks.empty())
            blocks.insert(blocks.begin(), plane.named - 1, blocks.front());
        ProtobufMessage header;
        header.real(ovf::work_plane::z, plane.z);
        header.integer(ovf::work_plane::block_count, plane.announced);
        header.integer(ovf::work_plane::repeats, plane.repeats);
        header.integer(ovf::work_plane::number, plane.number);
        ProtobufMessage table;
        table.integer(ovf::table::shell, static_cast<std::int64_t>(file.size()));
        table.integers(ovf::table::positions, blocks);
        file += header.delimited();
        put_position(file, locations.back(), file.size());
        file += table.delimited();
    }
    ProtobufMessage job;
    job.integer(ovf::job::work_plane_count, announced);
    for (std::int64_t key = 1; key <= 3; ++key) {
        ProtobufMessage parameters;
        parameters.real(ovf::marking::speed_mm_s, speed);
        job.entry(ovf::job::marking_params, key, parameters);
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
        ProtobufMessage part;
        part.text(ovf::part::name, parts[i]);
        job.entry(ovf::job::parts, static_cast<std::int64_t>(i + 1), part);
    }
    ProtobufMessage table;
    table.integer(ovf::table::shell, static_cast<std::int64_t>(file.size()));
    table.integers(ovf::table::positions, locations);
    file += job.delimited();
    put_position(file, ovf::magic.size(), file.size());
    return file + table.delimited();
}

/// Two points, as lines or as a hatch, of a part; without metadata of what they are of.
ProtobufMessage block(std::uint32_t kind, std::int64_t parameters, std::int64_t part = 1,
                      bool empty = false) {
    const float numbers[] = {1, 2, 3, 4};
    ProtobufMessage vectors;
    vectors.text(ovf::block::points, {reinterpret_cast<const char*>(numbers), empty ? 0 : sizeof numbers});
    ProtobufMessage of_part;
    of_part.integer(ovf::block::meta::part_key, part);
    ProtobufMessage result;
    result.message(kind, vectors);
    result.integer(ovf::block::marking_params_key, parameters);
    result.message(ovf::block::meta_data, of_part);
    return result;
}

LayerFile read(const std::string& bytes) {
    return read_layers(std::as_bytes(std::span(bytes)), "test.ovf");
}

TEST(ReadOvf, SaysWhichLayersLoseTheOrderOfExecution) {
    const ProtobufMessage hatch = block(ovf::block::hatches, 1);
    const ProtobufMessage lines = block(ovf::block::line_sequence, 2);
    EXPECT_TRUE(read(job_of({{1, {hatch, lines}}, {2, {hatch, hatch, lines}}})).warnings.empty());
    // Contours first; and a hatch in two goes.
    const LayerFile file =
        read(job_of({{1, {hatch, lines}}, {3, {hatch, lines, hatch}}, {2, {lines, hatch}}}));
    ASSERT_EQ(file.warnings.size(), 2U);
    EXPECT_EQ(file.warnings[1],
              "vectors of 2 layers, the lowest at z = 2 mm, are executed in another order in the file; they "
              "were put into that of the parts");
    // Hatches without lines are none.
    const ProtobufMessage empty = block(ovf::block::hatches, 1, 1, true);
    EXPECT_TRUE(read(job_of({{1, {hatch, lines, empty}}})).warnings.empty());
    // Plain contours have no order.
    const ProtobufMessage plain = block(ovf::block::line_sequence, 0);
    EXPECT_TRUE(read(job_of({{1, {hatch, plain}}})).warnings.empty());
}

TEST(ReadOvf, ABlockIsExecutedOnce) {
    const std::vector<std::string> parts{std::string(500, 'x')}; // so that there are bytes to spare
    PlaneMessage plane{1, {block(ovf::block::hatches, 1)}};
    EXPECT_EQ(read(job_of({plane}, parts)).parts.size(), 1U);
    plane.named = 2;
    EXPECT_NE(error_of(job_of({plane}, parts)).find("found a second table, header or block"),
              std::string::npos);
}

TEST(ReadOvf, BlocksMayLieInAnotherOrderThanTheirTableHasThemIn) {
    std::vector<ProtobufMessage> blocks;
    for (std::int64_t part = 3; part > 0; --part)
        blocks.push_back(block(ovf::block::hatches, 1, part));
    const std::vector<std::string> parts{"a", "b", "c"};
    const LayerFile in_order = read(job_of({{1, blocks}, {2, blocks}}, parts));
    const LayerFile backwards = read(job_of({{1, blocks, 0, true}, {2, blocks, 0, true}}, parts));
    const std::vector<LayerPart> backwards_parts = backwards.in_memory();
    EXPECT_EQ(backwards.warnings, in_order.warnings);
    ASSERT_EQ(backwards.parts.size(), 3U);
    for (std::size_t i = 0; i < backwards.parts.size(); ++i) {
        EXPECT_EQ(backwards.parts[i].label, in_order.parts[i].label);
        ASSERT_EQ(backwards_parts[i].layers.size(), 2U);
        EXPECT_EQ(backwards_parts[i].hatches_of(1).size(), 2U);
    }
}

TEST(ReadOvf, TakesFromTheVectorsWhatTheMetadataDoNotSay) {
    const LayerFile file =
        read(job_of({{1, {block(ovf::block::hatches, 1), block(ovf::block::line_sequence, 1)}}}));
    ASSERT_EQ(file.parts.size(), 2U);
    EXPECT_EQ(file.parts[0].label, "AA1 core hatch");
    EXPECT_EQ(file.parts[1].label, "AA1 core contour 1");
}

TEST(ReadOvf, RefusesParametersThatTheJobDoesNotHave) {
    EXPECT_NE(error_of(job_of({{1, {block(ovf::block::hatches, 9)}}}))
                  .find("found a block with parameters of the key 9; the job must have them"),
              std::string::npos);
}

TEST(ReadOvf, SaysWhatItLeavesOutOfTheExecution) {
    ProtobufMessage twice = block(ovf::block::hatches, 1);
    twice.integer(ovf::block::repeats, 1);
    twice.integer(ovf::block::laser_index, 2);
    ProtobufMessage other = block(ovf::block::hatches, 1);
    other.integer(ovf::block::laser_index, 1);
    const std::vector<std::string> warnings = read(job_of({{1, {twice, other}, 3}})).warnings;
    ASSERT_EQ(warnings.size(), 3U);
    EXPECT_TRUE(warnings[0].starts_with("1 block is to be executed more than once")) << warnings[0];
    EXPECT_TRUE(warnings[1].starts_with("1 work plane is to be executed more than once")) << warnings[1];
    EXPECT_TRUE(warnings[2].starts_with("2 blocks are for another laser than the first")) << warnings[2];
}

TEST(ReadOvf, SaysWherePlanesAndBlocksLack) {
    const ProtobufMessage hatch = block(ovf::block::hatches, 1);
    const PlaneMessage first{.z = 1, .blocks = {hatch}, .announced = 1};
    PlaneMessage second{.z = 2, .blocks = {hatch, hatch}, .announced = 2, .number = 1};
    EXPECT_TRUE(read(job_of({first, second}, {"AA1"}, 2)).warnings.empty());
    EXPECT_EQ(read(job_of({first, second}, {"AA1"}, 3)).warnings,
              std::vector<std::string>{"the job announces 3 work planes; the file has 2"});
    second.announced = 3;
    second.number = 2;
    const std::vector<std::string> warnings = read(job_of({first, second}, {"AA1"}, 2)).warnings;
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_TRUE(warnings[0].starts_with("1 work plane announces another number of blocks")) << warnings[0];
    EXPECT_TRUE(warnings[1].starts_with("1 number of a work plane does not follow")) << warnings[1];
}

TEST(ReadOvf, RefusesNegativeSpeeds) {
    const std::string file = job_of({{1, {block(ovf::block::hatches, 1)}}}, {"AA1"}, 0, -800);
    EXPECT_NE(error_of(file).find("found parameters with a speed below 0; it must be 0 or more"),
              std::string::npos)
        << error_of(file);
}

TEST(ReadOvf, PartsOfOneNameGetNamesOfTheirOwn) {
    const LayerFile file =
        read(job_of({{1,
                      {block(ovf::block::hatches, 1, 1), block(ovf::block::hatches, 1, 2),
                       block(ovf::block::hatches, 2, 2), block(ovf::block::hatches, 1, 3)}}},
                    {"AA1", "AA1", "AA1"}));
    ASSERT_EQ(file.parts.size(), 4U);
    EXPECT_EQ(file.parts[0].label, "AA1 core hatch");
    EXPECT_EQ(file.parts[1].exposure->part, "AA1 2");
    EXPECT_EQ(file.parts[2].label, "AA1 2 core hatch");
    EXPECT_EQ(file.parts[3].label, "AA1 3 core hatch");
    EXPECT_EQ(file.warnings, (std::vector<std::string>{
                                 "2 parts have the name of another one; a number was put behind it, the "
                                 "first is now 'AA1 2'"}));
}

} // namespace
} // namespace lamella::ovf_cases
