#pragma once

// Tools of all experiments: a fresh process for each measurement, a clock, medians, and a table.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace lamella::bench {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Cost of some work. CPU seconds are comparable even if the machine has other load.
struct Cost {
    double wall_s = 0;
    double cpu_s = 0; ///< of all threads, including system time
};

/// Returns the CPU seconds that the process has used so far.
[[nodiscard]] double processor_seconds();

template <class Work>
Cost cost_of(const Work& work) {
    const auto start = Clock::now();
    const double used = processor_seconds();
    work();
    return {seconds_since(start), processor_seconds() - used};
}

/// Returns the cost of writing a copy of a file whose bytes are in memory.
[[nodiscard]] Cost cost_of_copying(const std::string& path);

/// Returns the minimum of each figure, because other load on the machine only adds.
[[nodiscard]] Cost least(std::span<const Cost> costs);

/// Calls `round` this many times, or until `seconds` are over, but at least once.
template <class Round>
void repeat(int rounds, double seconds, const Round& round) {
    const auto start = Clock::now();
    for (int i = 0; i < rounds && (i == 0 || seconds_since(start) < seconds); ++i)
        round();
}

/// Runs `body` in its own process, so that no measurement reuses memory of the one before, and returns the
/// peak resident memory of this process in bytes. Copies the bytes of the result to `result`. Exits the
/// program with a message if the process fails.
std::uint64_t run_in_child(const std::function<void(std::span<std::byte> result)>& body,
                           std::span<std::byte> result);

template <class Result>
struct Measured {
    Result result;
    std::uint64_t peak_bytes;
};

template <class Result, class Body>
Measured<Result> measure_in_child(const Body& body) {
    static_assert(std::is_trivially_copyable_v<Result>);
    Measured<Result> measured{};
    measured.peak_bytes = run_in_child(
        [&](std::span<std::byte> bytes) {
            const Result result = body();
            std::memcpy(bytes.data(), &result, sizeof result);
        },
        std::as_writable_bytes(std::span(&measured.result, 1)));
    return measured;
}

[[nodiscard]] double median(std::vector<double> values);

/// Columns of text, right-aligned except the first.
class Table {
  public:
    explicit Table(std::vector<std::string> header) : rows_{std::move(header)} {}
    void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
    [[nodiscard]] std::string text() const;

  private:
    std::vector<std::vector<std::string>> rows_;
};

/// Returns one line: processor, threads available, compiler.
[[nodiscard]] std::string machine();

/// The options of the command line, as `--name value`.
class Options {
  public:
    /// `usage` lists the options with their defaults, such as "limit [--rounds 7] [--parts rook,lattice]".
    /// --help prints it and ends the program. Any other option ends the program with exit code 2.
    Options(int argc, char** argv, const std::string& usage);

    [[nodiscard]] const std::string& text(const std::string& name) const { return values_.at(name); }
    [[nodiscard]] std::vector<std::string> list(const std::string& name) const; ///< split at commas
    /// Ends the program with exit code 2 if the value is not a number.
    [[nodiscard]] double number(const std::string& name) const;
    [[nodiscard]] int rounds() const { return static_cast<int>(number("--rounds")); }
    /// Returns the number of processors if the option is 0.
    [[nodiscard]] unsigned threads() const;

  private:
    std::string usage_;
    std::map<std::string, std::string> values_;
};

} // namespace lamella::bench
