#include "lamella/write/defect_picture.hpp"

#include "fixtures/meshes.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lamella {
namespace {

std::string picture_of(const TriangleSoup& soup) {
    const IndexedMesh mesh = weld(soup);
    return defect_picture(mesh, diagnose(mesh, {.keep = picture_places, .self_intersections = true}));
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++n;
    return n;
}

TEST(DefectPicture, OfASoundSolidHasFourViewsAndNoMarks) {
    const std::string svg = picture_of(make_rook());
    EXPECT_TRUE(svg.starts_with("<svg "));
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
    for (const char* view : {">front<", ">right<", ">top<", ">aslant<"})
        EXPECT_EQ(count(svg, view), 1U);
    EXPECT_EQ(count(svg, "stroke-width=\"2\""), 0U);
    EXPECT_EQ(count(svg, "r=\"3\""), 0U);
    EXPECT_GT(count(svg, "<path stroke"), 8U);
    EXPECT_LT(svg.size(), 400'000U);
    EXPECT_EQ(svg, picture_of(make_rook()));
}

TEST(DefectPicture, MarksEveryKindInEveryView) {
    using namespace test;
    // A loop of four edges: one line in each view.
    EXPECT_EQ(count(picture_of(TriangleSoup(box_without_a_lid())), "stroke=\"#d00000\""), 4U);
    EXPECT_EQ(count(picture_of(TriangleSoup(box_with_a_flipped_triangle())), "stroke=\"#e000b0\""), 3 * 4U);
    EXPECT_EQ(count(picture_of(TriangleSoup(boxes_sharing_an_upright_edge())), "stroke=\"#f08000\""), 4U);
    EXPECT_EQ(count(picture_of(TriangleSoup(boxes_sharing_a_vertex())), "fill=\"#f08000\""), 4 + 1U);
    EXPECT_GT(count(picture_of(TriangleSoup(boxes_overlapping())), "r=\"3\" fill=\"#7030d0\""), 4U);
    EXPECT_EQ(
        count(picture_of(TriangleSoup(flipped(box_triangles({0, 0, 0}, {1, 1, 1})))), "stroke=\"#0050e0\""),
        12 * 4U);
}

TEST(DefectPicture, OfNothingAndOfAPointIsAPictureToo) {
    EXPECT_TRUE(defect_picture({}, diagnose({})).ends_with("</svg>\n"));
    const IndexedMesh point{{{1, 1, 1}}, {{0, 0, 0}}};
    EXPECT_TRUE(defect_picture(point, diagnose(point)).ends_with("</svg>\n"));
}

} // namespace
} // namespace lamella
