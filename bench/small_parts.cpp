// Measures the cost of small parts: thousands of boxes, sliced each by its own process and all in one batch,
// against a program that only reads the same files and writes the finished answer under the same names.

#include "experiment.hpp"
#include "parts/shapes.hpp"

#include <fmt/format.h>
#include <lamella/formats.hpp>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lamella::bench {

namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the time of running a program. Its output is discarded.
double seconds_of(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (std::string& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    for (const int number : {STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&files, number, "/dev/null", 1, 0);
    const auto start = Clock::now();
    pid_t process = 0;
    int status = 0;
    const int failed = posix_spawn(&process, arguments[0], &files, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (failed != 0 || waitpid(process, &status, 0) != process || status != 0)
        throw std::runtime_error(words[0] + " failed");
    return seconds_since(start);
}

/// Folders of the experiment, in a temporary folder.
class Boxes {
  public:
    explicit Boxes(std::size_t count) : count_(count) {
        fs::create_directories(root_ / "in");
        const TriangleSoup box = make_box(10, 10, 10);
        for (std::size_t i = 0; i < count; ++i)
            write_stl(inputs() + fmt::format("/{:06}.stl", i), box);
    }
    ~Boxes() { fs::remove_all(root_); }
    Boxes(const Boxes&) = delete;
    Boxes& operator=(const Boxes&) = delete;

    [[nodiscard]] std::string inputs() const { return (root_ / "in").string(); }
    [[nodiscard]] std::string first() const { return inputs() + "/000000.stl"; }
    [[nodiscard]] std::string answer() const { return (root_ / "answer.cli").string(); }

    /// Returns an empty folder for output. File systems create files slowly where many were removed recently,
    /// so each folder has its own name, and all are removed at the end.
    [[nodiscard]] fs::path outputs() {
        const fs::path folder = root_ / fmt::format("out{}", folders_++);
        fs::create_directory(folder);
        return folder;
    }

    /// Returns whether there are this many files, all of them equal to the answer.
    [[nodiscard]] bool right(const fs::path& outputs, std::size_t count) const {
        const std::string expected = bytes_of(answer());
        std::size_t files = 0;
        for (const fs::directory_entry& entry : fs::directory_iterator(outputs)) {
            if (bytes_of(entry.path()) != expected)
                return false;
            ++files;
        }
        return files == count;
    }
    [[nodiscard]] std::size_t count() const { return count_; }

  private:
    fs::path root_ = fs::temp_directory_path() / fmt::format("lamella-small-parts-{}", getpid());
    std::size_t count_;
    std::size_t folders_ = 0;
};

/// Medians of alternating repetitions, in seconds.
struct Comparison {
    double ours;
    double theirs;
    double ratio;
    bool right;
};

/// Runs both programs `times` times, each into its own folder; `files` is the number of files that each
/// writes.
template <class Ours, class Theirs>
Comparison compare(Boxes& boxes, int times, std::size_t files, const Ours& ours, const Theirs& theirs) {
    std::vector<double> our_seconds;
    std::vector<double> their_seconds;
    std::vector<double> ratios;
    bool right = true;
    for (int i = 0; i < times; ++i) {
        const fs::path output = boxes.outputs();
        our_seconds.push_back(seconds_of(ours(output)));
        const fs::path other = boxes.outputs();
        their_seconds.push_back(seconds_of(theirs(other)));
        ratios.push_back(our_seconds.back() / their_seconds.back());
        right = right && boxes.right(output, files) && boxes.right(other, files);
    }
    return {median(our_seconds), median(their_seconds), median(ratios), right};
}

int report(int argc, char** argv) {
    const Options options(
        argc, argv,
        "small_parts [--lamella build-bench/lamella] [--files 10000] [--processes 200] [--rounds 3]");
    using Words = std::vector<std::string>;
    const std::string lamella = options.text("--lamella");
    const std::string rival = (fs::path(argv[0]).parent_path() / "read_and_write").string();
    std::cout << machine() << "; medians of wall time\n\n";

    Boxes boxes(static_cast<std::size_t>(options.number("--files")));
    seconds_of({lamella, "slice", boxes.first(), "-o", boxes.answer()});
    bool right = read_layers(boxes.answer()).merged().size() == 100;
    Table table({"boxes of 12 triangles, 100 layers", "lamella ms", "read and write ms", "ratio", "checked"});
    const auto add = [&](const std::string& name, std::size_t files, const Comparison& found) {
        const double each = 1e3 / static_cast<double>(files);
        table.add({name, fmt::format("{:.3f}", each * found.ours), fmt::format("{:.3f}", each * found.theirs),
                   fmt::format("{:.2f}", found.ratio), found.right ? "yes" : "WRONG"});
        right = right && found.right;
    };

    add("a process each", 1,
        compare(
            boxes, static_cast<int>(options.number("--processes")), 1,
            [&](const fs::path& to) {
                return Words{lamella, "slice", boxes.first(), "-o", (to / "box.cli").string()};
            },
            [&](const fs::path& to) {
                return Words{rival, boxes.answer(), to.string(), boxes.first()};
            }));
    for (const char* jobs : {"1", "0"})
        add(jobs[0] == '1' ? "a batch, one job" : "a batch, all processors", boxes.count(),
            compare(
                boxes, options.rounds(), boxes.count(),
                [&](const fs::path& to) {
                    return Words{lamella, "slice",    "--batch", boxes.inputs(), "-o",
                                 to,      "--format", "cli",     "--jobs",       jobs};
                },
                [&](const fs::path& to) {
                    return Words{rival, boxes.answer(), to.string(), boxes.inputs()};
                }));
    std::cout << table.text();
    return right ? 0 : 1;
}

} // namespace

} // namespace lamella::bench

int main(int argc, char** argv) {
    try {
        return lamella::bench::report(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
