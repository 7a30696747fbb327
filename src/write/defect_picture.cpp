#include "lamella/write/defect_picture.hpp"

#include "core/executor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <vector>

namespace lamella {

namespace {

constexpr int panel = 440; // pixels
constexpr int margin = 20; // around the mesh within a panel
constexpr int shades = 12; // of each of the two sides
constexpr int legend_height = 60;
constexpr int title_height = 26;

/// Where one looks from: right, up, and towards the eye.
struct View {
    std::string_view name;
    Point3 right;
    Point3 up;
    Point3 eye;
};

double dot(const Point3& a, const Point3& b) noexcept {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

std::array<View, 4> views() {
    const double half = std::sqrt(0.5);
    const double third = std::sqrt(1.0 / 3);
    const double sixth = std::sqrt(1.0 / 6);
    return {{{"front", {1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
             {"right", {0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
             {"top", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
             {"aslant", {half, half, 0}, {-sixth, sixth, 2 * sixth}, {third, -third, third}}}};
}

/// Points of the mesh in pixels of a panel, y down; z towards the eye.
class Camera {
  public:
    Camera(const View& view, const Box3& box)
        : view_(view), middle_{box.min.x / 2 + box.max.x / 2, box.min.y / 2 + box.max.y / 2,
                               box.min.z / 2 + box.max.z / 2} {
        // One scale for all views: the box turned any way fits its diagonal.
        const double diagonal = std::hypot(box.max.x / 2 - box.min.x / 2, box.max.y / 2 - box.min.y / 2,
                                           box.max.z / 2 - box.min.z / 2);
        scale_ = diagonal > 0 ? (panel / 2.0 - margin) / diagonal : 0;
    }

    [[nodiscard]] Point3 operator()(const Point3& p) const noexcept {
        const Point3 q{(p.x - middle_.x) * scale_, (p.y - middle_.y) * scale_, (p.z - middle_.z) * scale_};
        return {panel / 2.0 + dot(q, view_.right), panel / 2.0 - dot(q, view_.up), dot(q, view_.eye)};
    }

  private:
    View view_;
    Point3 middle_;
    double scale_ = 0;
};

/// A panel of pixels: what is nearest to the eye there, as a shade.
class Canvas {
  public:
    Canvas() : depth_(panel * panel, -Box3::infinity), shade_(panel * panel, empty) {}

    void draw(const std::array<Point3, 3>& t) {
        const double area = (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
        if (area == 0)
            return;
        const Point3 u{t[1].x - t[0].x, t[1].y - t[0].y, t[1].z - t[0].z};
        const Point3 v{t[2].x - t[0].x, t[2].y - t[0].y, t[2].z - t[0].z};
        const Point3 n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, area};
        // Lit from the eye and a little from above left. Pixels run down, so a front has negative area.
        const double facing = std::abs(n.z);
        const double light = (0.9 * facing + 0.3 * std::abs(n.x + n.y) * 0.5) / std::sqrt(dot(n, n));
        const int level = std::clamp(static_cast<int>(light * shades), 0, shades - 1);
        const auto shade = static_cast<std::uint8_t>(area < 0 ? level : shades + level);
        const auto [left, right] = std::minmax({t[0].x, t[1].x, t[2].x});
        const auto [above, below] = std::minmax({t[0].y, t[1].y, t[2].y});
        const auto pixel = [](double at) {
            return std::clamp(static_cast<int>(std::floor(at)), 0, panel - 1);
        };
        for (int y = pixel(above); y <= pixel(below); ++y)
            for (int x = pixel(left); x <= pixel(right); ++x) {
                const double px = x + 0.5;
                const double py = y + 0.5;
                const auto weight = [&](const Point3& a, const Point3& b) {
                    return ((b.x - a.x) * (py - a.y) - (b.y - a.y) * (px - a.x)) / area;
                };
                const double w0 = weight(t[1], t[2]);
                const double w1 = weight(t[2], t[0]);
                const double w2 = 1 - w0 - w1;
                if (w0 < 0 || w1 < 0 || w2 < 0)
                    continue;
                const double depth = w0 * t[0].z + w1 * t[1].z + w2 * t[2].z;
                const auto place = static_cast<std::size_t>(y * panel + x);
                if (depth > depth_[place]) {
                    depth_[place] = depth;
                    shade_[place] = shade;
                }
            }
    }

    /// Runs of equal pixels, as one path for each shade.
    void write(std::string& svg) const {
        std::array<std::string, std::size_t{2} * shades> paths;
        for (int y = 0; y < panel; ++y)
            for (int x = 0; x < panel;) {
                const std::uint8_t shade = at(x, y);
                int end = x;
                while (end < panel && at(end, y) == shade)
                    ++end;
                if (shade != empty)
                    fmt::format_to(std::back_inserter(paths[shade]), "M{} {}h{}", x, y, end - x);
                x = end;
            }
        for (std::size_t s = 0; s < paths.size(); ++s)
            if (!paths[s].empty()) {
                const int level = 70 + static_cast<int>(s % shades) * 165 / (shades - 1);
                const bool inner = s >= shades;
                fmt::format_to(std::back_inserter(svg), "<path stroke=\"#{:02x}{:02x}{:02x}\" d=\"{}\"/>\n",
                               level, inner ? level * 8 / 10 : level, inner ? level * 5 / 10 : level,
                               paths[s]);
            }
    }

  private:
    static constexpr std::uint8_t empty = 0xff;

    [[nodiscard]] std::uint8_t at(int x, int y) const {
        return shade_[static_cast<std::size_t>(y * panel + x)];
    }

    std::vector<double> depth_;
    std::vector<std::uint8_t> shade_;
};

struct MarkStyle {
    std::string_view name;
    std::string_view colour;
};
constexpr MarkStyle boundary{"boundary loops", "#d00000"};
constexpr MarkStyle conflict{words_of(&Inspection::orientation_conflicts).many, "#e000b0"};
constexpr MarkStyle crowded{"crowded edges and vertices", "#f08000"};
constexpr MarkStyle meeting{"pairs of triangles that cross or overlap", "#7030d0"};
constexpr MarkStyle inverted{words_of(&Inspection::inverted_shells).many, "#0050e0"};

class Marks {
  public:
    Marks(const Camera& camera, std::string& svg) : camera_(camera), svg_(svg) {}

    template <class Points>
    void line(const MarkStyle& style, const Points& points, bool closed) {
        fmt::format_to(out(),
                       "<path fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-opacity=\"0.85\" "
                       "stroke-linejoin=\"round\" d=\"",
                       style.colour);
        char command = 'M';
        for (const Point3& p : points) {
            const Point3 at = camera_(p);
            fmt::format_to(out(), "{}{:.1f} {:.1f}", command, at.x, at.y);
            command = 'L';
        }
        svg_ += closed ? "Z\"/>\n" : "\"/>\n";
    }

    void dot(const MarkStyle& style, const Point3& p) {
        const Point3 at = camera_(p);
        fmt::format_to(out(),
                       "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\" fill-opacity=\"0.8\"/>\n",
                       at.x, at.y, style.colour);
    }

    void box(const MarkStyle& style, const Box3& b) {
        const auto corner = [&](int i) -> Point3 {
            return {(i & 1) != 0 ? b.max.x : b.min.x, (i & 2) != 0 ? b.max.y : b.min.y,
                    (i & 4) != 0 ? b.max.z : b.min.z};
        };
        for (int i = 0; i < 8; ++i)
            for (const int bit : {1, 2, 4})
                if ((i & bit) == 0)
                    line(style, std::array{corner(i), corner(i | bit)}, false);
    }

    void all_of(const Diagnosis& found) {
        for (const Shell& shell : found.shells)
            if (shell.kind == ShellKind::inverted)
                box(inverted, shell.box);
        for (const EdgePlace& edge : found.nonmanifold_edges)
            line(crowded, edge, false);
        for (const Point3& p : found.vertices)
            dot(crowded, p);
        for (const EdgePlace& edge : found.conflicting_edges)
            line(conflict, edge, false);
        for (const BoundaryLoop& loop : found.loops)
            line(boundary, loop.points, loop.closed);
        if (found.self_intersections)
            for (const Meeting& m : found.self_intersections->first)
                if (m.kind != MeetingKind::touching)
                    dot(meeting, m.at);
    }

  private:
    [[nodiscard]] std::back_insert_iterator<std::string> out() { return std::back_inserter(svg_); }

    const Camera& camera_;
    std::string& svg_;
};

/// A mark of each kind with its count, in one row.
void write_legend(const Diagnosis& found, std::string& svg) {
    struct Entry {
        MarkStyle style;
        std::uint64_t count;
        std::size_t shown;
    };
    std::vector<Entry> entries{{boundary, found.boundary_loops, found.loops.size()},
                               {conflict, found.counts.orientation_conflicts, found.conflicting_edges.size()},
                               {crowded, found.counts.nonmanifold_edges + found.nonmanifold_vertices,
                                found.nonmanifold_edges.size() + found.vertices.size()},
                               {inverted, found.counts.inverted_shells,
                                static_cast<std::size_t>(std::count_if(
                                    found.shells.begin(), found.shells.end(),
                                    [](const Shell& shell) { return shell.kind == ShellKind::inverted; }))}};
    if (found.self_intersections)
        entries.push_back(
            {meeting, found.self_intersections->crossing + found.self_intersections->overlapping,
             static_cast<std::size_t>(
                 std::count_if(found.self_intersections->first.begin(), found.self_intersections->first.end(),
                               [](const Meeting& m) { return m.kind != MeetingKind::touching; }))});
    int x = margin;
    int y = 2 * (panel + title_height) + 22;
    for (const Entry& entry : entries) {
        std::string text = fmt::format("{} {}", entry.count, entry.style.name);
        if (entry.shown < entry.count)
            text += fmt::format(" ({} shown)", entry.shown);
        const int width = 30 + 8 * static_cast<int>(text.size());
        if (x + width > 2 * panel) {
            x = margin;
            y += 24;
        }
        fmt::format_to(std::back_inserter(svg),
                       "<circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"{}\"/><text x=\"{}\" y=\"{}\">{}</text>\n",
                       x, y - 5, entry.count > 0 ? entry.style.colour : "#c0c0c0", x + 10, y, text);
        x += width;
    }
}

} // namespace

std::string defect_picture(const IndexedMesh& mesh, const Diagnosis& diagnosis, const Execution& execution) {
    const Executor executor(execution);
    constexpr int width = 2 * panel;
    constexpr int height = 2 * (panel + title_height) + legend_height;
    std::string svg = fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
                                  "viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" font-size=\"14\">\n"
                                  "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
                                  width, height);
    int number = 0;
    for (const View& view : views()) {
        const Camera camera(view, diagnosis.counts.box);
        Canvas canvas;
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            if (i % 1024 == 0)
                executor.check_cancelled();
            const auto& t = mesh.triangles[i];
            canvas.draw(
                {camera(mesh.vertices[t[0]]), camera(mesh.vertices[t[1]]), camera(mesh.vertices[t[2]])});
        }
        const int x = number % 2 * panel;
        const int y = number / 2 * (panel + title_height);
        fmt::format_to(std::back_inserter(svg),
                       "<g transform=\"translate({},{})\">\n<text x=\"{}\" y=\"18\">{}</text>\n"
                       "<g transform=\"translate(0,{})\">\n<g shape-rendering=\"crispEdges\" "
                       "transform=\"translate(0,0.5)\">\n",
                       x, y, margin, view.name, title_height);
        canvas.write(svg);
        svg += "</g>\n";
        Marks(camera, svg).all_of(diagnosis);
        svg += "</g>\n</g>\n";
        ++number;
    }
    write_legend(diagnosis, svg);
    return svg + "</svg>\n";
}

} // namespace lamella
