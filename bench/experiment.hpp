#pragma once

// What every experiment needs: a fresh process for each measurement, a clock, medians, and a table.

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

/// What a piece of work took. Seconds of processors are what to compare where others use the machine, too.
struct Cost {
    double wall_s = 0;
    double cpu_s = 0; ///< of all threads, by the system for it, too
};

/// What the process has used of the processors so far.
[[nodiscard]] double processor_seconds();

template <class Work>
Cost cost_of(const Work& work) {
    const auto start = Clock::now();
    const double used = processor_seconds();
    work();
    return {seconds_since(start), processor_seconds() - used};
}

/// What a copy of a file takes as a program makes it that has the bytes in memory already.
[[nodiscard]] Cost cost_of_copying(const std::string& path);

/// The least of several, for each figure: what others on the machine do only adds.
[[nodiscard]] Cost least(std::span<const Cost> costs);

/// Calls `round` so many times, or until `seconds` are over, but once at least.
template <class Round>
void repeat(int rounds, double seconds, const Round& round) {
    const auto start = Clock::now();
    for (int i = 0; i < rounds && (i == 0 || seconds_since(start) < seconds); ++i)
        round();
}

/// Runs `body` in a process of its own, so that no measurement inherits warm memory from the one before, and
/// the peak memory is its own. Exits the program with a message when the process fails. Returns its peak
/// resident memory in bytes; the bytes of the result are written to `result`.
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

/// Columns of text, right-aligned but for the first.
class Table {
  public:
    explicit Table(std::vector<std::string> head) : rows_{std::move(head)} {}
    void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
    [[nodiscard]] std::string text() const;

  private:
    std::vector<std::vector<std::string>> rows_;
};

/// One line: processor, threads available, compiler.
[[nodiscard]] std::string machine();

/// What the command line asks for, as `--name value`.
class Options {
  public:
    /// `usage`: such as "limit [--rounds 7] [--parts rook,lattice]", the options that there are with the
    /// values that they have unless given. --help prints it and ends the program; so does, with exit code 2,
    /// anything that it does not name.
    Options(int argc, char** argv, const std::string& usage);

    [[nodiscard]] const std::string& text(const std::string& name) const { return values_.at(name); }
    [[nodiscard]] std::vector<std::string> list(const std::string& name) const; ///< divided at commas
    /// Anything but a number ends the program with exit code 2.
    [[nodiscard]] double number(const std::string& name) const;
    [[nodiscard]] int rounds() const { return static_cast<int>(number("--rounds")); }
    /// As many as there are processors where it is 0.
    [[nodiscard]] unsigned threads() const;

  private:
    std::string usage_;
    std::map<std::string, std::string> values_;
};

} // namespace lamella::bench
