#include "lamella/slices/layer_writer.hpp"

#include "fixtures/sample_layers.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::raw_cases {
namespace {

/// Takes numbers and texts from the bytes of a file, as a program that reads a pipe does.
class Cursor {
  public:
    explicit Cursor(std::string_view bytes) : bytes_(bytes) {}

    template <class T>
    T number() {
        T value{};
        std::memcpy(&value, text(sizeof value).data(), sizeof value);
        return value;
    }
    template <class T>
    std::vector<T> numbers(std::uint64_t count) {
        std::vector<T> values(count);
        std::memcpy(values.data(), text(count * sizeof(T)).data(), count * sizeof(T));
        return values;
    }
    std::string_view text(std::size_t size) {
        EXPECT_LE(at_ + size, bytes_.size());
        at_ += size;
        return bytes_.substr(at_ - size, size);
    }
    void align() { at_ = (at_ + 7) / 8 * 8; }
    [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

  private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

/// Two parts on two planes: the first has a ring and a chain, the second hatch lines and, above, nothing.
std::vector<Plane> two_planes() {
    LayerBuilder first;
    add_contour(first, {{0, 0}, {1, 0}, {0.1, 1}});
    add_contour(first, {{5, 5}, {6, 0.25}}, false);
    LayerBuilder second;
    add_contour(second, {{2, 2}, {3, 2}, {2, 3}});
    std::vector<Plane> planes(2);
    planes[0].polylines = {first.finish(7, 0.05, 0, 0.1), second.finish(7, 0.05, 0, 0.1)};
    planes[0].hatches = {{}, PointArray(std::vector<Point2>{{2.1, 2.1}, {2.9, 2.1}, {2.1, 2.3}, {2.7, 2.3}})};
    LayerBuilder above;
    add_contour(above, {{0, 0}, {1.0 / 3, 0}, {0, 1}});
    planes[1].polylines = {above.finish(8, 0.15, 0.1, 0.2), LayerBuilder().finish(8, 0.15, 0.1, 0.2)};
    planes[1].hatches = {{}, {}};
    return planes;
}

TEST(Raw, HasTheArraysOfOneLayerAfterTheOther) {
    const std::vector<Plane> planes = two_planes();
    const TemporaryFolder folder;
    LayerFileInfo info{
        .box = {}, .layers = planes.size(), .parts = {{.label = "left \"1\""}, {.label = "right"}}};
    info.box.add(Point3{0, 0, 0});
    info.box.add(Point3{6, 5, 0.2});
    const auto writer =
        open_layer_writer(folder.file("out"), layer_format("raw", ""), info, options_for_any());
    for (const Plane& plane : planes) {
        Completions none;
        writer->prepare(plane).in_order(none);
    }
    writer->finish();
    EXPECT_TRUE(writer->warnings().empty());

    const std::string bytes = file_bytes(folder.file("out"));
    Cursor cursor(bytes);
    EXPECT_EQ(cursor.text(8), "lamella\n");
    const std::string_view facts = cursor.text(cursor.number<std::uint64_t>());
    EXPECT_EQ(facts.size() % 8, 0U);
    EXPECT_TRUE(
        facts.starts_with(R"({"units":"mm","layers":2,"parts":[{"label":"left \"1\""},{"label":"right"}],)"
                          R"("rule":"section_above"})"))
        << facts;
    for (const Plane& plane : planes) {
        const Layer& first = plane.polylines.front();
        EXPECT_EQ(cursor.number<std::uint64_t>(), first.index);
        EXPECT_EQ(cursor.numbers<double>(3), (std::vector<double>{first.z, first.bottom, first.top}));
        const auto counts = cursor.numbers<std::uint64_t>(3);
        std::vector<double> points;
        std::vector<double> lines;
        std::vector<std::uint32_t> ends;
        std::vector<std::uint32_t> contour_parts;
        std::vector<std::uint32_t> line_parts;
        std::vector<char> closed;
        for (std::uint32_t part = 0; part < plane.polylines.size(); ++part) {
            const Layer& layer = plane.polylines[part];
            for (std::size_t i = 0; i < layer.contours(); ++i) {
                for (const Point2& p : layer.contour(i))
                    points.insert(points.end(), {p.x, p.y});
                ends.push_back(static_cast<std::uint32_t>(points.size() / 2));
                contour_parts.push_back(part);
                closed.push_back(i < layer.rings ? 1 : 0);
            }
            for (const Point2& p : plane.hatches[part].span())
                lines.insert(lines.end(), {p.x, p.y});
            line_parts.resize(lines.size() / 4, part);
        }
        EXPECT_EQ(counts, (std::vector<std::uint64_t>{ends.size(), points.size() / 2, lines.size() / 4}));
        EXPECT_EQ(cursor.numbers<double>(points.size()), points);
        EXPECT_EQ(cursor.numbers<double>(lines.size()), lines);
        EXPECT_EQ(cursor.numbers<std::uint32_t>(ends.size()), ends);
        EXPECT_EQ(cursor.numbers<std::uint32_t>(ends.size()), contour_parts);
        EXPECT_EQ(cursor.numbers<std::uint32_t>(line_parts.size()), line_parts);
        EXPECT_EQ(cursor.numbers<char>(closed.size()), closed);
        cursor.align();
    }
    EXPECT_TRUE(cursor.at_end());
}

} // namespace
} // namespace lamella::raw_cases
