#include "lamella/contour/exposure.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/core/error.hpp"
#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/slices/layer_file.hpp"
#include "lamella/slices/layer_page.hpp"

#include "container/json_text.hpp"
#include "fixtures/sample_layers.hpp"
#include "page_reader.hpp"
#include "parts/shapes.hpp"
#include "slices/pages/page_bytes.hpp"
#include "slices/pages/pages.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace lamella {
namespace {

struct WrittenPage {
    std::string html;
    ReadPage page;
    std::vector<std::string> warnings;
};

WrittenPage write_page(const std::vector<LayerPart>& parts, const LayerFileInfo& info,
                       const PageOptions& options, const PageNotes& notes = {}) {
    const TemporaryFolder folder;
    const PlaneSource source = source_of(parts);
    const auto writer = open_layer_page(folder.file("page.html"), info, options);
    for (std::size_t i = 0; i < info.layers; ++i)
        writer->prepare(source.plane(i))();
    writer->add_notes(notes);
    writer->finish();
    const std::string html = file_bytes(folder.file("page.html"));
    EXPECT_EQ(writer->bytes(), html.size());
    return {html, read_page(html), writer->warnings()};
}

/// Returns parts without hatch lines.
std::vector<LayerPart> parts_of(std::vector<LayerStack> stacks) {
    std::vector<LayerPart> parts;
    for (LayerStack& layers : stacks)
        parts.push_back({.label = {}, .layers = std::move(layers)});
    return parts;
}

WrittenPage write_page(const LayerStack& layers, const PageOptions& options = options_with()) {
    return write_page(parts_of({layers}), info_of(layers), options);
}

/// Members of a JSON object that are arrays of numbers; the others are passed over.
std::map<std::string, std::vector<double>> numbers_of(const std::string& json) {
    std::map<std::string, std::vector<double>> found;
    JsonText text(json, "json");
    text.object([&](const std::string& key) {
        const std::string next = text.here();
        if (next.starts_with("'[") && !next.starts_with("'[[") && !next.starts_with("'[{"))
            text.array([&] { found[key].push_back(text.number()); });
        else
            text.skip();
    });
    text.end();
    return found;
}

/// The layers of a page in mm.
std::vector<PageLayer> layers_of(const ReadPage& page, std::size_t parts = 1) {
    const std::string& header = page.json.at("head");
    const std::vector<double> origin = numbers_of(header).at("origin");
    std::vector<PageLayer> layers;
    for (const std::string& data : page.data)
        layers.push_back(page_layer(data, parts, member(header, "step_mm"), {origin[0], origin[1]}));
    return layers;
}

double distance(const Point2& p, const Point2& a, const Point2& b) {
    const double length = (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
    const double t =
        length > 0 ? std::clamp(((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / length, 0.0, 1.0)
                   : 0.0;
    return std::hypot(a.x + t * (b.x - a.x) - p.x, a.y + t * (b.y - a.y) - p.y);
}

double distance(const Point2& p, const std::vector<PageContour>& contours) {
    double least = std::numeric_limits<double>::infinity();
    for (const PageContour& contour : contours) {
        const std::size_t n = contour.points.size();
        for (std::size_t i = 0; i + (contour.closed ? 0 : 1) < n; ++i)
            least = std::min(least, distance(p, contour.points[i], contour.points[(i + 1) % n]));
    }
    return least;
}

/// Rings of 2000 points, with a hole and an open chain in each layer.
LayerStack fine_rings(std::size_t count) {
    LayerStack layers;
    for (std::uint64_t i = 0; i < count; ++i) {
        LayerBuilder builder;
        for (const double turn : {1.0, -1.0}) {
            constexpr int points = 2000;
            const double radius = turn > 0 ? 40 : 25;
            for (int p = 0; p < points; ++p) {
                const double angle = turn * 2 * std::numbers::pi * p / points;
                const double wave = 1 + 0.05 * std::sin(9 * angle + static_cast<double>(i));
                builder.add_point({radius * wave * std::cos(angle), radius * wave * std::sin(angle)});
            }
            builder.end_contour(true);
        }
        add_contour(builder, {{-3, 0}, {1, 2}, {4, -1}}, false);
        const double bottom = 0.1 * static_cast<double>(i);
        layers.push_back(builder.finish(i, bottom + 0.05, bottom, bottom + 0.1));
    }
    return layers;
}

TEST(LayerPage, HoldsEveryContourWithinHalfAStep) {
    std::vector<LayerPart> parts =
        parts_of({random_layers(3, 20, 60, {500, -200}, true), random_layers(3, 20, 60, {-40, 10}, true)});
    LayerFileInfo info = info_of(parts[0].layers);
    info.box.add(info_of(parts[1].layers).box);
    info.parts = {{.label = "one"}, {.label = "two"}};
    parts[1].hatches.assign(20, PointArray({{1, 2}, {3.25, 4}, {-7, 8}, {9, 10}}));
    const WrittenPage written = write_page(parts, info, options_with());
    EXPECT_TRUE(written.warnings.empty());
    const double step = member(written.page.json.at("head"), "step_mm");
    EXPECT_EQ(step, page_step_mm(info.box));
    const std::vector<PageLayer> read = layers_of(written.page, 2);
    ASSERT_EQ(read.size(), 20U);
    const auto expect_near = [&](const Point2& a, const Point2& b) {
        EXPECT_NEAR(a.x, b.x, 0.5001 * step);
        EXPECT_NEAR(a.y, b.y, 0.5001 * step);
    };
    for (std::size_t i = 0; i < read.size(); ++i)
        for (std::size_t p = 0; p < 2; ++p) {
            const Layer& layer = parts[p].layers[i];
            const PagePart& part = read[i].parts[p];
            ASSERT_EQ(part.contours.size(), layer.contours());
            for (std::size_t c = 0; c < layer.contours(); ++c) {
                const auto contour = layer.contour(c);
                ASSERT_EQ(part.contours[c].closed, layer.closed(c));
                ASSERT_EQ(part.contours[c].points.size(), contour.size());
                for (std::size_t k = 0; k < contour.size(); ++k)
                    expect_near(part.contours[c].points[k], contour[k]);
            }
            const std::span<const Point2> hatches = parts[p].hatches_of(i);
            ASSERT_EQ(part.hatches.size(), hatches.size());
            for (std::size_t k = 0; k < hatches.size(); ++k)
                expect_near(part.hatches[k], hatches[k]);
        }
}

TEST(LayerPage, HasAStepThatIsRoundAndSmall) {
    const auto step = [](double width, double depth) {
        return page_step_mm({{-1, 3, 0}, {width - 1, depth + 3, 1}});
    };
    EXPECT_DOUBLE_EQ(step(50, 20), 0.001);
    EXPECT_DOUBLE_EQ(step(51, 20), 0.002);
    EXPECT_DOUBLE_EQ(step(10, 250), 0.005);
    EXPECT_DOUBLE_EQ(step(0, 0), 0.001);
    for (double width = 1e-6; width < 1e9; width *= 1.37) {
        EXPECT_GE(step(width, 0), width / 50000 * (1 - 1e-12));
        EXPECT_LE(step(width, 0), 2.5001 * width / 50000);
    }
}

TEST(LayerPage, ReportsTheFiguresOfTheFullContours) {
    const LayerStack layers = fine_rings(6);
    for (const PageOptions& options : {options_with(), options_with(6000), options_with(1U << 24U, 100)}) {
        auto table = numbers_of(write_page(layers, options).page.json.at("table"));
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const LayerMeasure expected = measure(layers[i]);
            EXPECT_EQ(table["index"][i], static_cast<double>(i));
            EXPECT_EQ(table["z"][i], layers[i].z);
            EXPECT_EQ(table["bottom"][i], layers[i].bottom);
            EXPECT_EQ(table["top"][i], layers[i].top);
            EXPECT_EQ(table["area_mm2"][i], expected.area_mm2);
            EXPECT_EQ(table["perimeter_mm"][i], expected.perimeter_mm);
            EXPECT_EQ(table["contours"][i], 3);
            EXPECT_EQ(table["holes"][i], 1);
            EXPECT_EQ(table["open_chains"][i], 1);
            EXPECT_EQ(table["longest_gap_mm"][i], open_gaps(layers[i]).longest_mm);
            EXPECT_EQ(table["gaps_mm"][i], open_gaps(layers[i]).total_mm);
            EXPECT_GT(table["gaps_mm"][i], 0);
            EXPECT_EQ(table.count("rings_dropped"), 0U); // no steps, not a word of them
            EXPECT_EQ(table["points"][i], 4003);
        }
    }
}

TEST(LayerPage, ThinsOutBeyondItsBudgetAndSaysSo) {
    const LayerStack layers = fine_rings(12);
    const WrittenPage full = write_page(layers);
    EXPECT_TRUE(full.warnings.empty());
    const std::size_t frame = write_page(LayerStack{}).html.size();
    for (const PageOptions& options : {options_with(36000), options_with(1U << 24U, 200)}) {
        const WrittenPage thin = write_page(layers, options);
        ASSERT_EQ(thin.warnings.size(), 1U);
        EXPECT_NE(thin.warnings[0].find("12 of 12 layers"), std::string::npos) << thin.warnings[0];
        EXPECT_LT(thin.html.size(), full.html.size());
        auto table = numbers_of(thin.page.json.at("table"));
        const double step = member(thin.page.json.at("head"), "step_mm");
        const std::vector<PageLayer> read = layers_of(thin.page);
        for (std::size_t i = 0; i < layers.size(); ++i) {
            EXPECT_LE(table["shown"][i], static_cast<double>(options.layer_points));
            const double tolerance = table["tolerance_mm"][i];
            EXPECT_GT(tolerance, 0);
            const auto& contours = read[i].parts[0].contours;
            ASSERT_EQ(contours.size(), 3U);
            std::size_t points = 0;
            for (const PageContour& contour : contours)
                points += contour.points.size();
            EXPECT_EQ(static_cast<double>(points), table["shown"][i]);
            for (const Point2& p : layers[i].points)
                EXPECT_LE(distance(p, contours), tolerance + step);
            const auto chain = std::find_if(contours.begin(), contours.end(),
                                            [](const PageContour& contour) { return !contour.closed; });
            ASSERT_NE(chain, contours.end());
        }
        EXPECT_LE(thin.html.size(), frame + options.budget_bytes + 300 * layers.size());
    }
}

TEST(LayerPage, LetsALayerUseWhatThoseBelowLeft) {
    LayerStack layers = square_with_hole();
    const LayerStack fine = fine_rings(3);
    layers.push_back(fine[2]);
    layers[2].bottom = 1;
    layers[2].z = 1.05;
    layers[2].top = 1.1;
    // The data of the fine layer, all of it.
    std::size_t size = 0;
    const std::string html = write_page(layers).html;
    for (std::size_t at = html.find("class=\"data\""); at != std::string::npos;
         at = html.find("class=\"data\"", at + 1))
        size = html.find('<', at) - html.find('>', at) - 1;
    EXPECT_TRUE(write_page(layers, options_with(3 * size / 2)).warnings.empty());
    EXPECT_FALSE(write_page(layers, options_with(3 * size / 5)).warnings.empty());
}

TEST(LayerPage, ReportsWhatStepsMadeOfTheLayers) {
    const LayerStack layers = fine_rings(4);
    const double area = measure(layers[2]).area_mm2;
    LayerChanges once{.changed_layers = 1, .rings_dropped = 2, .area_before_mm2 = 30, .area_after_mm2 = 10};
    PageNotes notes;
    notes.changes = {{layers[2].index, once}, {layers[2].index, once}, {layers[0].index, once}};
    auto table = numbers_of(
        write_page(parts_of({layers}), info_of(layers), options_with(), notes).page.json.at("table"));
    EXPECT_EQ(table["rings_dropped"], (std::vector<double>{2, 0, 4, 0}));
    EXPECT_NEAR(table["area_before_mm2"][2], area + 40, 1e-9);
    EXPECT_EQ(table["area_before_mm2"][1], table["area_mm2"][1]);
}

TEST(LayerPage, FindsFaults) {
    LayerBuilder builder;
    add_contour(builder, {{0, 0}, {10, 10}, {10, 0}, {0, 10}});   // crosses itself at 5, 5
    add_contour(builder, {{20, 0}, {20, 10}, {30, 10}, {30, 0}}); // a hole in nothing
    add_contour(builder, {{40, 0}, {60, 0}, {60, 20}, {40, 20}}); // and one in it
    add_contour(builder, {{45, 5}, {50, 5}, {50, 10}, {45, 10}}); // that is no hole
    const LayerStack layers{builder.finish(0, 0.5, 0, 1)};
    const WrittenPage written = write_page(layers);
    auto table = numbers_of(written.page.json.at("table"));
    EXPECT_EQ(table["crossings"][0], 1);
    EXPECT_GE(table["misoriented"][0], 1);
    EXPECT_EQ(table["overlapping"][0], 1);
    EXPECT_EQ(table["holes"][0], 0); // the ring that runs clockwise is none
    const PageLayer read = layers_of(written.page).front();
    ASSERT_EQ(read.crossings.size(), 1U);
    EXPECT_NEAR(read.crossings[0].x, 5, 0.01);
    EXPECT_NEAR(read.crossings[0].y, 5, 0.01);
}

TEST(LayerPage, FindsPartsThatRunThroughOneAnother) {
    std::vector<LayerStack> parts;
    for (const double x : {0.0, 5.0}) {
        LayerBuilder builder;
        add_contour(builder, {{x, x}, {x + 10, x}, {x + 10, x + 10}, {x, x + 10}});
        parts.push_back({builder.finish(0, 0.5, 0, 1)});
    }
    LayerBuilder within;
    add_contour(within, {{1, 1}, {2, 1}, {2, 2}, {1, 2}});
    parts.push_back({within.finish(0, 0.5, 0, 1)});
    LayerFileInfo info = info_of(parts[0]);
    info.parts.resize(parts.size());
    auto table = numbers_of(write_page(parts_of(parts), info, options_with()).page.json.at("table"));
    EXPECT_EQ(table["crossings"][0], 2);
    EXPECT_GE(table["overlapping"][0], 1);
    EXPECT_EQ(table["area_mm2"][0], 201);
}

/// Two exposures: contours of two rings, one within the other and both counter-clockwise, each beginning
/// elsewhere than in normal form, and a chain; and a hatch.
std::vector<LayerPart> scanned(std::size_t count, int lines = 40) {
    std::vector<LayerPart> parts(2);
    for (std::uint64_t i = 0; i < count; ++i) {
        const double bottom = 0.1 * static_cast<double>(i);
        LayerBuilder builder;
        for (const double radius : {20.0, 19.9}) {
            constexpr int points = 200;
            for (int p = 0; p < points; ++p) {
                const double angle = 1 + 2 * std::numbers::pi * p / points;
                builder.add_point({radius * std::cos(angle), radius * std::sin(angle)});
            }
            builder.end_contour(true);
        }
        add_contour(builder, {{-30, 0}, {-30, 5}}, false);
        parts[0].layers.push_back(builder.finish_as_added(i, bottom + 0.05, bottom, bottom + 0.1));
        std::vector<Point2> hatches;
        for (int line = 0; line < lines; ++line) {
            const double y = 0.2 * line - 4;
            const double x = 10 + std::fmod(std::numbers::phi * line * line + static_cast<double>(i), 3);
            hatches.insert(hatches.end(), {{-x, y}, {x, y}});
        }
        parts[1].layers.push_back({.index = i, .z = bottom + 0.05, .bottom = bottom, .top = bottom + 0.1});
        parts[1].hatches.emplace_back(std::move(hatches));
    }
    return parts;
}

LayerFileInfo scanned_info(const std::vector<LayerPart>& parts) {
    LayerFileInfo info = info_of(parts[0].layers);
    const auto exposure = [](ScanRegion region, VectorKind kind, double power) {
        return Exposure{.part = "</script>a",
                        .region = region,
                        .kind = kind,
                        .parameters = {.name = "set", .power_w = power, .speed_mm_s = 500}};
    };
    info.parts = {{.label = "contours", .exposure = exposure(ScanRegion::core, VectorKind::contour, 120)},
                  {.label = "hatches", .exposure = exposure(ScanRegion::upskin, VectorKind::hatch, 200)}};
    return info;
}

TEST(LayerPage, HoldsScanVectorsAsTheyAreExecuted) {
    const std::vector<LayerPart> parts = scanned(3);
    const LayerFileInfo info = scanned_info(parts);
    const WrittenPage written = write_page(parts, info, options_with());
    EXPECT_TRUE(written.warnings.empty());
    EXPECT_NE(written.page.json.at("head").find(
                  R"("exposure":{"part":"\u003c/script>a","region":"core","kind":"contour","contour":0,)"
                  R"("parameters":{"name":"set","power_w":120,"speed_mm_s":500,"jump_speed_mm_s":5000,)"),
              std::string::npos)
        << written.page.json.at("head");
    auto table = numbers_of(written.page.json.at("table"));
    const std::vector<PageLayer> read = layers_of(written.page, 2);
    for (std::size_t i = 0; i < 3; ++i) {
        ScanFigures expected;
        std::optional<Point2> beam;
        for (std::size_t part = 0; part < 2; ++part) {
            const MeasuredVectors measured = measure_vectors(parts[part].layers[i], parts[part].hatches_of(i),
                                                             info.parts[part].exposure->parameters, beam);
            beam = measured.beam;
            expected += measured.figures;
        }
        EXPECT_EQ(table["vectors"][i], static_cast<double>(expected.vectors));
        EXPECT_EQ(table["marked_mm"][i], expected.marked_mm);
        EXPECT_EQ(table["jumped_mm"][i], expected.jumped_mm);
        EXPECT_EQ(table["build_seconds"][i], expected.build_seconds);
        EXPECT_EQ(table["energy_j"][i], expected.energy_j);
        EXPECT_EQ(table["hatches_shown"][i], 40);
        // Vectors bound no material.
        for (const char* name : {"area_mm2", "open_chains", "misoriented", "overlapping", "crossings"})
            EXPECT_EQ(table[name][i], 0) << name;
        const std::vector<PageContour>& contours = read[i].parts[0].contours;
        ASSERT_EQ(contours.size(), 3U);
        EXPECT_EQ(contours[0].points.size(), 200U);
        EXPECT_NEAR(contours[0].points[0].x, 20 * std::cos(1), 0.001);
        EXPECT_NEAR(contours[1].points[0].y, 19.9 * std::sin(1), 0.001);
        EXPECT_NEAR(read[i].parts[1].hatches[2].y, -3.8, 0.001);
    }
    EXPECT_EQ(numbers_of(write_page(square_with_hole()).page.json.at("table")).count("vectors"), 0U);
}

TEST(LayerPage, KeepsEachLineOfScanVectorsEvenWherePointsFallTogether) {
    std::vector<LayerPart> parts = scanned(1);
    LayerBuilder builder;
    add_contour(builder, {{1, 1}, {1.00001, 1}, {1, 1.00001}}, true);
    parts[0].layers[0] = builder.finish_as_added(0, 0.05, 0, 0.1);
    const WrittenPage written = write_page(parts, scanned_info(parts), options_with());
    EXPECT_EQ(layers_of(written.page, 2)[0].parts[0].contours.at(0).points.size(), 3U);
}

TEST(LayerPage, ShowsAllVectorsOfSomeLayersWhereItsBudgetIsShort) {
    const std::vector<LayerPart> parts = scanned(40, 4000);
    const LayerFileInfo info = scanned_info(parts);
    const std::size_t frame = write_page(LayerStack{}).html.size();
    const std::uint64_t all = write_page(parts, info, options_with()).html.size() - frame;
    const WrittenPage written = write_page(parts, info, options_with(all / 4));
    ASSERT_EQ(written.warnings.size(), 1U);
    EXPECT_NE(written.warnings[0].find("layers are shown without their hatches"), std::string::npos);
    EXPECT_LE(written.html.size(), frame + all / 4 + 500 * parts[0].layers.size());
    auto table = numbers_of(written.page.json.at("table"));
    std::vector<std::size_t> whole;
    for (std::size_t i = 0; i < 40; ++i) {
        EXPECT_EQ(table["tolerance_mm"][i], 0);
        if (table["hatches_shown"][i] > 0) {
            EXPECT_EQ(table["hatches_shown"][i], 4000);
            whole.push_back(i);
        }
    }
    ASSERT_GE(whole.size(), 4U);
    for (std::size_t i = 1; i < whole.size(); ++i) // evenly over the height
        EXPECT_LE(whole[i] - whole[i - 1], 12U);

    // Where not even contours fit, these lose points, but begin where they began.
    const WrittenPage thin = write_page(parts, info, options_with(40 * 400));
    const std::vector<PageLayer> read = layers_of(thin.page, 2);
    EXPECT_EQ(thin.warnings.size(), 2U);
    for (const PageLayer& layer : read) {
        ASSERT_EQ(layer.parts[0].contours.size(), 3U);
        EXPECT_LT(layer.parts[0].contours[0].points.size(), 200U);
        EXPECT_NEAR(layer.parts[0].contours[0].points[0].x, 20 * std::cos(1), 0.001);
        EXPECT_NEAR(layer.parts[0].contours[1].points[0].x, 19.9 * std::cos(1), 0.001);
    }
}

TEST(LayerPage, KeepsHostileTextInItsPlace) {
    const LayerStack layers = square_with_hole();
    const std::size_t scripts = write_page(layers).page.scripts;
    for (const std::string& text :
         {std::string("</script><script>alert(1)</script>"), std::string("<!--<script>"),
          std::string("\"}\\]"), std::string("\xff\xfe\n\0\x1b[31m", 9), std::string("\xe2\x80\xa8]]>-->")}) {
        LayerFileInfo info = info_of(layers);
        info.parts = {{.label = text}};
        PageOptions options = options_with();
        options.title = text;
        PageNotes notes;
        notes.sections = {{text, {{text, text, Tone::bad}}}};
        notes.locations = {{text, text, {{1, 2, 3}}}};
        const WrittenPage written = write_page(parts_of({layers}), info, options, notes);
        EXPECT_EQ(written.page.scripts, scripts);
        EXPECT_EQ(written.page.data.size(), 2U);
        for (const auto& [id, json] : written.page.json) {
            EXPECT_EQ(json.find('<'), std::string::npos) << id;
            JsonText checked(json, id);
            checked.skip();
            checked.end();
        }
        EXPECT_TRUE(written.html.ends_with("<p>after</p>"));
    }
}

TEST(LayerPage, NeedsAViewer) {
    const TemporaryFolder folder;
    const LayerStack layers = square_with_hole();
    for (const auto& [viewer, kind, word] :
         {std::tuple{"", ErrorKind::usage, "need it: it was left out"},
          std::tuple{"<html></html>", ErrorKind::internal, "lamella-data"}}) {
        try {
            static_cast<void>(open_layer_page(folder.file("page.html"), info_of(layers),
                                              {.viewer = viewer, .no_viewer = "it was left out"}));
            FAIL();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), kind);
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
        }
    }
    EXPECT_TRUE(folder.entries().empty());
}

} // namespace
} // namespace lamella
