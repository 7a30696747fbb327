// Measures the cost of writing files: writing layers that are in memory, with one thread, against copying the
// finished file; and slicing an STL file into a slice file, with peak memory, against slicing into memory.
// The files are read back and checked.
//
// Each row is measured a given number of times, or as often as the seconds allow.

#include "experiment.hpp"
#include "parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string_view>

namespace lamella::bench {

namespace {

std::unique_ptr<LayerWriter> open_writer(const OpenedPart& opened, const LayerFormat& format,
                                         const std::string& path) {
    return open_layer_writer(path, format,
                             {.box = opened.box,
                              .layers = opened.plan.layers.size(),
                              .bottom = opened.plan.layers.front().bottom});
}

/// Cost of a file, and the part of it that is done in order and at the end, by one thread at a time.
struct FileCost {
    Cost all;
    double one_thread_s = 0;
};

/// Slices the STL file into a file, on all threads.
FileCost into_file(const Part& part, const LayerFormat& format, const std::string& path) {
    double one_thread_s = 0;
    const auto timed = [&](const auto& work) {
        const auto start = std::chrono::steady_clock::now();
        work();
        one_thread_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const Cost all = cost_of([&] {
        const OpenedPart opened = open_part(part, {});
        const auto writer = open_writer(opened, format, path);
        slice_to({.prepare = [&](Layer&& layer) -> Commit {
                     return [&, commit = writer->prepare(layer)](Completions& after) {
                         timed([&] { commit.in_order(after); });
                     };
                 }},
                 opened.mesh, opened.plan);
        timed([&] { writer->finish(); });
    });
    return {all, one_thread_s};
}

struct Steps {
    Cost slicing; ///< into memory, on all threads
    Cost writing; ///< with one thread
    Cost copying;
};

Steps steps_of(const Part& part, const LayerFormat& format, const std::string& path) {
    Steps steps{};
    OpenedPart opened;
    LayerStack layers;
    steps.slicing = cost_of([&] {
        opened = open_part(part, {});
        layers = slice(opened.mesh, opened.plan);
    });
    std::filesystem::remove(path); // freeing the blocks of the old file is not part of writing
    steps.writing = cost_of([&] {
        const auto writer = open_writer(opened, format, path);
        for (const Layer& layer : layers)
            writer->prepare(layer)();
        writer->finish();
    });
    steps.copying = cost_of_copying(path);
    return steps;
}

/// Returns whether the file, read back, has the layers of the part: the same number, closed, with the right
/// area at the file's resolution.
bool right(const Part& part, const std::string& path) {
    const OpenedPart opened = open_part(part, {});
    const LayerStack back = read_layers(path).merged();
    const std::vector<double> areas = section_areas(opened.mesh, opened.plan);
    if (back.size() != areas.size())
        return false;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        const LayerMeasure found = measure(back[i]);
        const double moved = 0.001; // mm; an upper bound for all formats here
        if (found.open_chains != 0 || std::abs(found.area_mm2 - areas[i]) > moved * found.perimeter_mm)
            return false;
    }
    return true;
}

struct Costs {
    std::vector<Cost> slicing, writing, copying, file;
    double one_thread_part = 1; ///< of the processor time of a job, least of all rounds
    std::uint64_t peak_bytes = 0;

    void add(const Steps& steps) {
        slicing.push_back(steps.slicing);
        writing.push_back(steps.writing);
        copying.push_back(steps.copying);
    }
};

std::string seconds(double s) {
    return fmt::format("{:.4f}", s);
}

int report(int argc, char** argv) {
    const Options options(
        argc, argv,
        "files [--parts sheet-1225,sheet-1225-shuffled,sheet-100-on-edge,rook,lattice] "
        "[--formats cli,cli-ascii,svg,slc,json,npz,3mf,ilt,ovf,dxf,geojson] [--rounds 3] [--seconds 20]");
    const int rounds = options.rounds();
    const double limit = options.number("--seconds");
    const std::vector<std::string> formats = options.list("--formats");
    std::cout << machine() << "; least of " << rounds << " rounds\n\n";

    bool all_right = true;
    for (const Part& part : chosen_parts(options)) {
        Table table({part.name, "file MB", "slicing s", "into file s", "one thread", "peak MB",
                     "writing CPU s", "MB/s a core", "copying CPU s", "writing / copying", "checked"});
        for (const std::string& name : formats) {
            const LayerFormat& format = layer_format(name, "");
            const std::string path = part.path + "." + name;
            Costs costs;
            repeat(rounds, limit, [&] {
                costs.add(measure_in_child<Steps>([&] { return steps_of(part, format, path); }).result);
                std::filesystem::remove(path);
                const auto run = measure_in_child<FileCost>([&] { return into_file(part, format, path); });
                costs.file.push_back(run.result.all);
                costs.one_thread_part =
                    std::min(costs.one_thread_part, run.result.one_thread_s / run.result.all.cpu_s);
                costs.peak_bytes = std::max(costs.peak_bytes, run.peak_bytes);
            });
            // Foreign programs read the other formats (tests/agreement/foreign_readers_test.py).
            constexpr std::array<std::string_view, 6> read_back{"cli", "cli-ascii", "svg",
                                                                "slc", "json",      "npz"};
            const bool checked = std::find(read_back.begin(), read_back.end(), name) != read_back.end();
            const bool is_right =
                !checked || measure_in_child<bool>([&] { return right(part, path); }).result;
            all_right = all_right && is_right;
            const double megabytes = static_cast<double>(std::filesystem::file_size(path)) / 1e6;
            const double writing = least(costs.writing).cpu_s;
            const double copying = least(costs.copying).cpu_s;
            table.add({name, fmt::format("{:.1f}", megabytes), seconds(least(costs.slicing).wall_s),
                       seconds(least(costs.file).wall_s), fmt::format("{:.1f}%", 100 * costs.one_thread_part),
                       fmt::format("{:.0f}", static_cast<double>(costs.peak_bytes) / 1e6), seconds(writing),
                       fmt::format("{:.0f}", megabytes / writing), seconds(copying),
                       fmt::format("{:.2f}", writing / copying),
                       !is_right ? "WRONG"
                       : checked ? "yes"
                                 : "elsewhere"});
            std::filesystem::remove(path);
        }
        std::cout << table.text() << std::endl;
    }
    return all_right ? 0 : 1;
}

} // namespace

} // namespace lamella::bench

int main(int argc, char** argv) {
    return lamella::bench::report(argc, argv);
}
