// Measures how jobs gain from cores: the program's commands with one thread and with more, each in a process
// of its own, beside the limits of the machine. All outputs of a job must be equal.
//
// It makes its parts on the spot and needs only the C library, so that it runs on any Linux.

#include "app/commands.hpp"
#include "app/program.hpp"
#include "container/zip_writer.hpp"
#include "experiment.hpp"
#include "parts.hpp"
#include "parts/shapes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <thread>

namespace lamella::bench {

namespace {

/// A command of the program.
struct Job {
    std::string name;
    std::vector<std::string> words;
    std::vector<std::string> inputs; ///< files that it reads, for the limit
    std::string output;              ///< file or folder that it writes; "" if none
};

struct Measurement {
    unsigned threads;
    double wall_s;
    double cpu_s;
    double limit_s; ///< see `limit_of`
    std::uint64_t peak_bytes;
    std::uint64_t hash; ///< of the output
};

/// Replaces each triangle by four, twice, by the midpoints of its edges. Midpoints are the same from both
/// sides.
TriangleSoup subdivided(const TriangleSoup& soup) {
    std::vector<Triangle3f> triangles;
    triangles.reserve(soup.size() * 4);
    const auto middle = [](const Point3f& a, const Point3f& b) -> Point3f {
        return {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2};
    };
    for (std::size_t i = 0; i < soup.size(); ++i) {
        const auto [a, b, c] = soup.stored(i);
        const Point3f ab = middle(a, b);
        const Point3f bc = middle(b, c);
        const Point3f ca = middle(c, a);
        for (const Triangle3f& one : {Triangle3f{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
            triangles.push_back(one);
    }
    return TriangleSoup(std::move(triangles));
}

/// Writes the mesh as a 3MF file unless there is one, and returns its path.
std::string three_mf_of(const Part& part) {
    const std::string path = std::filesystem::path(part.path).replace_extension(".3mf").string();
    if (std::filesystem::exists(path))
        return path;
    const IndexedMesh mesh = weld(read_mesh(part.path).mesh());
    std::string model =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" "
        "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources><object "
        "id=\"1\" type=\"model\"><mesh><vertices>\n";
    for (const Point3& p : mesh.vertices)
        model += fmt::format("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", p.x, p.y, p.z);
    model += "</vertices><triangles>\n";
    for (const auto& [a, b, c] : mesh.triangles)
        model += fmt::format("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", a, b, c);
    model += "</triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>\n";
    ZipWriter zip(path);
    zip.add(
        "[Content_Types].xml",
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Types "
        "xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\"><Default Extension=\"rels\" "
        "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/><Default "
        "Extension=\"model\" "
        "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>\n");
    zip.add("_rels/.rels",
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Relationships "
            "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
            "Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
            "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n");
    zip.add("3D/3dmodel.model", model, ZipMethod::deflated);
    zip.finish();
    return path;
}

std::uint64_t bytes_of(const std::string& path) {
    if (path.empty())
        return 0;
    if (!std::filesystem::is_directory(path))
        return std::filesystem::file_size(path);
    std::uint64_t bytes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
        bytes += entry.is_regular_file() ? entry.file_size() : 0;
    return bytes;
}

/// Speeds of files in the page cache, in bytes per second.
struct Speeds {
    std::vector<double> reading; ///< by number of threads, through buffers that stay in the cache
    double writing = 0;          ///< by one thread, from such a buffer
};

double reading_speed(const std::string& path, unsigned threads) {
    const std::uint64_t bytes = bytes_of(path);
    constexpr std::uint64_t chunk = std::uint64_t{256} << 10;
    const int file = open(path.c_str(), O_RDONLY);
    std::atomic<std::uint64_t> next{0};
    const auto start = Clock::now();
    std::vector<std::jthread> workers;
    for (unsigned t = 0; t < threads; ++t)
        workers.emplace_back([&] {
            std::vector<std::byte> buffer(chunk);
            for (std::uint64_t at = next.fetch_add(chunk); at < bytes; at = next.fetch_add(chunk))
                if (pread(file, buffer.data(), chunk, static_cast<off_t>(at)) < 0)
                    std::exit(1);
        });
    workers.clear();
    close(file);
    return static_cast<double>(bytes) / seconds_since(start);
}

double writing_speed(const std::string& path, std::uint64_t bytes) {
    const std::vector<std::byte> buffer(std::size_t{1} << 20);
    const auto start = Clock::now();
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    for (std::uint64_t at = 0; at < bytes; at += buffer.size())
        if (write(file, buffer.data(), buffer.size()) < 0)
            std::exit(1);
    close(file);
    const double speed = static_cast<double>(bytes) / seconds_since(start);
    std::filesystem::remove(path);
    return speed;
}

Speeds measured_speeds(const std::string& path, const std::vector<unsigned>& threads) {
    Speeds speeds;
    speeds.reading.resize(threads.back() + 1, 0);
    for (int round = 0; round < 3; ++round) {
        for (const unsigned n : threads)
            speeds.reading[n] = std::max(speeds.reading[n], reading_speed(path, n));
        speeds.writing = std::max(speeds.writing, writing_speed(path + ".copy", std::uint64_t{256} << 20));
    }
    return speeds;
}

/// No machine with these speeds does the job sooner: its processor seconds with one thread divided among all
/// threads, or its files read by all threads and written by one at a time.
double limit_of(const Job& job, double cpu_s, unsigned threads, const Speeds& speeds) {
    std::uint64_t in = 0;
    for (const std::string& path : job.inputs)
        in += bytes_of(path);
    return std::max({cpu_s / threads, static_cast<double>(in) / speeds.reading[threads],
                     static_cast<double>(bytes_of(job.output)) / speeds.writing});
}

/// Runs a command without its messages.
void run_quietly(std::vector<std::string> words) {
    const int nothing = open("/dev/null", O_WRONLY);
    dup2(nothing, STDOUT_FILENO);
    dup2(nothing, STDERR_FILENO);
    if (const int code = app::run_program(app::all_commands(), words); code != 0)
        throw std::runtime_error(fmt::format("exit code {}", code));
}

/// Removes what an earlier run left. Freeing the blocks of an old file is no part of writing a new one.
void remove_output(const Job& job) {
    if (!job.output.empty())
        std::filesystem::remove_all(job.output);
}

Measurement measured(const Job& job, unsigned threads, int rounds) {
    std::vector<Cost> costs;
    Measurement measurement{threads, 0, 0, 0, 0, 0};
    for (int round = 0; round < rounds; ++round) {
        remove_output(job);
        std::vector<std::string> words = job.words;
        words.insert(words.end(), {"--threads", std::to_string(threads)});
        const Measured<Cost> one =
            measure_in_child<Cost>([&] { return cost_of([&] { run_quietly(words); }); });
        costs.push_back(one.result);
        measurement.peak_bytes = std::max(measurement.peak_bytes, one.peak_bytes);
    }
    const Cost best = least(costs);
    measurement.wall_s = best.wall_s;
    measurement.cpu_s = best.cpu_s;
    if (!job.output.empty() && !std::filesystem::is_directory(job.output))
        measurement.hash = file_hash(job.output);
    return measurement;
}

/// Measures the job with each number of threads; ends the program if the outputs differ.
std::vector<Measurement> measured(const Job& job, const std::vector<unsigned>& threads, int rounds,
                                  const Speeds& speeds) {
    std::vector<Measurement> results;
    for (const unsigned n : threads) {
        results.push_back(measured(job, n, rounds));
        results.back().limit_s = limit_of(job, results.front().cpu_s, n, speeds);
        if (results.back().hash != results.front().hash) {
            std::cerr << job.name << ": " << n << " threads give another file than one\n";
            std::exit(1);
        }
    }
    return results;
}

/// The jobs of two tables, with their parts in the folder of all experiments.
struct Jobs {
    std::vector<Job> growing; ///< measured with each number of threads
    std::vector<Job> others;  ///< measured with one and with all
    std::vector<Job> layers;  ///< write the layer files that others read
};

Jobs jobs_of(unsigned cells) {
    const Part sheet = make_part("sheet 1225", 0.1, [] { return make_sheet({.holes = 1225}); });
    const Part lattice = make_part(fmt::format("lattice {}", cells), 0.1, [&] {
        return make_lattice({.cells_x = cells, .cells_y = cells, .cells_z = cells});
    });
    const Part fine_head =
        make_part("head 7.5 million", 0.1, [] { return subdivided(subdivided(make_head())); });
    const Part small_lattice = make_part("lattice", 0.1, [] { return make_lattice({}); });
    const Part rook = make_part("rook", 0.1, [] { return make_rook(); });
    const Part head = make_part("head", 0.1, [] { return make_head(); });
    const std::string folder = std::filesystem::path(sheet.path).parent_path().string() + '/';
    const auto file = [&](const std::string& name) {
        return folder + "cores-" + name;
    };

    Jobs jobs;
    for (const Part& part : {sheet, lattice, fine_head}) {
        jobs.growing.push_back(
            {part.name + ", no file", {"slice", part.path, "--stats", file("stats.json")}, {part.path}, ""});
        jobs.growing.push_back({part.name + ", to .cli",
                                {"slice", part.path, "-o", file("out.cli")},
                                {part.path},
                                file("out.cli")});
    }
    const std::string layers = file("lattice.cli");
    const std::string mesh = three_mf_of(small_lattice);
    jobs.layers = {{"layers", {"slice", small_lattice.path, "-o", layers}, {}, ""}};
    const auto job = [&](const std::string& name, std::vector<std::string> words,
                         std::vector<std::string> inputs, const std::string& output) {
        if (!output.empty())
            words.insert(words.end(), {"-o", output});
        jobs.others.push_back({name, std::move(words), std::move(inputs), output});
    };
    const std::string& in = small_lattice.path;
    job("slice lattice --scan, to .cli", {"slice", in, "--scan"}, {in}, file("scan.cli"));
    job("slice lattice --scan, to .ilt", {"slice", in, "--scan"}, {in}, file("scan.ilt"));
    job("slice head --scan, to .cli", {"slice", head.path, "--scan"}, {head.path}, file("scan.cli"));
    for (const char* const format : {"svg", "npz", "3mf", "json"})
        job(fmt::format("slice lattice, to .{}", format), {"slice", in}, {in},
            file(fmt::format("out.{}", format)));
    job("slice lattice.3mf, no file", {"slice", mesh, "--stats", file("stats.json")}, {mesh}, "");
    job("info lattice.3mf", {"info", mesh}, {mesh}, "");
    job("scan lattice.cli, to .cli", {"scan", layers}, {layers}, file("scan.cli"));
    job("verify lattice.cli", {"verify", layers, "--mesh", in}, {layers, in}, "");
    job("convert lattice.cli to .svg", {"convert", layers, file("out.svg")}, {layers}, "");
    jobs.others.back().output = file("out.svg");
    job("info lattice.cli", {"info", layers}, {layers}, "");
    job("compare lattice.cli", {"compare", layers, layers}, {layers, layers}, "");
    job("info head.stl", {"info", head.path}, {head.path}, "");
    job("slice rook, to .sl1", {"slice", rook.path}, {rook.path}, file("out.sl1"));
    job("slice lattice --offset -0.05", {"slice", in, "--offset", "-0.05", "--stats", file("stats.json")},
        {in}, "");
    job("slice lattice --fill nonzero", {"slice", in, "--fill", "nonzero", "--stats", file("stats.json")},
        {in}, "");
    job("info --self-intersections of the lattice", {"info", in, "--self-intersections"}, {in}, "");
    return jobs;
}

std::string seconds(double s) {
    return fmt::format("{:.3f}", s);
}

nlohmann::json as_json(const Job& job, const std::vector<Measurement>& results) {
    nlohmann::json rows = nlohmann::json::array();
    for (const Measurement& one : results)
        rows.push_back({{"threads", one.threads},
                        {"wall_s", one.wall_s},
                        {"cpu_s", one.cpu_s},
                        {"limit_s", one.limit_s},
                        {"peak_bytes", one.peak_bytes}});
    return {{"job", job.name}, {"runs", rows}};
}

/// Prints a row for each job: seconds for each number of threads, then efficiency, the limit and the memory.
nlohmann::json print_table(const std::vector<Job>& jobs, const std::vector<unsigned>& threads, int rounds,
                           const Speeds& speeds) {
    std::vector<std::string> header{"job"};
    for (const unsigned n : threads)
        header.push_back(fmt::format("{} thread{} s", n, n == 1 ? "" : "s"));
    for (const char* const name : {"times", "efficiency", "limit s", "to the limit", "MB 1 thread", "MB all"})
        header.emplace_back(name);
    Table table(header);
    nlohmann::json json = nlohmann::json::array();
    for (const Job& job : jobs) {
        const std::vector<Measurement> results = measured(job, threads, rounds, speeds);
        const Measurement& one = results.front();
        const Measurement& all = results.back();
        std::vector<std::string> row{job.name};
        for (const Measurement& result : results)
            row.push_back(seconds(result.wall_s));
        const double times = one.wall_s / all.wall_s;
        row.push_back(fmt::format("{:.1f}", times));
        row.push_back(fmt::format("{:.0f} %", 100 * times / all.threads));
        row.push_back(seconds(all.limit_s));
        row.push_back(fmt::format("{:.1f} x", all.wall_s / all.limit_s));
        row.push_back(fmt::format("{:.0f}", static_cast<double>(one.peak_bytes) / 1e6));
        row.push_back(fmt::format("{:.0f}", static_cast<double>(all.peak_bytes) / 1e6));
        table.add(row);
        json.push_back(as_json(job, results));
        remove_output(job);
    }
    std::cout << table.text() << '\n';
    return json;
}

int main_of_cores(int argc, char** argv) {
    const Options options(argc, argv, "cores [--threads 0] [--rounds 2] [--cells 26] [--json ]");
    const unsigned most = options.threads();
    std::vector<unsigned> threads;
    for (unsigned n = 1; n < most; n *= 2)
        threads.push_back(n);
    threads.push_back(most);
    const Jobs jobs = jobs_of(static_cast<unsigned>(options.number("--cells")));
    for (const Job& job : jobs.layers)
        (void)measured(job, most, 1);
    const Speeds speeds = measured_speeds(jobs.growing.front().inputs.front(), threads);

    std::cout << machine() << "\n\nFiles in the page cache: read by one thread at "
              << fmt::format("{:.1f} GB/s, by {} at {:.1f}, written by one at {:.1f}.\n\n",
                             speeds.reading[1] / 1e9, most, speeds.reading[most] / 1e9, speeds.writing / 1e9);
    nlohmann::json results{{"machine", machine()}, {"threads", threads}};
    results["growing"] = print_table(jobs.growing, threads, options.rounds(), speeds);
    const std::vector<unsigned> ends = most == 1 ? std::vector{1U} : std::vector{1U, most};
    results["others"] = print_table(jobs.others, ends, options.rounds(), speeds);
    if (const std::string& path = options.text("--json"); !path.empty()) {
        std::FILE* const file = std::fopen(path.c_str(), "w");
        if (file == nullptr || std::fputs((results.dump(1) + "\n").c_str(), file) < 0 ||
            std::fclose(file) != 0) {
            std::cerr << path << ": cannot be written\n";
            return 1;
        }
    }
    return 0;
}

} // namespace

} // namespace lamella::bench

int main(int argc, char** argv) {
    return lamella::bench::main_of_cores(argc, argv);
}
