// Measures whether time per triangle and point, and memory, stay constant from 10^4 to 10^7 triangles and
// from 30 to 3,000 planes. Layers are discarded as soon as they are finished.

#include "experiment.hpp"
#include "parts.hpp"
#include "parts/shapes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <iostream>
#include <vector>

namespace lamella::bench {

namespace {

struct Run {
    double seconds;
    std::uint64_t triangles, points, open_chains;
    double worst_area_error;
};

/// Slices a soup in memory and checks the layers.
Run slice_soup(const TriangleSoup& soup, unsigned planes, unsigned threads) {
    const Execution execution{.threads = threads};
    const Box3 box = bounding_box(soup, execution);
    const Plan plan = plan_uniform(box.min.z, box.max.z,
                                   {.layer_height = (box.max.z - box.min.z) / static_cast<double>(planes)});
    std::vector<double> found(plan.layers.size());
    const LayerSink sink{.prepare = [&](Layer&& layer) -> Commit {
        found[layer.index] = measure(layer).area_mm2;
        return {};
    }};
    const auto start = Clock::now();
    const SliceReport report = slice_to(sink, soup, plan, {.execution = execution});
    Run run{seconds_since(start), soup.size(), report.points, report.open_chains, 0};
    const std::vector<double> areas = section_areas(soup, plan, execution);
    double largest = 0;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        largest = std::max(largest, std::abs(areas[i]));
        run.worst_area_error = std::max(run.worst_area_error, std::abs(found[i] - areas[i]));
    }
    run.worst_area_error /= largest;
    return run;
}

/// Upright pins, and a torus with as many points on a plane as all pins: contours without changes, and one
/// that changes on every plane.
TriangleSoup make_pins_and_torus() {
    constexpr unsigned side = 64;
    const TriangleSoup pin = make_box(1, 1, 100);
    std::vector<Triangle3f> triangles;
    for (unsigned i = 0; i < side * side; ++i) {
        const auto x = static_cast<float>(2 * (i % side));
        const auto y = static_cast<float>(2 * (i / side));
        for (std::size_t k = 0; k < pin.size(); ++k) {
            Triangle3f t = pin.stored(k);
            for (Point3f& p : t)
                p = {p.x + x, p.y + y, p.z};
            triangles.push_back(t);
        }
    }
    const TriangleSoup torus = make_torus(100, 50, 12000, 50);
    for (std::size_t k = 0; k < torus.size(); ++k) {
        Triangle3f t = torus.stored(k);
        for (Point3f& p : t)
            p = {p.x - 200, p.y, p.z + 50};
        triangles.push_back(t);
    }
    return TriangleSoup(triangles);
}

class Report {
  public:
    Report(int rounds, unsigned threads) : rounds_(rounds), threads_(threads) {}

    void add(const std::string& part, const std::function<TriangleSoup()>& make, unsigned planes) {
        std::vector<double> seconds;
        std::vector<double> peaks;
        Run last{};
        for (int round = 0; round < rounds_; ++round) {
            const auto measured = measure_in_child<Run>([&] { return slice_soup(make(), planes, threads_); });
            last = measured.result;
            seconds.push_back(last.seconds);
            peaks.push_back(static_cast<double>(measured.peak_bytes));
            right_ = right_ && last.open_chains == 0 && last.worst_area_error < 1e-9;
        }
        const double work = static_cast<double>(last.triangles + last.points);
        table_.add({part, fmt::format("{}", last.triangles), fmt::format("{}", planes),
                    fmt::format("{}", last.points), fmt::format("{:.5f}", median(seconds)),
                    fmt::format("{:.2f}", median(seconds) / work * 1e9),
                    fmt::format("{:.0f}", median(peaks) / 1e6)});
    }

    int finish() const {
        std::cout << table_.text() << "\n"
                  << (right_ ? "All results checked: closed, areas as computed from the triangles.\n"
                             : "SOME RESULTS ARE WRONG.\n");
        return right_ ? 0 : 1;
    }

  private:
    int rounds_;
    unsigned threads_;
    bool right_ = true;
    Table table_{{"part", "triangles", "planes", "points", "seconds", "ns per triangle + point", "peak MB"}};
};

} // namespace

} // namespace lamella::bench

int main(int argc, char** argv) {
    using namespace lamella;
    using namespace lamella::bench;
    const Options options(argc, argv, "growth [--rounds 5] [--threads 0]");
    const int rounds = options.rounds();
    const unsigned threads = options.threads();
    std::cout << machine() << "; medians of " << rounds << " rounds, " << threads << " threads\n\n";

    Report report(rounds, threads);
    // More triangles: the same torus with smaller facets; the number of planes grows with the number of
    // facets along its height.
    for (const unsigned n : {71U, 224U, 708U, 2237U})
        report.add(
            "torus", [n] { return make_torus(50, 20, n, n); }, std::max(30U, n / 4));
    // More planes: the same lattice with thinner layers.
    for (const unsigned planes : {30U, 100U, 300U, 1000U, 3000U})
        report.add(
            "lattice", [] { return make_lattice({}); }, planes);
    // More planes, worst case: walls that every plane cuts.
    for (const unsigned planes : {30U, 100U, 300U, 1000U, 3000U})
        report.add(
            "sheet 100", [] { return make_sheet({.holes = 100}); }, planes);
    // Contours without changes, and others that change.
    for (const unsigned planes : {100U, 300U, 1000U})
        report.add("pins and torus", make_pins_and_torus, planes);
    return report.finish();
}
