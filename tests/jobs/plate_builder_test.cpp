#include "lamella/core/error.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "fixtures/skip_if_slowed.hpp"
#include "jobs/plate_builder.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace lamella::plate_builder_cases {
namespace {

/// A file of boxes of 2 x 3 x 4 mm: these instances of the only object.
MeshFile boxes(std::vector<MeshInstance> instances = {{}}) {
    MeshFile file;
    file.objects.push_back({"box", make_box(2, 3, 4)});
    file.instances = std::move(instances);
    file.stored_triangles = 12;
    return file;
}

Plate plate_of(const std::vector<PlateInput>& inputs, std::vector<MeshFile> files) {
    return load_plate(inputs, std::move(files), {});
}

Plate plate_of(const PlateInput& input, MeshFile file = boxes()) {
    return plate_of(std::vector{input}, {std::move(file)});
}

std::vector<std::string> labels_of(const Plate& plate) {
    std::vector<std::string> labels;
    for (const PlatePart& part : plate.parts)
        labels.push_back(part.label);
    return labels;
}

bool apart(const Box3& a, const Box3& b, double distance) {
    return a.max.x + distance <= b.min.x || b.max.x + distance <= a.min.x || a.max.y + distance <= b.min.y ||
           b.max.y + distance <= a.min.y;
}

TEST(PlateBuilder, HasCopiesOfAFileStandApartInASquareOfOneShape) {
    for (const std::uint64_t copies : {1U, 2U, 4U, 5U, 9U, 17U}) {
        SCOPED_TRACE(testing::Message() << copies << " copies");
        const Plate plate = plate_of({.path = "box.stl", .copies = copies, .spacing_mm = 1.5});
        ASSERT_EQ(plate.parts.size(), copies);
        EXPECT_EQ(plate.shapes.size(), 1U);
        std::set<double> columns;
        std::set<double> rows;
        for (std::size_t i = 0; i < copies; ++i) {
            columns.insert(plate.parts[i].box.min.x);
            rows.insert(plate.parts[i].box.min.y);
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_TRUE(apart(plate.parts[i].box, plate.parts[j].box, 1.5)) << i << " and " << j;
        }
        EXPECT_LT((columns.size() - 1) * (columns.size() - 1), copies);
        EXPECT_LE(rows.size(), columns.size());
        EXPECT_EQ(plate.parts.front().box, bounding_box(make_box(2, 3, 4)));
    }
}

TEST(PlateBuilder, PutsEachPartWhereItsBoxIsAndAllIntoTheBoxOfThePlate) {
    test::Random random(5);
    for (int round = 0; round < 50; ++round) {
        std::vector<PlateInput> inputs;
        std::vector<MeshFile> files;
        for (std::int64_t n = random.integer(1, 3); n > 0; --n) {
            std::vector<MeshInstance> instances;
            for (std::int64_t m = random.integer(1, 4); m > 0; --m)
                instances.push_back(
                    {.placement = compose(translation(random.real(-9, 9), random.real(-9, 9),
                                                      static_cast<double>(random.integer(0, 1))),
                                          rotation('z', 90.0 * static_cast<double>(random.integer(0, 1))))});
            files.push_back(boxes(instances));
            inputs.push_back({.path = "a.stl",
                              .placement = rotation('x', random.real(0, 90)),
                              .copies = static_cast<std::uint64_t>(random.integer(1, 3))});
        }
        const Plate plate = plate_of(inputs, files);
        Box3 all;
        std::set<std::string> labels;
        for (const PlatePart& part : plate.parts) {
            const Mesh placed = plate.shapes[part.shape].mesh.transformed(translation(part.dx, part.dy, 0));
            const Box3 box = bounding_box(placed);
            for (const auto coordinate : {&Point3::x, &Point3::y, &Point3::z}) {
                EXPECT_NEAR(box.min.*coordinate, part.box.min.*coordinate, 1e-12);
                EXPECT_NEAR(box.max.*coordinate, part.box.max.*coordinate, 1e-12);
            }
            all.add(part.box);
            EXPECT_TRUE(labels.insert(part.label).second) << part.label;
        }
        EXPECT_EQ(plate.box, all);
    }
}

TEST(PlateBuilder, SharesAShapeOnlyAmongPartsThatDifferInXAndY) {
    const Plate plate = plate_of({.path = "a.3mf"},
                                 boxes({{.placement = translation(0, 0, 0)},
                                        {.placement = translation(10, 20, 0)},
                                        {.placement = translation(30, 0, 1)},
                                        {.placement = compose(translation(50, 0, 0), rotation('z', 90))}}));
    ASSERT_EQ(plate.parts.size(), 4U);
    EXPECT_EQ(plate.shapes.size(), 3U);
    EXPECT_EQ(plate.parts[0].shape, plate.parts[1].shape);
    EXPECT_EQ(plate.parts[1].dx, 10);
    EXPECT_EQ(plate.parts[1].dy, 20);
    // What stands alone is placed as a whole, as it would be on a plate of its own.
    EXPECT_EQ(plate.parts[3].dx, 0);
    EXPECT_EQ(plate.shapes[plate.parts[3].shape].mesh.soup()->placement().offset[0], 50);
}

TEST(PlateBuilder, FindsSupportsByTheMarksOfTheFileAndByOptions) {
    const auto supports_of = [](const PlateInput& input) {
        std::vector<bool> supports;
        const Plate plate = plate_of(
            input, boxes({{.support = false}, {.placement = translation(9, 0, 0), .support = true}}));
        EXPECT_EQ(plate.shapes.size(), 1U); // sliced once all the same
        for (const PlatePart& part : plate.parts)
            supports.push_back(part.support);
        return supports;
    };
    EXPECT_EQ(supports_of({.path = "a.3mf"}), (std::vector<bool>{false, true}));
    EXPECT_EQ(supports_of({.path = "a.3mf", .copies = 2}), (std::vector<bool>{false, true, false, true}));
    EXPECT_EQ(supports_of({.path = "a.3mf", .support = true}), (std::vector<bool>{true, true}));
}

TEST(PlateBuilder, NegativeVolumesAreSubtractedFromTheirOwnObjectAndAreNoParts) {
    const MeshFile file = boxes({{.body = 0},
                                 {.placement = translation(0, 0, 100), .negative = true, .body = 0},
                                 {.placement = translation(50, 0, 0), .body = 1}});
    const Plate one = plate_of({.path = "a.3mf"}, file);
    ASSERT_EQ(one.parts.size(), 2U);
    ASSERT_EQ(one.negatives.size(), 1U);
    EXPECT_EQ(one.negatives[0].parts, std::vector<std::size_t>{0});
    EXPECT_LT(one.box.max.z, 100);
    EXPECT_GE(one.negatives[0].box.max.z, 100);
    const Plate copies = plate_of({.path = "a.3mf", .copies = 3}, file);
    ASSERT_EQ(copies.parts.size(), 6U);
    ASSERT_EQ(copies.negatives.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(copies.negatives[i].parts, std::vector<std::size_t>{2 * i});
        EXPECT_EQ(copies.negatives[i].shape, copies.negatives[0].shape);
        EXPECT_EQ(copies.negatives[i].dx, copies.parts[2 * i].dx);
        EXPECT_EQ(copies.negatives[i].dy, copies.parts[2 * i].dy);
    }
}

TEST(PlateBuilder, NegativeFilesAreSubtractedFromAllPartsOfOtherFiles) {
    std::vector<PlateInput> inputs{{.path = "a.stl"},
                                   {.path = "hole.stl", .copies = 2, .spacing_mm = 1, .negative = true},
                                   {.path = "b.stl"}};
    std::vector<MeshFile> files(3);
    for (MeshFile& file : files) {
        file.objects.push_back({"", make_box(2, 2, 2)});
        file.instances.emplace_back();
    }
    const Plate plate = load_plate(inputs, files, {});
    ASSERT_EQ(plate.parts.size(), 2U);
    EXPECT_EQ(plate.parts[1].label, "b");
    ASSERT_EQ(plate.negatives.size(), 2U);
    for (const PlateNegative& negative : plate.negatives)
        EXPECT_EQ(negative.parts, (std::vector<std::size_t>{0, 1}));
    EXPECT_EQ(plate.negatives[1].box.min.x - plate.negatives[0].box.min.x, 3) << "copies have their distance";
    EXPECT_EQ(plate.negatives[0].shape, plate.negatives[1].shape);
    files[1].instances.front().negative = true;
    test::error_of(ErrorKind::usage, [&] { (void)load_plate(inputs, files, {}); });
    files[1].instances.front().negative = false;
    inputs[1].support = true;
    test::error_of(ErrorKind::usage, [&] { (void)load_plate(inputs, files, {}); });
    test::error_of(ErrorKind::usage, [&] {
        (void)load_plate(std::vector<PlateInput>{{.path = "hole.stl", .negative = true}}, {files[0]}, {});
    });
}

TEST(PlateBuilder, KeepsEqualMeshesOfTwoFilesApart) {
    const Plate plate =
        plate_of(std::vector<PlateInput>{{.path = "a.stl"}, {.path = "b.stl"}}, {boxes(), boxes()});
    ASSERT_EQ(plate.shapes.size(), 2U);
    EXPECT_EQ(plate.shapes[plate.parts[1].shape].input, 1U);
    EXPECT_EQ(plate.files[1].path, "b.stl");
}

TEST(PlateBuilder, CallsPartsByTheirFileUnlessSomebodyNamedThem) {
    EXPECT_EQ(labels_of(plate_of({.path = "folder/box.stl"})), std::vector<std::string>{"part"});
    EXPECT_EQ(labels_of(plate_of({.path = "folder/box.stl.gz", .copies = 2})),
              (std::vector<std::string>{"box", "box 2"}));
    EXPECT_EQ(labels_of(plate_of({.path = "-", .copies = 2})), (std::vector<std::string>{"part", "part 2"}));
    EXPECT_EQ(labels_of(plate_of({.path = "a.3mf"}, boxes({{.name = "left"}, {}}))),
              (std::vector<std::string>{"left", "box"}));
    EXPECT_EQ(labels_of(plate_of({.path = "a.3mf", .label = "mine"}, boxes({{.name = "left"}}))),
              std::vector<std::string>{"mine"});
    // A number that is taken is passed over.
    EXPECT_EQ(labels_of(plate_of(
                  std::vector<PlateInput>{{.path = "a.stl", .label = "a 2"}, {.path = "a.stl", .copies = 3}},
                  {boxes(), boxes()})),
              (std::vector<std::string>{"a 2", "a", "a 3", "a 4"}));
}

TEST(PlateBuilder, PlacesAfterTheUnitIsMillimetres) {
    const PlateInput inches{.path = "a.stl", .unit_mm = 25.4, .placement = translation(1, 0, 0)};
    const Plate plate = plate_of(inches);
    EXPECT_EQ(plate.box.min.x, 1);
    EXPECT_EQ(plate.box.max.x, 1 + 2 * 25.4);
    EXPECT_EQ(plate.files.front().unit_mm, 25.4);
    EXPECT_EQ(plate.files.front().matrix(Point3{1, 0, 0}), (Point3{1 + 25.4, 0, 0}));

    MeshFile with_unit = boxes();
    with_unit.unit_mm = 1000;
    EXPECT_EQ(plate_of({.path = "a.3mf"}, with_unit).files.front().unit_mm, 1000);
    test::expect_error(ErrorKind::usage, {"a.3mf", "its unit is 1000 mm"},
                       [&] { static_cast<void>(plate_of({.path = "a.3mf", .unit_mm = 25.4}, with_unit)); });
}

TEST(PlateBuilder, RefusesPlacesThatNumbersCannotDistinguish) {
    const auto placed = [](const Transform& placement) {
        static_cast<void>(plate_of({.path = "a.stl", .placement = placement}));
    };
    placed(translation(1e9, 0, 0));
    test::expect_error(ErrorKind::usage, {"a.stl", "lies 1e+12 mm away", "closer to the origin"},
                       [&] { placed(translation(0, -1e12, 0)); });
    test::expect_error(ErrorKind::usage, {"a.stl", "beyond 1e+100 mm"},
                       [&] { placed(scaling(1e308, 1, 1)); });
    test::expect_error(ErrorKind::usage, {"a.stl", "beyond 1e+100 mm"},
                       [&] { placed(scaling(1e101, 1e101, 1e101)); });
}

TEST(PlateBuilder, HoldsAMillionPartsAndNoMore) {
    LAMELLA_SKIP_IF_SLOWED();
    constexpr std::uint64_t most = std::uint64_t{1} << 20;
    test::expect_error(ErrorKind::limit, {"a.stl", "1048577 copies of 1 part are too many"},
                       [&] { static_cast<void>(plate_of({.path = "a.stl", .copies = most + 1})); });
    test::expect_error(ErrorKind::limit, {"b.stl", "1 copy of 2 parts are too many"}, [&] {
        static_cast<void>(
            plate_of(std::vector<PlateInput>{{.path = "a.stl", .copies = most - 1}, {.path = "b.stl"}},
                     {boxes(), boxes({{}, {}})}));
    });
}

TEST(PlateBuilder, AsksForTheBoxOfEachInstanceOnceWhateverTheCopies) {
    PlateBuilder builder;
    int asked = 0;
    builder.add({.path = "a.3mf", .copies = 50}, boxes({{}, {.placement = translation(9, 0, 0)}}),
                [&](const Mesh& mesh, const Transform& placement) {
                    ++asked;
                    return bounding_box(mesh.transformed(placement));
                });
    EXPECT_EQ(builder.finish().parts.size(), 100U);
    EXPECT_EQ(asked, 2);
}

} // namespace
} // namespace lamella::plate_builder_cases
