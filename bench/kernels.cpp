// Benchmarks of single kernels (Google Benchmark): read, rank, weld, link, walk, run, format.

#include "core/executor.hpp"
#include "parts/shapes.hpp"
#include "slicing/ranks.hpp"
#include "slicing/sweep/cut_graph.hpp"
#include "slicing/sweep/point_kernels.hpp"
#include "system/byte_source.hpp"

#include <benchmark/benchmark.h>
#include <lamella/formats.hpp>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace lamella {

namespace {

Plan planes_of(const TriangleSoup& soup, double count) {
    const Box3 box = bounding_box(soup);
    return plan_uniform(box.min.z, box.max.z, {.layer_height = (box.max.z - box.min.z) / count});
}

const TriangleSoup& torus() {
    static const TriangleSoup soup = make_torus(50, 20, 700, 350); // 490,000 triangles
    return soup;
}

const TriangleSoup& sheet() {
    static const TriangleSoup soup = make_sheet({.holes = 225});
    return soup;
}

Execution on(const benchmark::State& state) {
    return {.threads = static_cast<unsigned>(state.range(0))};
}

/// Copies the bytes of an STL file into memory, as text formats are read. The pages are in the system's
/// cache.
void read_file(benchmark::State& state) {
    const std::string path = std::filesystem::temp_directory_path() / "lamella-kernels.stl";
    write_stl(path, torus());
    for ([[maybe_unused]] const auto _ : state) {
        const ByteSource source = open_bytes(path, on(state));
        benchmark::DoNotOptimize(source.bytes.data());
    }
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(std::filesystem::file_size(path)));
    std::filesystem::remove(path);
}
BENCHMARK(read_file)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void rank(benchmark::State& state) {
    const Ranks ranks(planes_of(torus(), static_cast<double>(state.range(0))));
    std::vector<double> heights;
    for (std::size_t i = 0; i < torus().size(); ++i)
        for (const Point3& corner : torus().placed(i))
            heights.push_back(corner.z);
    for ([[maybe_unused]] const auto _ : state) {
        std::uint64_t sum = 0;
        for (const double z : heights)
            sum += ranks(z);
        benchmark::DoNotOptimize(sum);
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(heights.size()));
}
BENCHMARK(rank)->Arg(30)->Arg(3000)->ArgName("planes")->Unit(benchmark::kMillisecond);

void weld_corners(benchmark::State& state) {
    for ([[maybe_unused]] const auto _ : state)
        benchmark::DoNotOptimize(weld(torus(), on(state)).vertices.data());
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(3 * torus().size()));
}
BENCHMARK(weld_corners)->Arg(1)->Arg(2)->ArgName("threads")->Unit(benchmark::kMillisecond)->UseRealTime();

void link_triangles(benchmark::State& state) {
    const Execution execution = on(state);
    const Ranks ranks(planes_of(torus(), 400));
    for ([[maybe_unused]] const auto _ : state) {
        Executor executor(execution);
        ProgressMeter progress(execution, Stage::link, torus().size());
        benchmark::DoNotOptimize(build_cut_graph(torus(), ranks, executor, progress).count);
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(torus().size()));
}
BENCHMARK(link_triangles)->Arg(1)->Arg(2)->ArgName("threads")->Unit(benchmark::kMillisecond)->UseRealTime();

void prepare_sections(benchmark::State& state) {
    for ([[maybe_unused]] const auto _ : state)
        benchmark::DoNotOptimize(
            Slicer(torus(), PlaneRule::section_above, on(state)).section(0).points.data());
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(torus().size()));
}
BENCHMARK(prepare_sections)->Arg(1)->Arg(2)->ArgName("threads")->Unit(benchmark::kMillisecond)->UseRealTime();

/// Planes that climb through the part, and turn if `tilted`.
void cut_sections(benchmark::State& state, bool tilted) {
    static const Slicer slicer(torus());
    const Box3 box = bounding_box(torus());
    std::int64_t points = 0;
    double share = 0;
    for ([[maybe_unused]] const auto _ : state) {
        share = std::fmod(share + 0.381966, 1.0);
        const double z = box.min.z + share * (box.max.z - box.min.z);
        const Layer layer =
            tilted ? slicer.section({0, 0, z}, {share, 1 - share, 0.5}).layer : slicer.section(z);
        points += static_cast<std::int64_t>(layer.points.size());
    }
    state.SetItemsProcessed(points);
}
BENCHMARK_CAPTURE(cut_sections, level, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(cut_sections, tilted, true)->Unit(benchmark::kMicrosecond);

/// Time of the sweep without linking.
void sweep(benchmark::State& state, const TriangleSoup& soup, double planes) {
    const Plan plan = planes_of(soup, planes);
    const Execution execution = on(state);
    SliceReport report;
    for ([[maybe_unused]] const auto _ : state) {
        LayerStack layers;
        layers.reserve(plan.layers.size());
        report = slice_to(appending_to(layers), soup, plan, {.execution = execution, .points_in_flight = 0});
        state.SetIterationTime(report.slice_seconds);
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(report.points));
}

/// Facets about as high as a layer: nearly every contour is walked on every plane.
void walk(benchmark::State& state) {
    sweep(state, torus(), 350);
}
BENCHMARK(walk)->Arg(1)->Arg(2)->ArgName("threads")->Unit(benchmark::kMillisecond)->UseManualTime();

/// Walls: one walk serves all planes.
void run(benchmark::State& state) {
    sweep(state, sheet(), 60);
}
BENCHMARK(run)->Arg(1)->Arg(2)->ArgName("threads")->Unit(benchmark::kMillisecond)->UseManualTime();

void points(benchmark::State& state, const PointKernels& kernels) {
    const std::size_t n = 1024;
    std::vector<double> memory(EdgeColumns::columns * n + EdgeColumns::lanes, 0.5);
    void* start = memory.data();
    std::size_t space = memory.size() * sizeof(double);
    const EdgeColumns edges{
        static_cast<double*>(std::align(64, EdgeColumns::columns * n * sizeof(double), start, space)), n};
    std::vector<Point2> to(n);
    for ([[maybe_unused]] const auto _ : state) {
        kernels.cut(edges, 0, n, 0.75, to.data());
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n));
}
BENCHMARK_CAPTURE(points, widest, point_kernels());
BENCHMARK_CAPTURE(points, plain, *point_kernel_sets().front().kernels);

void format_layers(benchmark::State& state, const char* name) {
    const Plan plan = planes_of(sheet(), 10);
    const LayerStack layers = slice(sheet(), plan);
    std::uint64_t bytes = 0;
    for ([[maybe_unused]] const auto _ : state) {
        const auto writer = open_layer_writer(
            "/dev/null", layer_format(name, ""),
            {.box = bounding_box(sheet()), .layers = layers.size(), .bottom = layers.front().bottom});
        for (const Layer& layer : layers)
            writer->prepare(layer)();
        bytes += writer->bytes();
        writer->finish();
    }
    state.SetBytesProcessed(static_cast<std::int64_t>(bytes));
}
BENCHMARK_CAPTURE(format_layers, cli, "cli")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(format_layers, cli_ascii, "cli-ascii")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(format_layers, svg, "svg")->Unit(benchmark::kMillisecond);

} // namespace

} // namespace lamella
