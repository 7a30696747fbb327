#include "experiment.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace lamella::bench {

namespace {

/// Makes free memory available. A virtual machine may have returned memory that was free for a while, and
/// then must request each page again, which takes longer than slicing into it. A child process that touches
/// as much memory as a measurement may need, and ends, avoids this.
void have_memory_ready() {
    const auto free =
        static_cast<std::size_t>(sysconf(_SC_AVPHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t bytes = std::min(std::size_t{3} << 29, free / 2);
    const pid_t child = fork();
    if (child == 0) {
        void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (memory != MAP_FAILED) {
            madvise(memory, bytes, MADV_HUGEPAGE);
            madvise(memory, bytes, MADV_POPULATE_WRITE);
        }
        _exit(0);
    }
    if (child > 0)
        waitpid(child, nullptr, 0);
}

} // namespace

std::uint64_t run_in_child(const std::function<void(std::span<std::byte>)>& body,
                           std::span<std::byte> result) {
    int ends[2];
    if (pipe(ends) != 0) {
        std::perror("pipe");
        std::exit(1);
    }
    std::cout.flush();
    have_memory_ready();
    const pid_t child = fork();
    if (child == 0) {
        // Settings of the program (app/heap.cpp).
        mallopt(M_MMAP_THRESHOLD, 32 << 20);
        mallopt(M_TRIM_THRESHOLD, 64 << 20);
        try {
            body(result);
        } catch (const std::exception& error) {
            std::cerr << "failed: " << error.what() << "\n";
            _exit(1);
        }
        const bool sent = write(ends[1], result.data(), result.size()) == static_cast<ssize_t>(result.size());
        _exit(sent ? 0 : 1);
    }
    close(ends[1]);
    const ssize_t got = read(ends[0], result.data(), result.size());
    close(ends[0]);
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    if (status != 0 || got != static_cast<ssize_t>(result.size())) {
        std::cerr << "a measurement failed\n";
        std::exit(1);
    }
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

double processor_seconds() {
    timespec used{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

Cost cost_of_copying(const std::string& path) {
    const int from = open(path.c_str(), O_RDONLY);
    struct stat status {};
    fstat(from, &status);
    const auto bytes = static_cast<std::size_t>(status.st_size);
    auto* data = static_cast<char*>(mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE | MAP_POPULATE, from, 0));
    const std::string copy = path + ".copy";
    const Cost cost = cost_of([&] {
        const int to = open(copy.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        for (std::size_t done = 0; done < bytes;) {
            const ssize_t n =
                write(to, data + done, std::min<std::size_t>(bytes - done, std::size_t{1} << 22));
            if (n <= 0)
                throw std::runtime_error("the copy failed");
            done += static_cast<std::size_t>(n);
        }
        close(to);
    });
    munmap(data, bytes);
    close(from);
    std::filesystem::remove(copy);
    return cost;
}

Cost least(std::span<const Cost> costs) {
    Cost result = costs.front();
    for (const Cost& cost : costs)
        result = {std::min(result.wall_s, cost.wall_s), std::min(result.cpu_s, cost.cpu_s)};
    return result;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

std::string Table::text() const {
    std::vector<std::size_t> width(rows_.front().size(), 0);
    for (const auto& row : rows_)
        for (std::size_t c = 0; c < row.size(); ++c)
            width[c] = std::max(width[c], row[c].size());
    std::string text;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        for (std::size_t c = 0; c < rows_[r].size(); ++c)
            text += c == 0 ? fmt::format("| {:<{}} |", rows_[r][c], width[c])
                           : fmt::format(" {:>{}} |", rows_[r][c], width[c]);
        text += '\n';
        if (r != 0)
            continue;
        for (std::size_t c = 0; c < width.size(); ++c)
            text += c == 0 ? fmt::format("|{:-<{}}|", "", width[c] + 2)
                           : fmt::format("{:-<{}}:|", "", width[c] + 1);
        text += '\n';
    }
    return text;
}

std::string machine() {
    std::string processor = "unknown processor";
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);) {
        if (line.rfind("model name", 0) == 0) {
            processor = line.substr(line.find(':') + 2);
            break;
        }
    }
    return fmt::format("{}, {} threads, compiler {}", processor, std::thread::hardware_concurrency(),
                       __VERSION__);
}

namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& usage) {
    std::cerr << what << "\nusage: " << usage << '\n';
    std::exit(2);
}

} // namespace

Options::Options(int argc, char** argv, const std::string& usage) : usage_(usage) {
    const std::regex option(R"(\[(--[a-z]+) ([^\]]*)\])");
    for (std::sregex_iterator found(usage.begin(), usage.end(), option), end; found != end; ++found)
        values_[(*found)[1]] = (*found)[2];
    const std::vector<std::string> words(argv + 1, argv + argc);
    for (std::size_t i = 0; i < words.size(); i += 2) {
        if (words[i] == "--help") {
            std::cout << "usage: " << usage << '\n';
            std::exit(0);
        }
        if (!values_.contains(words[i]))
            refuse(fmt::format("there is no option '{}'", words[i]), usage);
        if (i + 1 == words.size())
            refuse(fmt::format("{} needs a value", words[i]), usage);
        values_[words[i]] = words[i + 1];
    }
}

std::vector<std::string> Options::list(const std::string& name) const {
    std::vector<std::string> items;
    std::istringstream line(text(name));
    for (std::string item; std::getline(line, item, ',');)
        items.push_back(item);
    return items;
}

double Options::number(const std::string& name) const {
    std::istringstream line(text(name));
    double value = 0;
    if (!(line >> value) || !(line >> std::ws).eof() || value < 0)
        refuse(fmt::format("{}: found '{}', expected a number", name, text(name)), usage_);
    return value;
}

unsigned Options::threads() const {
    const auto given = static_cast<unsigned>(number("--threads"));
    return given == 0 ? std::thread::hardware_concurrency() : given;
}

} // namespace lamella::bench
