#include "lamella/findings/findings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <variant>
#include <vector>

namespace lamella {
namespace {

using Texts = std::vector<std::string>;

const std::vector<PlaneHeight> four_planes{{0.25, 0.5}, {1.5, 0.5}, {2.5, 0.25}, {3.5, 0.5}};

PlaneFinding rings(std::uint64_t plane, std::uint64_t count, double area_mm2, std::uint32_t part = 0,
                   std::uint32_t file = 0) {
    return {.kind = FindingKind::inverted_rings,
            .file = file,
            .part = part,
            .plane = plane,
            .count = count,
            .amount = area_mm2};
}

PlaneFinding chains(std::uint64_t plane, std::uint64_t count, double longest, double total) {
    return {.kind = FindingKind::open_chains,
            .plane = plane,
            .count = count,
            .amount = total,
            .largest = longest};
}

TEST(FindingLog, ReportsCountsAmountsAndTheLowestLayerOfEachKind) {
    FindingLog log;
    EXPECT_TRUE(log.sums(four_planes).empty());
    log.add(rings(2, 1, 2));
    log.add(rings(1, 3, 8));
    log.add(rings(0, 0, 0));
    log.add(chains(3, 2, 4, 5));
    EXPECT_EQ(
        log.sums(four_planes).texts(),
        Texts({"2 open chains in 1 of 4 layers, first at z = 3.5 mm: contours do not close where the mesh "
               "has holes or flipped triangles, the longest gap is 4 mm",
               "4 rings bound no material in 2 of 4 layers, first at z = 1.5 mm (4.5 mm3 lost): they run "
               "clockwise outside of material: triangles face inwards, which `orient` corrects, or "
               "contours around them are open"}));
}

TEST(FindingLog, NamesPartsUnlessAllOfTheFileAreAffected) {
    FindingLog log;
    const std::vector<std::string> labels{"a", "b", "c", "d", "e", "f", "g"};
    const std::vector<std::uint32_t> files{0, 1, 1, 1, 1, 1, 1};
    log.add(rings(1, 1, 1, 0, 0));
    log.add(rings(2, 1, 1, 1, 1));
    const auto text_of = [&](std::uint32_t file) {
        return log.sums(four_planes, labels, files).of(FindingKind::inverted_rings, file).text();
    };
    EXPECT_NE(text_of(0).find("in 1 of 4 layers, first"), std::string::npos) << text_of(0);
    EXPECT_NE(text_of(1).find("layers of the part \"b\", first"), std::string::npos) << text_of(1);
    for (const std::uint32_t part : {2, 3, 4, 5})
        log.add(rings(0, 1, 1, part, 1));
    EXPECT_NE(text_of(1).find("layers of the parts \"b\", \"c\", \"d\" and 2 more, first"), std::string::npos)
        << text_of(1);
    log.add(rings(0, 1, 1, 6, 1));
    EXPECT_NE(text_of(1).find("in 2 of 4 layers, first at z = 0.25 mm"), std::string::npos) << text_of(1);
}

TEST(FindingLog, CountsAPlaneOnceThoughSeveralPartsAndFilesAreAffected) {
    FindingLog log;
    log.add(rings(1, 1, 4, 0, 0));
    log.add(rings(1, 2, 8, 1, 0));
    log.add(rings(1, 4, 16, 2, 1));
    const Findings found = log.sums(four_planes);
    ASSERT_EQ(found.by_file.size(), 2U);
    EXPECT_EQ(found.of(FindingKind::inverted_rings, 0).layers, 1U);
    EXPECT_EQ(found.of(FindingKind::inverted_rings, 0).count, 3U);
    const Finding& total = found.of(FindingKind::inverted_rings);
    EXPECT_EQ(total.layers, 1U);
    EXPECT_EQ(total.count, 7U);
    EXPECT_EQ(total.amount, 14);
    EXPECT_EQ(found.of(FindingKind::open_chains), Finding());
    ASSERT_EQ(log.by_plane().size(), 1U);
    EXPECT_EQ(log.by_plane().front().count, 7U);
}

TEST(FindingLog, GivesTheSameSumsForEveryOrderOfThreads) {
    std::vector<PlaneFinding> all;
    std::minstd_rand random(7);
    const auto fraction = [&] {
        return 1.0 / static_cast<double>(1 + random() % 1000);
    };
    for (std::uint64_t plane = 0; plane < four_planes.size(); ++plane)
        for (std::uint32_t part = 0; part < 50; ++part) {
            all.push_back(rings(plane, 1, fraction(), part, part % 3));
            all.push_back(chains(plane, 1, fraction(), fraction()));
            all.back().part = part;
        }
    FindingLog in_order;
    in_order.add(all);
    std::shuffle(all.begin(), all.end(), random);
    FindingLog log;
    std::vector<std::thread> threads;
    for (std::size_t begin = 0; begin < all.size(); begin += 100)
        threads.emplace_back([&, begin] { log.add(std::span(all).subspan(begin, 100)); });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(log.sums(four_planes).by_file, in_order.sums(four_planes).by_file);
    EXPECT_EQ(log.sums(four_planes).total, in_order.sums(four_planes).total);
    EXPECT_EQ(log.by_plane(), in_order.by_plane());
}

TEST(FindingLog, GivesWhatOtherProcessesFound) {
    FindingLog mine;
    FindingLog theirs;
    mine.add(rings(0, 1, 1));
    theirs.add(rings(3, 1, 1));
    const std::vector<PlaneFinding> message = theirs.take();
    EXPECT_TRUE(theirs.sums(four_planes).empty());
    mine.add(message);
    EXPECT_EQ(mine.sums(four_planes).of(FindingKind::inverted_rings).layers, 2U);
}

TEST(Findings, ReportTheFirstThatStrictRefuses) {
    Findings found;
    EXPECT_EQ(found.first(Severity::warning), nullptr);
    found.add({.kind = FindingKind::unreached_material, .file = 1, .count = 1, .amount = 2, .layers = 1});
    found.add({.kind = FindingKind::near_faces, .file = 3, .count = 1, .amount = 2, .layers = 1});
    ASSERT_NE(found.first(Severity::warning), nullptr);
    EXPECT_EQ(found.first(Severity::warning)->kind, FindingKind::near_faces) << "in the order of the kinds";
    Findings more;
    more.add({.kind = FindingKind::near_faces, .file = 0, .count = 1, .amount = 3, .layers = 1});
    found.add(more);
    EXPECT_EQ(found.by_file.front().file, 0U);
    EXPECT_EQ(found.of(FindingKind::near_faces).amount, 5);
}

TEST(Findings, CountInTheOrderOfTheFileWithThePlaceOfTheFirst) {
    int asked = 0;
    const auto at_byte = [&](int byte) {
        return [&asked, byte] {
            ++asked;
            return "byte " + std::to_string(byte);
        };
    };
    std::vector<Findings> pieces(3);
    pieces[1].note(FindingKind::no_contours, at_byte(120));
    pieces[1].note(FindingKind::no_contours, at_byte(130));
    pieces[2].note(FindingKind::no_contours, at_byte(200));
    pieces[2].note(FindingKind::nothing_left, at_byte(210));
    EXPECT_EQ(asked, 3);
    Findings file;
    for (const Findings& piece : pieces)
        file.add(piece);
    ASSERT_EQ(file.by_file.size(), 2U);
    EXPECT_EQ(file.of(FindingKind::no_contours, 0).count, 3U);
    EXPECT_EQ(file.of(FindingKind::no_contours, 0).place, "byte 120");
    EXPECT_EQ(file.of(FindingKind::no_contours).count, 3U);
    EXPECT_EQ(file.of(FindingKind::nothing_left).place, "byte 210");
}

TEST(Findings, GiveTheNumbersOfACheckByTheirKeys) {
    Findings found;
    found.add({.kind = FindingKind::misoriented_rings, .count = 2});
    found.add({.kind = FindingKind::tangled_rings, .count = 3});
    found.add({.kind = FindingKind::unreached_layers, .count = 1, .amount = 0.5});
    const auto keys_of = [&](FindingOrigin check) {
        std::map<std::string, double> numbers;
        for (const FindingNumber& number : found.numbers(check))
            EXPECT_TRUE(
                numbers
                    .emplace(number.key,
                             std::visit([](auto value) { return static_cast<double>(value); }, number.value))
                    .second);
        return numbers;
    };
    EXPECT_EQ(keys_of(FindingOrigin::layers), (std::map<std::string, double>{{"open_chains", 0},
                                                                             {"crossings", 0},
                                                                             {"misoriented", 5},
                                                                             {"overlapping", 0},
                                                                             {"height_overlaps", 0},
                                                                             {"hatches", 0},
                                                                             {"displaced", 0}}));
    EXPECT_EQ(keys_of(FindingOrigin::vectors), (std::map<std::string, double>{{"open_chains", 0},
                                                                              {"crossings", 0},
                                                                              {"misoriented", 2},
                                                                              {"outside", 0},
                                                                              {"too_short", 0},
                                                                              {"unreached_layers", 1},
                                                                              {"unreached_mm2", 0.5},
                                                                              {"inverted_rings", 0},
                                                                              {"inverted_mm3", 0},
                                                                              {"height_overlaps", 0},
                                                                              {"unbounded", 0}}));
}

TEST(Findings, AddUpLaterLayersOfAFile) {
    Findings lower;
    lower.add(
        {.kind = FindingKind::near_faces, .count = 1, .amount = 2, .largest = 5, .layers = 3, .first_z = 1});
    Findings upper;
    upper.add(
        {.kind = FindingKind::near_faces, .count = 2, .amount = 3, .largest = 4, .layers = 1, .first_z = 9});
    lower.add(upper);
    const Finding sum{
        .kind = FindingKind::near_faces, .count = 3, .amount = 5, .largest = 5, .layers = 4, .first_z = 1};
    EXPECT_EQ(lower.by_file, std::vector{sum});
}

TEST(Findings, NameTheFilesOfAnArchive) {
    Findings found;
    for (const char* const entry : {"core", "skin"})
        found.add({.kind = FindingKind::replaced_hatch_lines, .entries = {entry}, .count = 2});
    found.add({.kind = FindingKind::outdated_hatch_lines, .entries = {"core", "skin"}, .count = 1});
    EXPECT_EQ(
        found.texts(),
        Texts({"core: 2 hatch lines left out: layers are hatched anew",
               "skin: 2 hatch lines left out: layers are hatched anew",
               "core: 1 hatch line left out: the contours that they fill were changed (and in 1 more of "
               "its files)"}));
    EXPECT_EQ(found.of(FindingKind::replaced_hatch_lines).count, 4U);
}

TEST(Finding, NamesWhatClosesGapsThatRoundingLeaves) {
    const auto text_of = [](double longest) {
        FindingLog log;
        log.add(chains(0, 1, longest, longest));
        return log.sums(std::vector<PlaneHeight>{{0.5, 1}}).by_file.front().text();
    };
    const std::string slit =
        "1 open chain in 1 of 1 layer, first at z = 0.5 mm: contours do not close, though "
        "no gap is longer than ";
    const std::string cause = " mm: vertices lie on edges of neighbours (T-junctions), or vertices are not "
                              "joined; `close_gaps_mm` ";
    EXPECT_EQ(text_of(0), slit + "0" + cause + "1e-6 closes them");
    EXPECT_EQ(text_of(3.1e-16), slit + "3.1e-16" + cause + "1e-6 closes them");
    EXPECT_EQ(text_of(2.5e-5), slit + "2.5e-05" + cause + "1e-4 closes them");
    EXPECT_EQ(text_of(2).find("close_gaps_mm"), std::string::npos);
}

TEST(Finding, GivesASnapDistanceThatIsEnoughForNearFaces) {
    FindingLog log;
    const auto near = [&](std::uint64_t plane, double area, double farthest) {
        log.add({.kind = FindingKind::near_faces,
                 .part = PlaneFinding::no_part,
                 .plane = plane,
                 .count = 1,
                 .amount = area,
                 .largest = farthest});
    };
    near(0, 60, 3e-7);
    near(2, 40, 2e-5);
    EXPECT_EQ(
        log.sums(four_planes).texts(),
        Texts({"100 mm2 of level faces lie within rounding of a plane in 2 of 4 layers, first at z = 0.25 "
               "mm: rounding decides whether these layers are cut above or below them; `snap_mm` 1e-4 "
               "counts them as on the plane"}));
}

} // namespace
} // namespace lamella
