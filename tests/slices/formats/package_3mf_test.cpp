#include "slices/formats/package_3mf.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

namespace lamella::package_3mf_cases {
namespace {

TEST(Package3mf, HasABoxWhoseFacesPointOutwards) {
    Box3 box;
    box.add(Point3{1, 2, 3});
    box.add(Point3{4, 6, 8.5});
    const std::string text = package_3mf::box_mesh(box);
    const auto number_after = [&](std::size_t& at, const std::string& before) {
        at = text.find(before, at) + before.size();
        return std::stod(text.substr(at));
    };
    std::array<Point3, 8> vertices;
    std::size_t at = 0;
    for (Point3& vertex : vertices) {
        vertex.x = number_after(at, " x=\"");
        vertex.y = number_after(at, " y=\"");
        vertex.z = number_after(at, " z=\"");
    }
    double six_volumes = 0;
    std::map<std::pair<int, int>, int> edges;
    for (int i = 0; i < 12; ++i) {
        std::array<int, 3> t{};
        for (std::size_t k = 0; k < 3; ++k)
            t[k] = static_cast<int>(number_after(at, " v" + std::to_string(k + 1) + "=\""));
        const Point3& a = vertices.at(static_cast<std::size_t>(t[0]));
        const Point3& b = vertices.at(static_cast<std::size_t>(t[1]));
        const Point3& c = vertices.at(static_cast<std::size_t>(t[2]));
        six_volumes +=
            a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
        for (std::size_t k = 0; k < 3; ++k)
            ++edges[{t[k], t[(k + 1) % 3]}];
    }
    EXPECT_NEAR(six_volumes / 6, 3 * 4 * 5.5, 1e-9);
    for (const auto& [edge, times] : edges) {
        EXPECT_EQ(times, 1);
        EXPECT_EQ(edges.count({edge.second, edge.first}), 1U) << "each edge is used in both directions";
    }
    EXPECT_EQ(text.find(" v1=\"", at), std::string::npos);
}

} // namespace
} // namespace lamella::package_3mf_cases
