// Measures the slicing time as a multiple of the lower bound, which is reading the bytes of the file and
// writing the points of the result to fresh memory. Both are timed alternately in one run, each in its own
// process, and the result is checked.

#include "experiment.hpp"
#include "parts.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

namespace lamella::bench {

namespace {

void on_threads(unsigned threads, const std::function<void(unsigned)>& body) {
    std::vector<std::thread> team;
    for (unsigned t = 1; t < threads; ++t)
        team.emplace_back(body, t);
    body(0);
    for (std::thread& thread : team)
        thread.join();
}

/// Returns the sum of a file's words in a range of bytes. Reads chunks into memory that stays in the cache,
/// because touching the pages of a mapped file takes longer.
std::uint64_t sum_of_words(int file, std::size_t begin, std::size_t end) {
    std::vector<std::uint64_t> piece(std::size_t{1} << 15);
    std::uint64_t sum = 0;
    while (begin < end) {
        const ssize_t got =
            pread(file, piece.data(), std::min(8 * piece.size(), end - begin), static_cast<off_t>(begin));
        if (got <= 0)
            throw std::runtime_error("the file cannot be read");
        const auto bytes = static_cast<std::size_t>(got);
        sum = std::accumulate(piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(bytes / 8), sum);
        begin += bytes;
    }
    return sum;
}

/// Reads every byte of the file and writes `points` points in the fastest way that this machine offers to a
/// program: reading into a small buffer, memory in large pages.
double limit_seconds(const std::string& path, std::uint64_t points, unsigned threads) {
    const auto start = Clock::now();
    const int file = open(path.c_str(), O_RDONLY);
    struct stat status {};
    fstat(file, &status);
    const auto bytes = static_cast<std::size_t>(status.st_size);
    std::vector<std::uint64_t> sums(threads);
    on_threads(threads, [&](unsigned t) {
        sums[t] = sum_of_words(file, bytes / 8 * t / threads * 8, bytes / 8 * (t + 1) / threads * 8);
    });
    close(file);

    constexpr std::size_t huge = std::size_t{2} << 20;
    const std::size_t size = (points * sizeof(Point2) + huge) / huge * huge;
    auto* memory = static_cast<char*>(mmap(nullptr, size + huge, PROT_READ | PROT_WRITE,
                                           MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0));
    memory += huge - reinterpret_cast<std::uintptr_t>(memory) % huge;
    madvise(memory, size, MADV_HUGEPAGE);
    auto* target = reinterpret_cast<Point2*>(memory);
    on_threads(threads, [&](unsigned t) {
        const Point2 value{static_cast<double>(sums[t]), 1};
        std::fill(target + points * t / threads, target + points * (t + 1) / threads, value);
    });
    return seconds_since(start);
}

struct Run {
    double read, link, slice, total;
    double weld;
    std::uint64_t triangles, points, hash;
    double worst_area_error; // relative to the largest area
    std::uint64_t open_chains;
};

Run run_lamella(const Part& part, unsigned threads, bool weld_too) {
    Run run{};
    const Execution execution{.threads = threads};
    auto start = Clock::now();
    const Mesh mesh = read_mesh(part.path, {}, execution).mesh();
    const Box3 box = bounding_box(mesh, execution);
    run.read = seconds_since(start);
    const Plan plan = plan_uniform(box.min.z, box.max.z, {.layer_height = part.layer_height});
    LayerStack layers;
    layers.reserve(plan.layers.size());
    const SliceReport report =
        slice_to(appending_to(layers), mesh, plan, {.execution = execution, .points_in_flight = 0});
    run.total = seconds_since(start);
    run.link = report.link_seconds;
    run.slice = report.slice_seconds;
    run.triangles = mesh.size();
    run.points = report.points;
    run.open_chains = report.open_chains;

    if (weld_too) {
        start = Clock::now();
        const IndexedMesh welded = weld(mesh, execution);
        run.weld = seconds_since(start);
        if (welded.triangles.size() != mesh.size())
            throw std::runtime_error("the weld lost triangles");
    }

    const std::vector<double> areas = section_areas(mesh, plan, execution);
    double largest = 0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        run.hash = run.hash * 0x9E3779B97F4A7C15 + content_hash(layers[i]);
        largest = std::max(largest, std::abs(areas[i]));
        run.worst_area_error =
            std::max(run.worst_area_error, std::abs(measure(layers[i]).area_mm2 - areas[i]));
    }
    run.worst_area_error /= largest;
    return run;
}

/// Times of a part for one number of threads. Other load on the machine only adds time, sometimes as much as
/// the program takes, so times are the minimum of several repetitions. The machine's speed also changes for
/// seconds, so ratios are the median of ratios whose two times were measured together.
class Timings {
  public:
    explicit Timings(unsigned thread_count) : threads(thread_count) {}

    /// Measures once more. Returns whether the layers are right and have this hash, unless it is 0.
    bool measure(const Part& part, std::uint64_t& hash) {
        runs_.push_back(measure_in_child<Run>([&] { return run_lamella(part, threads, true); }).result);
        const Run& run = runs_.back();
        limits_.push_back(
            measure_in_child<double>([&] { return limit_seconds(part.path, run.points, threads); }).result);
        if (hash == 0)
            hash = run.hash;
        if (run.hash == hash && run.open_chains == 0 && run.worst_area_error < 1e-9)
            return true;
        std::cout << fmt::format(
            "WRONG: {} on {} threads: hash {:016x} against {:016x}, {} open chains, area "
            "error {:g}\n",
            part.name, threads, run.hash, hash, run.open_chains, run.worst_area_error);
        return false;
    }

