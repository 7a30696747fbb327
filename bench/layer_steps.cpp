// Measures the cost of layer and mesh steps: filling clean layers, and layers of a part and its copy moved by
// half of its width, against slicing; offsets against slicing and against Clipper, GEOS and CGAL; finding
// self-intersections against welding. Clean layers must come back bit for bit. United layers must have no
// crossings and not change when filled again. Areas of offsets must equal those of the other libraries.

#include "experiment.hpp"
#include "offsets_of_others.hpp"
#include "parts.hpp"
#include "parts/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace lamella::bench {

namespace {

/// Times in seconds, and whether the result is right.
struct Timed {
    double slice = 0;
    double fill = 0;
    std::uint64_t points = 0;
    bool right = false;
};

bool equal(const LayerStack& a, const LayerStack& b) {
    return std::ranges::equal(
        a, b, [](const Layer& x, const Layer& y) { return content_hash(x) == content_hash(y); });
}

struct Stepped {
    LayerStack layers;
    LayerChanges changes;
};

/// Applies the steps to one part, and adds up the changes of its layers.
Stepped stepped(const LayerSteps& steps, const LayerStack& layers, const Execution& execution) {
    ChangedStacks result = take_steps(steps, std::vector<LayerStack>{layers}, {.execution = execution});
    Stepped all{std::move(result.parts.front()), {}};
    for (const LayerChanges& plane : result.planes)
        all.changes += plane;
    return all;
}

Timed fill_clean(const Part& part, const Execution& execution) {
    const OpenedPart opened = open_part(part, execution);
    Timed result;
    const auto slicing = Clock::now();
    const LayerStack layers = slice(opened.mesh, opened.plan, {.execution = execution});
    result.slice = seconds_since(slicing);
    for (const Layer& layer : layers)
        result.points += layer.points.size();
    const auto filling = Clock::now();
    const auto [filled, changes] = stepped({.fill = FillRule::nonzero}, layers, execution);
    result.fill = seconds_since(filling);
    result.right = changes.changed_layers == 0 && equal(filled, layers);
    return result;
}

/// Adds to every layer a copy of itself, moved by half of the part's width: many bodies cross.
LayerStack doubled(const LayerStack& layers, double by) {
    LayerStack both;
    for (const Layer& layer : layers) {
        Layer moved = layer;
        std::vector<Point2> points(layer.points.begin(), layer.points.end());
        for (Point2& p : points)
            p.x += by;
        moved.points = PointArray(std::move(points));
        both.push_back(merged(std::vector<Layer>{layer, normal_form(std::move(moved))}));
    }
    return both;
}

Timed fill_doubled(const Part& part, const Execution& execution) {
    const OpenedPart opened = open_part(part, execution);
    Timed result;
    const auto slicing = Clock::now();
    const LayerStack single = slice(opened.mesh, opened.plan, {.execution = execution});
    result.slice = seconds_since(slicing);
    const LayerStack layers = doubled(single, (opened.box.max.x - opened.box.min.x) / 2);
    for (const Layer& layer : layers)
        result.points += layer.points.size();
    const auto filling = Clock::now();
    const auto [filled, changes] = stepped({.fill = FillRule::nonzero}, layers, execution);
    result.fill = seconds_since(filling);
    const auto [same, again] = stepped({.fill = FillRule::nonzero}, filled, execution);
    result.right = changes.groups_united > 0 && again.changed_layers == 0 && equal(same, filled) &&
                   std::ranges::none_of(filled, [](const Layer& layer) { return has_crossings(layer); });
    return result;
}

/// Times in seconds on one thread, for the same layers.
struct Moved {
    double slice = 0;
    double ours = 0;
    double clipper = 0; ///< for all layers, estimated from a few; also for the next ones
    double geos = 0;
    double cgal = 0; ///< 0 if layers are too large for CGAL
    std::uint64_t points = 0;
    bool right = true;
};

/// Larger layers take CGAL minutes.
constexpr std::size_t most_points_for_cgal = 10000;

Moved move_layers(const Part& part, double distance) {
    const OpenedPart opened = open_part(part, {.threads = 1});
    Moved result;
    const auto slicing = Clock::now();
    const LayerStack layers = slice(opened.mesh, opened.plan, {.execution = {.threads = 1}});
    result.slice = seconds_since(slicing);
    const auto moving = Clock::now();
    const LayerStack moved = stepped({.offset_mm = distance}, layers, {.threads = 1}).layers;
    result.ours = seconds_since(moving);
    // The other libraries are slow, so a few layers represent all.
    const auto compare = [&](std::size_t count, double tolerance, const auto& area_by, double& seconds) {
        const std::size_t step = std::max<std::size_t>(1, layers.size() / count);
        std::size_t compared = 0;
        for (std::size_t i = step / 2; i < layers.size(); i += step, ++compared) {
            const auto begin = Clock::now();
            const double area = area_by(layers[i], distance);
            seconds += seconds_since(begin);
            const LayerMeasure measured = measure(moved[i]);
            result.right = result.right && !has_crossings(moved[i]) &&
                           std::abs(measured.area_mm2 - area) <= tolerance * (1 + measured.perimeter_mm);
        }
        seconds *= static_cast<double>(layers.size()) / static_cast<double>(compared);
    };
    std::size_t largest = 0;
    for (const Layer& layer : layers)
        largest = std::max(largest, layer.points.size());
    compare(10, 1e-6, area_by_clipper, result.clipper);
    // GEOS omits points closer to the line through their neighbours than a hundredth of the distance.
    compare(10, 0.01 * std::abs(distance), area_by_geos, result.geos);
    if (largest <= most_points_for_cgal)
        compare(2, 1e-4, area_by_cgal, result.cgal);
    for (const Layer& layer : layers)
        result.points += layer.points.size();
    return result;
}

bool add_offset(Table& table, const Part& part, double distance, int rounds) {
    std::vector<double> slice;
    std::vector<double> ours;
    std::vector<double> clipper;
    std::vector<double> geos;
    std::vector<double> cgal;
    Moved last;
    bool right = true;
    for (int round = 0; round < rounds; ++round) {
        last = measure_in_child<Moved>([&] { return move_layers(part, distance); }).result;
        slice.push_back(last.slice);
        ours.push_back(last.ours);
        clipper.push_back(last.clipper);
        geos.push_back(last.geos);
        cgal.push_back(last.cgal);
        right = right && last.right;
    }
    table.add(
        {part.name, fmt::format("{}", distance),
         fmt::format("{:.2f}", static_cast<double>(last.points) / 1e6), fmt::format("{:.4f}", median(slice)),
         fmt::format("{:.4f}", median(ours)), fmt::format("{:.2f}", median(ours) / median(slice)),
         fmt::format("{:.0f}", 1e9 * median(ours) / static_cast<double>(last.points)),
         fmt::format("{:.1f}", median(clipper) / median(ours)),
         fmt::format("{:.1f}", median(geos) / median(ours)),
         last.cgal == 0 ? "" : fmt::format("{:.0f}", median(cgal) / median(ours)), right ? "yes" : "WRONG"});
    return right;
}

struct Intersections {
    double weld = 0;
    double find = 0;
    std::uint64_t pairs = 0;
};

Intersections self_intersections(const Part& part, const Execution& execution) {
    const OpenedPart opened = open_part(part, execution);
    Intersections result;
    const auto welding = Clock::now();
    const IndexedMesh mesh = weld(opened.mesh, execution);
    result.weld = seconds_since(welding);
    const auto finding = Clock::now();
    result.pairs = find_self_intersections(mesh, {}, execution).pairs();
    result.find = seconds_since(finding);
    return result;
}

/// Adds one row: medians of the results of `measure`.
template <class Measure>
bool add_fill(Table& table, const std::string& what, int rounds, const Measure& measure) {
    std::vector<double> slice;
    std::vector<double> fill;
    Timed last;
    bool right = true;
    for (int round = 0; round < rounds; ++round) {
        last = measure_in_child<Timed>(measure).result;
        slice.push_back(last.slice);
        fill.push_back(last.fill);
        right = right && last.right;
    }
    table.add({what, fmt::format("{:.2f}", static_cast<double>(last.points) / 1e6),
               fmt::format("{:.4f}", median(slice)), fmt::format("{:.4f}", median(fill)),
               fmt::format("{:.2f}", median(fill) / median(slice)),
               fmt::format("{:.0f}", 1e9 * median(fill) / static_cast<double>(last.points)),
               right ? "yes" : "WRONG"});
    return right;
}

int report(int argc, char** argv) {
    const Options options(argc, argv, "layer_steps [--rounds 5] [--threads 0]");
    const int rounds = options.rounds();
    const unsigned threads = options.threads();
    const Execution execution{.threads = threads};
    std::cout << machine() << "; medians of " << rounds << " rounds, " << threads << " threads\n\n";
    std::vector<Part> parts = standard_parts();
    parts.push_back(make_part("sole", 0.1, [] { return make_sole(); }));
    std::erase_if(parts, [](const Part& part) { return part.name.ends_with("shuffled"); });

    Table fills({"part", "Mpoints", "slice s", "fill s", "fill / slice", "ns/point", "checked"});
    bool all_right = true;
    for (const Part& part : parts)
        all_right =
            add_fill(fills, part.name, rounds, [&] { return fill_clean(part, execution); }) && all_right;
    for (const Part& part : parts) {
        if (part.name != "rook" && part.name != "lattice")
            continue; // the others have millions of crossings, which take minutes
        all_right =
            add_fill(fills, part.name + ", doubled", 1, [&] { return fill_doubled(part, execution); }) &&
            all_right;
    }
    std::cout << fills.text() << '\n';

    Table moved({"part", "offset mm", "Mpoints", "slice s", "offset s", "offset / slice", "ns/point",
                 "Clipper / ours", "GEOS / ours", "CGAL / ours", "checked"});
    for (const Part& part : parts)
        for (const double distance : {-0.05, 0.05})
            all_right = add_offset(moved, part, distance, rounds) && all_right;
    std::cout << moved.text() << '\n';

    Table intersections({"part", "weld s", "self-intersections s", "to weld", "pairs"});
    for (const Part& part : parts) {
        const Intersections found =
            measure_in_child<Intersections>([&] { return self_intersections(part, execution); }).result;
        const Intersections alone =
            measure_in_child<Intersections>([&] { return self_intersections(part, {.threads = 1}); }).result;
        all_right = all_right && alone.pairs == found.pairs;
        intersections.add({part.name, fmt::format("{:.3f}", found.weld), fmt::format("{:.3f}", found.find),
                           fmt::format("{:.1f}", found.find / found.weld),
                           alone.pairs == found.pairs ? fmt::to_string(found.pairs) : "WRONG"});
    }
    std::cout << intersections.text();
    return all_right ? 0 : 1;
}

} // namespace

} // namespace lamella::bench

int main(int argc, char** argv) {
    return lamella::bench::report(argc, argv);
}
