#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/meshes/mesh_writer.hpp"

#include "fixtures/expect_error.hpp"
#include "parts/shapes.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace lamella::plate_cases {
namespace {

class PlateOfFiles : public testing::Test {
  protected:
    PlateOfFiles() {
        write_stl(folder_.file("torus.stl"), make_torus(6, 2, 24, 16));
        write_obj(folder_.file("box.obj"), weld(make_box(2, 3, 4)), "box");
    }
    [[nodiscard]] std::array<PlateInput, 2> inputs() const {
        return {{{.path = folder_.file("torus.stl"), .placement = translation(8, 8, 2), .copies = 2},
                 {.path = folder_.file("box.obj"), .placement = translation(0, 30, 0), .label = "box"}}};
    }

    TemporaryFolder folder_;
};

TEST_F(PlateOfFiles, IsTheSameWhetherAFileIsReadBeforeOrNot) {
    const PlateInput input = inputs()[0];
    const Plate read = load_plate(std::array{input});
    const Plate given = load_plate(input, read_mesh(input.path));
    EXPECT_EQ(read.box, given.box);
    EXPECT_EQ(read.parts.size(), given.parts.size());
    EXPECT_EQ(volume(joined(read)), volume(joined(given)));
}

TEST_F(PlateOfFiles, JoinedHasTheBoxAndTheVolumeOfAllParts) {
    const Plate plate = load_plate(inputs());
    ASSERT_EQ(plate.parts.size(), 3U);
    const Mesh all = joined(plate);
    double sum = 0;
    for (const PlatePart& part : plate.parts)
        sum += volume(plate.shapes[part.shape].mesh);
    EXPECT_NEAR(volume(all), sum, 1e-9 * sum);
    EXPECT_EQ(bounding_box(all), plate.box);
}

TEST_F(PlateOfFiles, FitsABuildVolumeToTheLastBitAndElseNamesThePartThatReachesOut) {
    const Plate plate = load_plate(inputs());
    const Point3 size = plate.box.max;
    check_build_volume(plate, size);
    for (const auto coordinate : {&Point3::x, &Point3::y, &Point3::z}) {
        Point3 smaller = size;
        smaller.*coordinate = std::nextafter(smaller.*coordinate, 0.0);
        EXPECT_THROW(check_build_volume(plate, smaller), Error);
        Plate moved = plate; // below zero
        moved.parts[2].box.min.*coordinate = -1;
        test::expect_error(ErrorKind::usage, {"box", "reaches from", "-1", "`placement`"},
                           [&] { check_build_volume(moved, size); });
    }
}

TEST_F(PlateOfFiles, RefusesInputsThatNoPlateCanHave) {
    test::error_of(ErrorKind::usage, [] { static_cast<void>(load_plate({})); });
    const double nan = std::nan("");
    for (PlateInput input : {PlateInput{.unit_mm = 0.0}, PlateInput{.unit_mm = -1.0},
                             PlateInput{.unit_mm = nan}, PlateInput{.copies = 0},
                             PlateInput{.spacing_mm = -0.1}, PlateInput{.copies = 2, .spacing_mm = nan}}) {
        input.path = folder_.file("box.obj");
        test::expect_error(ErrorKind::usage, {"box.obj: "},
                           [&] { static_cast<void>(load_plate(std::array{input})); });
        test::expect_error(ErrorKind::usage, {"box.obj: "},
                           [&] { static_cast<void>(load_plate(input, read_mesh(input.path))); });
    }
}

} // namespace
} // namespace lamella::plate_cases
