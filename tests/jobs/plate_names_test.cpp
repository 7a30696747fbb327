#include "jobs/plate_builder.hpp"
#include "jobs/plate_names.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace lamella::plate_names_cases {
namespace {

MeshFile file_of(std::size_t objects) {
    MeshFile file;
    for (std::size_t i = 0; i < objects; ++i) {
        file.objects.push_back({"", make_box(1, 1, 1 + static_cast<double>(i))});
        file.instances.push_back({.object = i, .name = "body " + std::to_string(i)});
    }
    return file;
}

TEST(PlateNames, NameFilesAndOnlyWhereNeededTheirParts) {
    std::vector<PlateInput> inputs{{.path = "one.stl"}, {.path = "two.3mf"}};
    std::vector<MeshFile> files;
    files.push_back(file_of(1));
    files.push_back(file_of(2));
    EXPECT_EQ(name_of(inputs), "one.stl and 1 more file");
    const Plate plate = load_plate(inputs, std::move(files), {});
    EXPECT_EQ(name_of(plate), "one.stl and 1 more file");
    ASSERT_EQ(plate.parts.size(), 3U);
    EXPECT_EQ(name_of_part(plate, 0), "one.stl");
    EXPECT_EQ(name_of_part(plate, 1), "two.3mf, part \"" + plate.parts[1].label + "\"");
    EXPECT_EQ(name_of_part(plate, 2), "two.3mf, part \"" + plate.parts[2].label + "\"");
    EXPECT_EQ(names_of_parts(plate),
              (std::vector{name_of_part(plate, 0), name_of_part(plate, 1), name_of_part(plate, 2)}));
    for (std::size_t part = 0; part < plate.parts.size(); ++part)
        EXPECT_EQ(name_of_shape(plate, plate.parts[part].shape), name_of_part(plate, part));
}

TEST(PlateNames, OfCopiesOfOneShapeAreThatOfTheFile) {
    std::vector<PlateInput> inputs{{.path = "one.stl", .copies = 2}};
    std::vector<MeshFile> files;
    files.push_back(file_of(1));
    const Plate plate = load_plate(inputs, std::move(files), {});
    EXPECT_EQ(name_of(plate), "one.stl");
    EXPECT_EQ(name_of_shape(plate, 0), "one.stl");
    EXPECT_EQ(name_of_part(plate, 1), "one.stl, part \"" + plate.parts[1].label + "\"");
}

} // namespace
} // namespace lamella::plate_names_cases
