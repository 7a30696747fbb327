// Messages between MPI processes, cut into pieces of a few bytes: what otherwise happens beyond 2^28. Run by
// mpirun.

#include "../../app/mpi_processes.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

namespace lamella::app {
namespace {

/// What process `from` sends to process `to`: bytes that no other pair has, and of another length.
std::string message(std::size_t from, std::size_t to) {
    std::string text;
    for (std::size_t i = 0; i < 5 * from + 3 * to; ++i)
        text += static_cast<char>('a' + (7 * from + 11 * to + i) % 26);
    return text;
}

bool sums(Communicator& processes) {
    std::vector<std::uint64_t> values(10, processes.process() + 1);
    processes.sum(values);
    const std::uint64_t expected = processes.size() * (processes.size() + 1) / 2;
    return std::all_of(values.begin(), values.end(), [&](std::uint64_t value) { return value == expected; });
}

bool gathers(Communicator& processes) {
    const std::vector<std::string> all = processes.gather(message(processes.process(), 9));
    for (std::size_t r = 0; r < processes.size(); ++r)
        if (all[r] != message(r, 9))
            return false;
    return all.size() == processes.size();
}

bool exchanges(Communicator& processes) {
    std::vector<std::string> outgoing;
    std::vector<std::uint64_t> sizes;
    for (std::size_t to = 0; to < processes.size(); ++to)
        sizes.push_back(outgoing.emplace_back(message(processes.process(), to)).size());
    std::vector<std::string> incoming;
    for (const std::uint64_t size : processes.exchange(sizes))
        incoming.emplace_back(size, '?');
    std::vector<std::span<const std::byte>> out;
    std::vector<std::span<std::byte>> in;
    for (std::size_t r = 0; r < processes.size(); ++r) {
        out.push_back(std::as_bytes(std::span(outgoing[r])));
        in.push_back(std::as_writable_bytes(std::span(incoming[r])));
    }
    processes.exchange(out, in);
    for (std::size_t from = 0; from < processes.size(); ++from)
        if (incoming[from] != message(from, processes.process()))
            return false;
    return true;
}

} // namespace
} // namespace lamella::app

int main() {
    using namespace lamella::app;
    constexpr std::uint64_t few_bytes = 24; // three numbers
    MpiProcesses processes(few_bytes);
    bool right = sums(processes);
    right = gathers(processes) && right; // all of them, or other processes wait
    right = exchanges(processes) && right;
    if (!right)
        std::fprintf(stderr, "process %zu of %zu: a message was not what was sent\n", processes.process(),
                     processes.size());
    return right ? 0 : 1;
}
