// Messages between MPI ranks, cut into pieces of a few bytes: what otherwise happens beyond 2^28. Run by
// mpirun.

#include "../../app/mpi_ranks.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

namespace lamella::app {
namespace {

/// What rank `from` sends to rank `to`: bytes that no other pair has, and of another length.
std::string message(std::size_t from, std::size_t to) {
    std::string text;
    for (std::size_t i = 0; i < 5 * from + 3 * to; ++i)
        text += static_cast<char>('a' + (7 * from + 11 * to + i) % 26);
    return text;
}

bool sums(Communicator& ranks) {
    std::vector<std::uint64_t> values(10, ranks.rank() + 1);
    ranks.sum(values);
    const std::uint64_t expected = ranks.size() * (ranks.size() + 1) / 2;
    return std::ranges::all_of(values, [&](std::uint64_t value) { return value == expected; });
}

bool gathers(Communicator& ranks) {
    const std::vector<std::string> all = ranks.gather(message(ranks.rank(), 9));
    for (std::size_t r = 0; r < ranks.size(); ++r)
        if (all[r] != message(r, 9))
            return false;
    return all.size() == ranks.size();
}

bool exchanges(Communicator& ranks) {
    std::vector<std::string> outgoing;
    std::vector<std::uint64_t> sizes;
    for (std::size_t to = 0; to < ranks.size(); ++to)
        sizes.push_back(outgoing.emplace_back(message(ranks.rank(), to)).size());
    std::vector<std::string> incoming;
    for (const std::uint64_t size : ranks.exchange(sizes))
        incoming.emplace_back(size, '?');
    std::vector<std::span<const std::byte>> out;
    std::vector<std::span<std::byte>> in;
    for (std::size_t r = 0; r < ranks.size(); ++r) {
        out.push_back(std::as_bytes(std::span(outgoing[r])));
        in.push_back(std::as_writable_bytes(std::span(incoming[r])));
    }
    ranks.exchange(out, in);
    for (std::size_t from = 0; from < ranks.size(); ++from)
        if (incoming[from] != message(from, ranks.rank()))
            return false;
    return true;
}

bool sends(Communicator& ranks) {
    if (ranks.rank() > 0) {
        ranks.send(0, message(ranks.rank(), 4));
        ranks.send(0, {});
        return true;
    }
    for (std::size_t from = 1; from < ranks.size(); ++from)
        if (ranks.receive(from) != message(from, 4) || !ranks.receive(from).empty())
            return false;
    return true;
}

} // namespace
} // namespace lamella::app

int main() {
    using namespace lamella::app;
    constexpr std::uint64_t few_bytes = 24; // three numbers
    MpiRanks ranks(few_bytes);
    bool right = sums(ranks);
    right = gathers(ranks) && right; // all of them, or other ranks wait
    right = exchanges(ranks) && right;
    right = sends(ranks) && right;
    if (!right)
        std::fprintf(stderr, "rank %zu of %zu: a message was not what was sent\n", ranks.rank(),
                     ranks.size());
    return right ? 0 : 1;
}
