// Measures hatch lines per second, and the cost of scan vectors of a whole part against slicing it and
// against the method of open-source tools: parallel lines across the layer, all clipped by its contours in
// one call of Clipper. The total length of the lines must equal Clipper's; the vectors of all patterns must
// cover as much as plain lines. Also measures a whole job, from mesh to a binary file, against copying this
// file, whose contents must pass verify_vectors.

#include "lamella/core/unit_circle.hpp"

#include "experiment.hpp"
#include "parts.hpp"
#include "parts/shapes.hpp"

#include <fmt/format.h>
#include <polyclipping/clipper.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <span>

namespace lamella::bench {

namespace {

constexpr double distance_mm = 0.1;
constexpr double degrees = 67;

/// Returns a strategy of hatch lines only, over all material.
ScanStrategy lines_only(HatchPattern pattern) {
    ScanStrategy strategy;
    strategy.contours.count = 0;
    strategy.hatch.pattern = pattern;
    strategy.hatch.distance = distance_mm;
    strategy.hatch.angle_degrees = degrees;
    strategy.hatch.turn_degrees = 0;
    strategy.hatch.border = 0;
    strategy.hatch.shortest = 0;
    strategy.hatch.overlap = 0;
    return strategy;
}

/// Returns the length of the vectors of the first exposure.
double length_of(const Plane& vectors) {
    return measure_vectors(vectors.polylines.front(), vectors.hatches.front().span(), {}).figures.marked_mm;
}

/// Lines of Clipper across a layer.
struct Lines {
    double seconds = 0;
    double length = 0;
    std::uint64_t count = 0;
};

Lines lines_by_clipper(const Layer& layer) {
    constexpr double unit = 0x1p-30;
    const CosSin turn = cos_sin_degrees(degrees);
    const auto on_grid = [&](double x, double y) {
        return ClipperLib::IntPoint(std::llround(x / unit), std::llround(y / unit));
    };
    const auto begin = Clock::now();
    double low = 1e300;
    double high = -1e300;
    double reach = 0;
    for (const Point2& p : layer.points) {
        const double v = p.y * turn.cos - p.x * turn.sin;
        low = std::min(low, v);
        high = std::max(high, v);
        reach = std::max(reach, std::hypot(p.x, p.y));
    }
    ClipperLib::Clipper clipper;
    for (double k = std::ceil(low / distance_mm); k * distance_mm < high; ++k) {
        const double v = k * distance_mm;
        clipper.AddPath({on_grid(-reach * turn.cos - v * turn.sin, -reach * turn.sin + v * turn.cos),
                         on_grid(reach * turn.cos - v * turn.sin, reach * turn.sin + v * turn.cos)},
                        ClipperLib::ptSubject, false);
    }
    for (std::size_t i = 0; i < layer.rings; ++i) {
        ClipperLib::Path path;
        for (const Point2& p : layer.contour(i))
            path.push_back(on_grid(p.x, p.y));
        clipper.AddPath(path, ClipperLib::ptClip, true);
    }
    ClipperLib::PolyTree tree;
    clipper.Execute(ClipperLib::ctIntersection, tree, ClipperLib::pftPositive, ClipperLib::pftPositive);
    ClipperLib::Paths found;
    ClipperLib::OpenPathsFromPolyTree(tree, found);
    Lines lines{.seconds = seconds_since(begin)};
    for (const ClipperLib::Path& path : found)
        for (std::size_t i = 1; i < path.size(); ++i) {
            lines.length += unit * std::hypot(static_cast<double>(path[i].X - path[i - 1].X),
                                              static_cast<double>(path[i].Y - path[i - 1].Y));
            ++lines.count;
        }
    return lines;
}

/// Results on one thread.
struct Hatched {
    double seconds = 0;
    double clipper_seconds = 0; ///< for a few layers
    double same_layers_seconds = 0;
    std::uint64_t vectors = 0;
    bool right = true;
};

Hatched hatch_layers(const Part& part, HatchPattern pattern, bool compare) {
    const OpenedPart opened = open_part(part, {.threads = 1});
    const LayerStack layers = slice(opened.mesh, opened.plan, {.execution = {.threads = 1}});
    const ScanStrategy strategy = lines_only(pattern);
    Hatched result;
    const std::size_t step = std::max<std::size_t>(1, layers.size() / 5);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const auto begin = Clock::now();
        const Plane vectors = scan(layers[i], {}, {}, strategy).vectors;
        const double seconds = seconds_since(begin);
        result.seconds += seconds;
        result.vectors += vectors.hatches.front().size() / 2;
        const bool crossed = pattern == HatchPattern::chessboard || pattern == HatchPattern::hexagons;
        if (!crossed && i % step == step / 2) {
            const Plane plain = scan(layers[i], {}, {}, lines_only(HatchPattern::lines)).vectors;
            result.right =
                result.right && std::abs(length_of(vectors) - length_of(plain)) <= 1e-9 * length_of(plain);
        }
        if (compare && i % step == step / 2) {
            const Lines others = lines_by_clipper(layers[i]);
            result.clipper_seconds += others.seconds;
            result.same_layers_seconds += seconds;
            result.right =
                result.right && std::abs(others.length - length_of(vectors)) <= 1e-6 * others.length;
        }
    }
    return result;
}

/// Steps of a part, on one thread.
struct Job {
    double slice = 0;
    double scan = 0;
    std::uint64_t vectors = 0;
};

Job whole_job(const Part& part, const ScanStrategy& strategy) {
    const OpenedPart opened = open_part(part, {.threads = 1});
    Job job;
    const auto slicing = Clock::now();
    const LayerStack sliced = slice(opened.mesh, opened.plan, {.execution = {.threads = 1}});
    job.slice = seconds_since(slicing);
    const auto scanning = Clock::now();
    std::vector<ScanLayer> layers(sliced.begin(), sliced.end());
    for (std::size_t i = 1; i < layers.size(); ++i)
        layers[i].share_points(layers[i - 1]);
    const std::vector<ScanLayer> reversed(layers.rbegin(), layers.rend());
    InsetCache memory;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const std::size_t below = std::min<std::size_t>(i, strategy.downskin.layers);
        const std::size_t above = std::min<std::size_t>(layers.size() - 1 - i, strategy.upskin.layers);
        const Plane vectors = scan(layers[i], std::span(reversed).subspan(layers.size() - i, below),
                                   std::span(layers).subspan(i + 1, above), strategy, {.cache = &memory})
                                  .vectors;
        for (std::size_t e = 0; e < vectors.parts(); ++e)
            job.vectors += vectors.polylines[e].points.size() + vectors.hatches[e].size() / 2;
    }
    job.scan = seconds_since(scanning);
    return job;
}

