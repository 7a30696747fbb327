#include "mpi_processes.hpp"

#include <mpi.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <thread>

namespace lamella::app {
namespace {

constexpr int tag = 0;

// Global, because MPI and MpiProcesses exist once per process, and because a type of mpi.h must not be in the
// header.
MPI_Comm last_words = MPI_COMM_NULL;

/// Returns the part of a message that is sent in one step of `most` bytes; empty after its end.
template <class Byte>
std::span<Byte> piece(std::span<Byte> message, std::uint64_t round, std::uint64_t most) {
    const std::uint64_t begin = std::min<std::uint64_t>(round * most, message.size());
    return message.subspan(begin, std::min<std::uint64_t>(most, message.size() - begin));
}

std::uint64_t rounds_of(std::uint64_t bytes, std::uint64_t most) {
    return (bytes + most - 1) / most;
}

} // namespace

// Errors of MPI calls end the job, which is the default of communicators.

MpiProcesses::MpiProcesses(std::uint64_t most_bytes_at_once) : most_at_once_(most_bytes_at_once) {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    int rank = 0;
    int size = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    MPI_Comm_dup(MPI_COMM_WORLD, &last_words);
    process_ = static_cast<std::size_t>(rank);
    size_ = static_cast<std::size_t>(size);
}

MpiProcesses::~MpiProcesses() {
    MPI_Comm_free(&last_words);
    MPI_Finalize();
}

// Uses a separate communicator, because others may be in use.
bool MpiProcesses::meet(std::chrono::seconds patience) {
    MPI_Request everybody = MPI_REQUEST_NULL;
    MPI_Ibarrier(last_words, &everybody);
    const auto end = std::chrono::steady_clock::now() + patience;
    for (int arrived = 0;;) {
        MPI_Test(&everybody, &arrived, MPI_STATUS_IGNORE);
        if (arrived != 0)
            return true;
        if (std::chrono::steady_clock::now() > end)
            return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

void MpiProcesses::abort(int exit_code) {
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::_Exit(exit_code);
}

void MpiProcesses::sum(std::span<std::uint64_t> values) {
    const std::uint64_t most = most_at_once_ / sizeof(std::uint64_t);
    for (std::uint64_t round = 0; round < rounds_of(values.size(), most); ++round) {
        const auto some = piece(values, round, most);
        MPI_Allreduce(MPI_IN_PLACE, some.data(), static_cast<int>(some.size()), MPI_UINT64_T, MPI_SUM,
                      MPI_COMM_WORLD);
    }
}

std::vector<std::string> MpiProcesses::gather(std::string_view mine) {
    std::vector<std::uint64_t> sizes(size_);
    const std::uint64_t size = mine.size();
    MPI_Allgather(&size, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
    std::vector<std::string> all;
    for (std::size_t from = 0; from < size_; ++from) {
        std::string& text =
            all.emplace_back(from == process_ ? std::string(mine) : std::string(sizes[from], '\0'));
        for (std::uint64_t round = 0; round < rounds_of(sizes[from], most_at_once_); ++round) {
            const auto some = piece(std::span(text), round, most_at_once_);
            MPI_Bcast(some.data(), static_cast<int>(some.size()), MPI_BYTE, static_cast<int>(from),
                      MPI_COMM_WORLD);
        }
    }
    return all;
}

std::vector<std::uint64_t> MpiProcesses::exchange(std::span<const std::uint64_t> outgoing) {
    std::vector<std::uint64_t> incoming(size_);
    MPI_Alltoall(outgoing.data(), 1, MPI_UINT64_T, incoming.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
    return incoming;
}

// MPI_Alltoallv is not used because its counts and offsets are limited to 2^31. In step s, process p sends to
// process p + s and receives from process p - s (modulo their number). So no two processes send to the same
// process at the same time.
void MpiProcesses::exchange(std::span<const std::span<const std::byte>> outgoing,
                            std::span<const std::span<std::byte>> incoming) {
    std::copy(outgoing[process_].begin(), outgoing[process_].end(), incoming[process_].begin());
    for (std::size_t step = 1; step < size_; ++step) {
        const std::size_t to = (process_ + step) % size_;
        const std::size_t from = (process_ + size_ - step) % size_;
        const std::uint64_t sends = rounds_of(outgoing[to].size(), most_at_once_);
        const std::uint64_t receives = rounds_of(incoming[from].size(), most_at_once_);
        for (std::uint64_t round = 0; round < std::max(sends, receives); ++round) {
            const auto out = piece(outgoing[to], round, most_at_once_);
            const auto in = piece(incoming[from], round, most_at_once_);
            MPI_Sendrecv(out.data(), static_cast<int>(out.size()), MPI_BYTE,
                         round < sends ? static_cast<int>(to) : MPI_PROC_NULL, tag, in.data(),
                         static_cast<int>(in.size()), MPI_BYTE,
                         round < receives ? static_cast<int>(from) : MPI_PROC_NULL, tag, MPI_COMM_WORLD,
                         MPI_STATUS_IGNORE);
        }
    }
}

} // namespace lamella::app