    [[nodiscard]] const Run& any() const { return runs_.front(); }
    [[nodiscard]] double limit() const { return *std::min_element(limits_.begin(), limits_.end()); }
    [[nodiscard]] double least(double Run::*stage) const {
        const auto less = [&](const Run& a, const Run& b) {
            return a.*stage < b.*stage;
        };
        return (*std::min_element(runs_.begin(), runs_.end(), less)).*stage;
    }
    /// Returns the total as a multiple of the lower bound.
    [[nodiscard]] double ratio() const {
        return median_ratio([this](std::size_t i) { return runs_[i].total; },
                            [this](std::size_t i) { return limits_[i]; });
    }
    /// Returns the time of a stage as a multiple of its time in `there`, which must have as many repetitions.
    [[nodiscard]] double against(const Timings& there, double Run::*stage) const {
        return median_ratio([&](std::size_t i) { return runs_[i].*stage; },
                            [&](std::size_t i) { return there.runs_[i].*stage; });
    }
    [[nodiscard]] double limit_against(const Timings& there) const {
        return median_ratio([&](std::size_t i) { return limits_[i]; },
                            [&](std::size_t i) { return there.limits_[i]; });
    }

    unsigned threads;

  private:
    template <class Over, class Under>
    [[nodiscard]] double median_ratio(const Over& over, const Under& under) const {
        std::vector<double> ratios;
        for (std::size_t round = 0; round < runs_.size(); ++round)
            ratios.push_back(over(round) / under(round));
        return median(ratios);
    }

    std::vector<Run> runs_;
    std::vector<double> limits_;
};

/// Returns the peak memory of slicing without the checks.
std::uint64_t peak_of_slicing(const Part& part, unsigned threads) {
    return measure_in_child<std::uint64_t>([&] {
               const Execution execution{.threads = threads};
               const Mesh mesh = read_mesh(part.path, {}, execution).mesh();
               const Box3 box = bounding_box(mesh, execution);
               const Plan plan = plan_uniform(box.min.z, box.max.z, {.layer_height = part.layer_height});
               return std::uint64_t{slice(mesh, plan, {.execution = execution}).size()};
           })
        .peak_bytes;
}

int report(int argc, char** argv) {
    const Options options(argc, argv,
                          "limit [--parts sheet-1225,sheet-1225-shuffled,sheet-100-on-edge,rook,lattice] "
                          "[--rounds 7] [--threads 0]");
    const int rounds = options.rounds();
    const unsigned threads = options.threads();
    std::cout << machine() << "; least times and median ratios of " << rounds << " rounds\n\n";

    Table table({"part", "triangles", "points", "threads", "limit s", "total s", "ratio", "read",
                 "ranks+graph", "sweep", "weld", "bytes/point", "peak MB"});
    Table scaling({"part", "limit", "ranks+graph", "sweep", "weld", "total"});
    bool right = true;
    std::uint64_t sheet_hash = 0;
    double sheet_total = 0;
    for (const Part& part : chosen_parts(options)) {
        std::uint64_t hash = 0;
        std::vector<Timings> timings{Timings(1)};
        if (threads > 1)
            timings.emplace_back(threads);
        for (int round = 0; round < rounds; ++round)
            for (Timings& timing : timings)
                right = timing.measure(part, hash) && right;

        for (const Timings& timing : timings) {
            const Run& run = timing.any();
            const std::uint64_t peak = peak_of_slicing(part, timing.threads);
            const auto seconds = [&](double Run::*stage) {
                return fmt::format("{:.4f}", timing.least(stage));
            };
            table.add({part.name, fmt::format("{}", run.triangles), fmt::format("{}", run.points),
                       fmt::format("{}", timing.threads), fmt::format("{:.4f}", timing.limit()),
                       seconds(&Run::total), fmt::format("{:.2f}", timing.ratio()), seconds(&Run::read),
                       seconds(&Run::link), seconds(&Run::slice), seconds(&Run::weld),
                       fmt::format("{:.1f}", static_cast<double>(peak) / static_cast<double>(run.points)),
                       fmt::format("{:.0f}", static_cast<double>(peak) / 1e6)});
        }
        const Timings& last = timings.back();
        if (threads > 1) {
            const Timings& alone = timings.front();
            const auto speed_up = [&](double Run::*stage) {
                return fmt::format("{:.2f}", alone.against(last, stage));
            };
            scaling.add({part.name, fmt::format("{:.2f}", alone.limit_against(last)), speed_up(&Run::link),
                         speed_up(&Run::slice), speed_up(&Run::weld), speed_up(&Run::total)});
        }
        if (part.name == "sheet 1225") {
            sheet_hash = hash;
            sheet_total = last.least(&Run::total);
        } else if (part.name == "sheet 1225 shuffled" && sheet_hash != 0) {
            std::cout << fmt::format(
                "shuffled against in order, {} threads: {:.2f} times the least time, {}\n", last.threads,
                last.least(&Run::total) / sheet_total,
                hash == sheet_hash ? "the same bytes" : "WRONG: other layers");
            right = right && hash == sheet_hash;
        }
    }
    std::cout << "\n" << table.text();
    if (threads > 1)
        std::cout << "\nSpeed-up of " << threads << " threads over one:\n\n" << scaling.text();
    std::cout << "\n"
              << (right ? "All results checked: closed, areas as computed from the triangles, equal hashes.\n"
                        : "SOME RESULTS ARE WRONG.\n");
    return right ? 0 : 1;
}

} // namespace

} // namespace lamella::bench

int main(int argc, char** argv) {
    return lamella::bench::report(argc, argv);
}