/// Costs of a job from an STL file to a file of vectors, and of copying that file; on one thread.
struct FileCost {
    Cost job;
    Cost copy;
    double megabytes = 0;
};

FileCost file_of(const Part& part, const ScanStrategy& strategy, const std::string& path) {
    FileJob job;
    job.inputs = {{.path = part.path}};
    job.output = path;
    job.layering.cut = UniformLayers{.layer_height = part.layer_height};
    job.scan = strategy;
    FileCost cost;
    FileResult result;
    cost.job = cost_of([&] { result = slice_file(job, {.threads = 1}); });
    cost.copy = cost_of_copying(path);
    cost.megabytes = static_cast<double>(result.bytes) / 1e6;
    return cost;
}

bool is_right(const Part& part, const ScanStrategy& strategy, const std::string& path) {
    const LayerFile file = read_layers(path);
    VerifyOptions options;
    options.mesh = open_part(part, {}).mesh;
    options.rounding = file.rounding;
    options.strategy = strategy;
    return verify_vectors(file, options).ok();
}

int report(int argc, char** argv) {
    const Options options(argc, argv, "scan [--rounds 3]");
    const int rounds = options.rounds();
    std::cout << machine() << "; medians of " << rounds << " rounds, one thread\n\n";
    std::vector<Part> parts = standard_parts();
    std::erase_if(parts, [](const Part& part) { return part.name.starts_with("sheet 1225"); });
    parts.push_back(make_part("sheet 225", 0.1, [] { return make_sheet({.holes = 225}); }));

    bool all_right = true;
    Table rates({"part", "pattern", "Mvectors", "seconds", "Mvectors/s", "Clipper / ours", "checked"});
    for (const Part& part : parts)
        for (const HatchPattern pattern : {HatchPattern::lines, HatchPattern::meander, HatchPattern::stripes,
                                           HatchPattern::chessboard, HatchPattern::hexagons}) {
            std::vector<double> seconds;
            Hatched last;
            bool right = true;
            for (int round = 0; round < rounds; ++round) {
                const bool compare = pattern == HatchPattern::lines && round == 0;
                const Hatched hatched =
                    measure_in_child<Hatched>([&] { return hatch_layers(part, pattern, compare); }).result;
                seconds.push_back(hatched.seconds);
                right = right && hatched.right;
                if (round == 0)
                    last = hatched;
            }
            rates.add({part.name, std::string(hatch_pattern_name(pattern)),
                       fmt::format("{:.3f}", static_cast<double>(last.vectors) / 1e6),
                       fmt::format("{:.3f}", median(seconds)),
                       fmt::format("{:.1f}", static_cast<double>(last.vectors) / median(seconds) / 1e6),
                       last.clipper_seconds == 0
                           ? ""
                           : fmt::format("{:.0f}", last.clipper_seconds / last.same_layers_seconds),
                       right ? "yes" : "WRONG"});
            all_right = all_right && right;
        }
    std::cout << rates.text() << '\n';

    ScanStrategy contours;
    contours.contours.count = 2;
    ScanStrategy skins = contours;
    skins.upskin.layers = skins.downskin.layers = 3;
    Table jobs({"part", "slice s", "contours and stripes / slice", "and skins / slice", "skins / slice",
                "Mvectors"});
    for (const Part& part : parts) {
        std::vector<double> slice;
        std::vector<double> plain;
        std::vector<double> full;
        Job last;
        for (int round = 0; round < rounds; ++round) {
            last = measure_in_child<Job>([&] { return whole_job(part, contours); }).result;
            slice.push_back(last.slice);
            plain.push_back(last.scan);
            last = measure_in_child<Job>([&] { return whole_job(part, skins); }).result;
            slice.push_back(last.slice);
            full.push_back(last.scan);
        }
        const double unit = median(slice);
        jobs.add({part.name, fmt::format("{:.4f}", unit), fmt::format("{:.1f}", median(plain) / unit),
                  fmt::format("{:.1f}", median(full) / unit),
                  fmt::format("{:.1f}", (median(full) - median(plain)) / unit),
                  fmt::format("{:.2f}", static_cast<double>(last.vectors) / 1e6)});
    }
    std::cout << jobs.text() << '\n';

    Table files(
        {"part, with skins, to binary cli", "MB", "job CPU s", "copy CPU s", "job / copy", "checked"});
    const std::string path = (std::filesystem::temp_directory_path() / "lamella_bench_scan.cli").string();
    for (const Part& part : parts) {
        std::vector<Cost> job;
        std::vector<Cost> copy;
        FileCost last;
        for (int round = 0; round < rounds; ++round) {
            std::filesystem::remove(path);
            last = measure_in_child<FileCost>([&] { return file_of(part, skins, path); }).result;
            job.push_back(last.job);
            copy.push_back(last.copy);
        }
        const bool right = is_right(part, skins, path);
        all_right = all_right && right;
        files.add({part.name, fmt::format("{:.1f}", last.megabytes), fmt::format("{:.3f}", least(job).cpu_s),
                   fmt::format("{:.3f}", least(copy).cpu_s),
                   fmt::format("{:.1f}", least(job).cpu_s / least(copy).cpu_s), right ? "yes" : "WRONG"});
    }
    std::filesystem::remove(path);
    std::cout << files.text();
    return all_right ? 0 : 1;
}

} // namespace

} // namespace lamella::bench

int main(int argc, char** argv) {
    return lamella::bench::report(argc, argv);
}
