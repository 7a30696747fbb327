#include "lamella/inputs/read_file.hpp"

#include "container/zip_bytes.hpp"
#include "fixtures/expect_error.hpp"
#include "slices/formats/ilt_format.hpp"

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lamella::ilt_cases {
namespace {

/// An archive of a file with a hatch, and of a list with these lines for it.
std::string archive(const std::string& lines) {
    const std::string vectors = "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$HEADEREND\n$$GEOMETRYSTART\n$$LAYER/0\n"
                                "$$LAYER/1\n$$HATCHES/1,1,0,0,5,5\n$$GEOMETRYEND\n";
    return zip_test::zip_bytes(
        {{.name = std::string(ilt_parameters), .content = "[modelsection_001_s1_vs.cli]\n" + lines},
         {.name = "modelsection_001_s1_vs.cli", .content = vectors}});
}

LayerFile read(const std::string& bytes) {
    return read_layers(std::as_bytes(std::span(bytes)), "test.ilt");
}

TEST(ReadIlt, NumbersMayHaveUnitsBehindThem) {
    const LayerFile file = read(archive("LaserSpeed = 800.5 mm/s\nLaserPower=200 watt\nFocusShift = -1.5\n"
                                        "PointDistance = 0.0 \xb5m\nExposureTime = 0.0 \xb5s\n"));
    EXPECT_TRUE(file.warnings.empty()) << file.warnings.front();
    const ParameterSet& set = file.parts.at(0).exposure->parameters;
    EXPECT_EQ(set.speed_mm_s, 800.5);
    EXPECT_EQ(set.power_w, 200);
    EXPECT_EQ(set.focus_mm, -1.5);
}

TEST(ReadIlt, HeightsOfAllFilesAreBottomsWhereTheLowestOnesAre) {
    const auto layers = [](const std::vector<std::string>& heights) {
        std::string text = "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$HEADEREND\n$$GEOMETRYSTART\n";
        for (const std::string& height : heights)
            text += "$$LAYER/" + height + "\n$$HATCHES/1,1,0,0," + height + ",5\n";
        return text + "$$GEOMETRYEND\n";
    };
    const auto archive_of = [&](const std::vector<std::string>& high, const std::vector<std::string>& low) {
        return zip_test::zip_bytes({{.name = std::string(ilt_parameters),
                                     .content = "[a.cli]\nLaserSpeed = 1\nLaserPower = 1\n"
                                                "[b.cli]\nLaserSpeed = 1\nLaserPower = 1\n"},
                                    {.name = "a.cli", .content = layers(high)},
                                    {.name = "b.cli", .content = layers(low)}});
    };
    // The files have different planes in common with the archive.
    const auto expect_the_same_if_not_in_memory = [&](const std::string& bytes) {
        const LayerFile held = read(bytes);
        const std::vector<LayerPart> held_parts = held.in_memory();
        const LayerFile file =
            read_layers(std::as_bytes(std::span(bytes)), "test.ilt", {.kept = KeptPlanes::none});
        ASSERT_GT(file.plane_bytes, 0U);
        EXPECT_EQ(file.warnings, held.warnings);
        ASSERT_EQ(file.planes.size(), held.planes.size());
        for (std::size_t plane = 0; plane < file.planes.size(); ++plane) {
            EXPECT_EQ(content_hash(file.plane(plane)), content_hash(held.plane(plane)));
            EXPECT_EQ(file.contents[plane].hatch_lines, held.contents[plane].hatch_lines);
            EXPECT_EQ(file.plane(plane).polylines.back().bottom, held_parts.back().layers[plane].bottom);
        }
    };
    // Vectors end at x = z of the file.
    const auto expect_bottoms = [](const LayerFile& file) {
        const std::vector<LayerPart> parts = file.in_memory();
        for (const LayerPart& part : parts) {
            ASSERT_EQ(part.layers.size(), 4U);
            for (std::size_t plane = 0; plane < part.layers.size(); ++plane)
                for (std::size_t i = 1; i < part.hatches_of(plane).size(); i += 2)
                    EXPECT_EQ(part.layers[plane].bottom, part.hatches_of(plane)[i].x);
        }
        EXPECT_EQ(parts.at(0).layers[3].top, 4);
    };
    const std::vector<std::string> all = {"0", "1", "2", "3"};
    expect_bottoms(read(archive_of({"2", "3"}, all)));
    expect_bottoms(read(archive_of({"1", "3"}, all)));
    expect_bottoms(read(archive_of({"0", "2"}, {"1", "3"})));
    expect_the_same_if_not_in_memory(archive_of({"2", "3"}, all));
    expect_the_same_if_not_in_memory(archive_of({"0", "2"}, {"1", "3"}));
    EXPECT_EQ(read(archive_of({"2", "3"}, {"1", "2"})).in_memory().at(0).layers.at(0).bottom, 0);
}

/// The exposure of a file of this name, which holds a hatch line or else a square.
std::pair<Exposure, std::vector<std::string>> read_named(const std::string& name, bool hatch) {
    const std::string vectors =
        "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$HEADEREND\n$$GEOMETRYSTART\n$$LAYER/0\n$$LAYER/1\n" +
        std::string(hatch ? "$$HATCHES/1,1,0,0,5,5\n" : "$$POLYLINE/1,1,5,0,0,5,0,5,5,0,5,0,0\n") +
        "$$GEOMETRYEND\n";
    const LayerFile file =
        read(zip_test::zip_bytes({{.name = std::string(ilt_parameters),
                                   .content = "[" + name + "]\nLaserSpeed = 800\nLaserPower = 200\n"},
                                  {.name = name, .content = vectors}}));
    EXPECT_EQ(file.parts.at(0).label, file.parts[0].exposure->label());
    return {*file.parts[0].exposure, file.warnings};
}

TEST(ReadIlt, NamesOfFilesSayRegionAndKind) {
    struct Named {
        const char* name;
        bool hatch;
        const char* part;
        ScanRegion region;
        std::uint32_t contour; // 0 for hatches
    };
    for (const Named& named : {
             Named{"modelsection_001_s1_vs.cli", true, "modelsection_001", ScanRegion::core, 0},
             Named{"modelsection_001_s1_vk.cli", false, "modelsection_001", ScanRegion::core, 1},
             Named{"modelsection_001_s1_kv.cli", false, "modelsection_001", ScanRegion::core, 2},
             Named{"modelsection_001_s2_us.cli", true, "modelsection_001", ScanRegion::downskin, 0},
             Named{"modelsection_001_st_vk.cli", false, "modelsection_001", ScanRegion::support, 1},
             Named{"modelsection_001_s1_skin.cli", true, "modelsection_001", ScanRegion::upskin, 0},
             Named{"modelsection_001_s1_skin.cli", false, "modelsection_001", ScanRegion::upskin, 1},
             Named{"cyl_001_Standard_x0.04_md.cli", true, "cyl_001_Standard_x0.04", ScanRegion::core, 0},
             Named{"cyl_001_Standard_x0.04_c1md.cli", false, "cyl_001_Standard_x0.04", ScanRegion::core, 1},
             Named{"cyl_001_Standard_x0.04_c2dn.cli", false, "cyl_001_Standard_x0.04", ScanRegion::downskin,
                   2},
             Named{"cyl_001_Standard_x0.04_dn.cli", true, "cyl_001_Standard_x0.04", ScanRegion::downskin, 0},
             Named{"cyl_001_Standard_x0.04_UP.cli", true, "cyl_001_Standard_x0.04", ScanRegion::upskin, 0},
             Named{"bracket_support_contours.cli", false, "bracket", ScanRegion::support, 1},
             Named{"bracket-Hatching.cli", true, "bracket", ScanRegion::core, 0},
             Named{"bracket downskin hatch.cli", true, "bracket", ScanRegion::downskin, 0},
         }) {
        const auto [exposure, warnings] = read_named(named.name, named.hatch);
        EXPECT_EQ(exposure.part, named.part);
        EXPECT_EQ(exposure.region, named.region) << named.name;
        EXPECT_EQ(exposure.kind, named.contour > 0 ? VectorKind::contour : VectorKind::hatch) << named.name;
        EXPECT_EQ(exposure.contour, named.contour) << named.name;
        EXPECT_TRUE(warnings.empty()) << named.name << ": " << warnings.front();
    }
}

TEST(ReadIlt, WarnsOfNamesThatSayNothingAndGoesByWhatTheFilesHold) {
    for (const bool hatch : {true, false}) {
        const auto [exposure, warnings] = read_named("layer7.cli", hatch);
        EXPECT_EQ(exposure.part, "layer7");
        EXPECT_EQ(exposure.region, ScanRegion::core);
        EXPECT_EQ(exposure.kind, hatch ? VectorKind::hatch : VectorKind::contour);
        ASSERT_EQ(warnings.size(), 1U);
        EXPECT_TRUE(warnings[0].starts_with("1 file has a name that says nothing")) << warnings[0];
    }
}

TEST(ReadIlt, UnitsCount) {
    const LayerFile file =
        read(archive("LaserSpeed = 0.8 m/s\nLaserPower = 0.2 kW\nFocusShift = -1500 \xc2\xb5m\n"));
    const ParameterSet& set = file.parts.at(0).exposure->parameters;
    EXPECT_DOUBLE_EQ(set.speed_mm_s, 800);
    EXPECT_DOUBLE_EQ(set.power_w, 200);
    EXPECT_DOUBLE_EQ(set.focus_mm, -1.5);
    const std::string good = "LaserSpeed = 1 mm/s\nLaserPower = 1 W\n";
    for (const std::string line :
         {"LaserSpeed = 800 furlongs", "LaserSpeed = -800 mm/s", "LaserPower = 200 mm/s", "LaserPower = -1",
          "FocusShift = 1 W", "LaserSpeed = +-1 mm/s"}) {
        const std::string error =
            test::error_of(ErrorKind::input, [&] { static_cast<void>(read(archive(good + line + "\n"))); });
        EXPECT_NE(error.find(", line 4: found '"), std::string::npos) << error;
    }
}

TEST(ReadIlt, SaysWhichFilesLackPowerOrSpeed) {
    for (const char* lines : {"LaserSpeed = 800 mm/s\nLaserPwr = 200 watt\n", "LaserPower = 200 watt\n"})
        EXPECT_EQ(
            read(archive(lines)).warnings,
            (std::vector<std::string>{"1 file has but one of LaserSpeed and LaserPower; the other one is "
                                      "taken to be 0 (first at line 1)"}));
}

TEST(ReadIlt, TheListMayBeginWithAByteOrderMark) {
    std::string bytes = zip_test::zip_bytes(
        {{.name = std::string(ilt_parameters),
          .content = "\xEF\xBB\xBF[a.cli]\nLaserSpeed = 1\nLaserPower = 1\n"},
         {.name = "a.cli",
          .content = "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$HEADEREND\n$$GEOMETRYSTART\n$$LAYER/1\n"
                     "$$HATCHES/1,1,0,0,5,5\n$$GEOMETRYEND\n"}});
    EXPECT_EQ(read(bytes).parts.at(0).exposure->parameters.speed_mm_s, 1);
}

TEST(ReadIlt, RefusesWhatIsANumberOnlyAtItsBeginning) {
    for (const std::string value : {"800,5", "800,5 mm/s", "800mm/s", "0x10", "1.5.2"}) {
        const std::string error = test::error_of(
            ErrorKind::input, [&] { static_cast<void>(read(archive("LaserSpeed = " + value + "\n"))); });
        EXPECT_NE(error.find("line 2: found '" + value + "'; LaserSpeed must be a number"), std::string::npos)
            << error;
    }
}

TEST(ReadIlt, SaysWhichFilesAreForAPulsedBeam) {
    for (const char* line : {"PointDistance = 50 \xb5m\n", "ExposureTime = 80 \xb5s\n"}) {
        const std::vector<std::string> warnings =
            read(archive(std::string("LaserSpeed = 800 mm/s\nLaserPower = 200 watt\n") + line)).warnings;
        ASSERT_EQ(warnings.size(), 1U);
        EXPECT_TRUE(
            warnings[0].starts_with("1 file is for a pulsed beam; the distance and time of its points"))
            << warnings[0];
    }
}

TEST(ReadIlt, SaysWhichFilesTheListDoesNotName) {
    const std::string bytes = zip_test::zip_bytes(
        {{.name = std::string(ilt_parameters), .content = "[a_vs.cli]\nLaserSpeed = 1\nLaserPower = 1\n"},
         {.name = "a_vs.cli",
          .content = "$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$HEADEREND\n$$GEOMETRYSTART\n$$LAYER/1\n"
                     "$$HATCHES/1,1,0,0,5,5\n$$GEOMETRYEND\n"},
         {.name = "b.CLI", .content = "not looked at"},
         {.name = "notes.txt", .content = "no vectors"}});
    EXPECT_EQ(
        read(bytes).warnings,
        (std::vector<std::string>{"1 Common Layer Interface file is not in the list of parameters; it was "
                                  "left out (first at b.CLI)"}));
}

} // namespace
} // namespace lamella::ilt_cases
