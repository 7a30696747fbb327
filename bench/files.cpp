// What does a file cost? From STL file to slice file while slicing goes on, against slicing into memory and
// against copying the finished file; and the peak memory of each. The files are read back and checked.
//
//     files [--rounds 5] [--threads 2]

#include "experiment.hpp"
#include "parts.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <string_view>
#include <thread>

namespace lamella::bench {

namespace {

double into_file(const Part& part, const LayerFormat& format, const std::string& path, unsigned threads) {
    const auto start = Clock::now();
    const Execution execution{.threads = threads};
    const OpenedPart opened = open_part(part, execution);
    const auto writer = open_layer_writer(path, format,
                                          {.box = opened.box,
                                           .layers = opened.plan.layers.size(),
                                           .bottom = opened.plan.layers.front().bottom});
    slice_to([&](Layer&& layer) { return writer->prepare(layer); }, opened.mesh, opened.plan, execution);
    writer->finish();
    return seconds_since(start);
}

/// A copy as a program makes it that has the bytes in memory already.
double copy_of(const std::string& path) {
    const int from = open(path.c_str(), O_RDONLY);
    struct stat status {};
    fstat(from, &status);
    const auto bytes = static_cast<std::size_t>(status.st_size);
    auto* data = static_cast<char*>(mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE | MAP_POPULATE, from, 0));
    const std::string copy = path + ".copy";
    const auto start = Clock::now();
    const int to = open(copy.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    for (std::size_t done = 0; done < bytes;) {
        const ssize_t n = write(to, data + done, std::min<std::size_t>(bytes - done, std::size_t{1} << 22));
        if (n <= 0)
            throw std::runtime_error("the copy failed");
        done += static_cast<std::size_t>(n);
    }
    close(to);
    const double seconds = seconds_since(start);
    std::filesystem::remove(copy);
    return seconds;
}

/// Whether the file, read back, has the layers of the part: as many, closed, of the right area at its
/// resolution.
bool right(const Part& part, const std::string& path) {
    const OpenedPart opened = open_part(part, {});
    const LayerStack back = read_layers(path).merged();
    const std::vector<double> areas = section_areas(opened.mesh, opened.plan);
    if (back.size() != areas.size())
        return false;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        const LayerMeasure found = measure(back[i]);
        const double moved = 0.001; // no format here moves a point by more, in mm
        if (found.open_chains != 0 || std::abs(found.area_mm2 - areas[i]) > moved * found.perimeter_mm)
            return false;
    }
    return true;
}

int report(int argc, char** argv) {
    const int rounds = std::stoi(option(argc, argv, "--rounds", "5"));
    const auto threads = static_cast<unsigned>(
        std::stoul(option(argc, argv, "--threads", std::to_string(std::thread::hardware_concurrency()))));
    std::cout << machine() << "; medians of " << rounds << " rounds, " << threads << " threads\n\n";

    Table table({"part", "format", "file MB", "into memory s", "into file s", "copying the file s",
                 "added / copying", "peak MB", "checked"});
    bool all_right = true;
    for (const Part& part : standard_parts()) {
        for (const char* name :
             {"cli", "cli-ascii", "svg", "slc", "json", "npz", "3mf", "dxf", "geojson", "wkt"}) {
            const LayerFormat& format = layer_format(name, "");
            const std::string path = part.path + "." + name;
            std::vector<double> memory;
            std::vector<double> file;
            std::vector<double> copy;
            std::vector<double> added;
            std::uint64_t peak = 0;
            for (int round = 0; round < rounds; ++round) {
                memory.push_back(
                    measure_in_child<double>([&] { return seconds_into_memory(part, threads); }).result);
                std::filesystem::remove(path); // to free the last one's blocks is no part of writing the next
                const auto run =
                    measure_in_child<double>([&] { return into_file(part, format, path, threads); });
                file.push_back(run.result);
                peak = std::max(peak, run.peak_bytes);
                copy.push_back(measure_in_child<double>([&] { return copy_of(path); }).result);
                added.push_back(file.back() - memory.back());
            }
            // The others are read by programs that are not ours (tests/agreement/foreign_readers_test.py).
            constexpr std::array<std::string_view, 6> read_back{"cli", "cli-ascii", "svg",
                                                                "slc", "json",      "npz"};
            const bool checked = std::find(read_back.begin(), read_back.end(), name) != read_back.end();
            const bool is_right =
                !checked || measure_in_child<bool>([&] { return right(part, path); }).result;
            all_right = all_right && is_right;
            table.add({part.name, name,
                       fmt::format("{:.1f}", static_cast<double>(std::filesystem::file_size(path)) / 1e6),
                       fmt::format("{:.4f}", median(memory)), fmt::format("{:.4f}", median(file)),
                       fmt::format("{:.4f}", median(copy)),
                       fmt::format("{:.2f}", median(added) / median(copy)),
                       fmt::format("{:.0f}", static_cast<double>(peak) / 1e6),
                       !is_right ? "WRONG"
                       : checked ? "yes"
                                 : "elsewhere"});
            std::filesystem::remove(path);
        }
    }
    std::cout << table.text();
    return all_right ? 0 : 1;
}

} // namespace

} // namespace lamella::bench

int main(int argc, char** argv) {
    return lamella::bench::report(argc, argv);
}
