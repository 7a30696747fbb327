#include "system/program_workers.hpp"

#include "system/posix/program_kernel.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

namespace lamella {

namespace {

// Asks a worker to stop. No other program sends this signal.
constexpr int stop_signal = SIGUSR1;

int descriptor_of(std::intptr_t number) noexcept {
    return static_cast<int>(number);
}

} // namespace

bool WorkerChannel::send(std::string_view message) const {
    // One buffer, because a message of two writes could be interrupted between them.
    std::string bytes(sizeof(std::uint64_t), '\0');
    const std::uint64_t size = message.size();
    std::memcpy(bytes.data(), &size, sizeof size);
    bytes += message;
    for (std::string_view rest = bytes; !rest.empty();) {
        const ssize_t sent = ::write(descriptor_of(out_), rest.data(), rest.size());
        if (sent >= 0)
            rest.remove_prefix(static_cast<std::size_t>(sent));
        else if (errno != EINTR)
            return false;
    }
    return true;
}

bool WorkerChannel::read(void* data, std::size_t bytes) const {
    auto* to = static_cast<char*>(data);
    while (bytes > 0) {
        const ssize_t got = ::read(descriptor_of(in_), to, bytes);
        if (got == 0 || (got < 0 && errno != EINTR))
            return false;
        if (got > 0) {
            to += got;
            bytes -= static_cast<std::size_t>(got);
        }
    }
    return true;
}

std::optional<std::string> WorkerChannel::receive() const {
    std::uint64_t size = 0;
    if (!read(&size, sizeof size))
        return std::nullopt;
    std::string message(size, '\0');
    return read(message.data(), message.size()) ? std::optional(std::move(message)) : std::nullopt;
}

void WorkerChannel::close() noexcept {
    if (is_open())
        ::close(descriptor_of(in_));
    in_ = out_ = -1;
}

int WorkerProcess::start(const Serve& serve, std::span<const WorkerProcess> others,
                         std::string_view /*introduction*/) {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0)
        return errno;
    for (const int end : ends)
        ::fcntl(end, F_SETFD, FD_CLOEXEC);
    static_cast<void>(std::fflush(nullptr)); // buffered output must be written by this process only
    const pid_t parent = ::getpid();
    sigset_t until_it_listens;
    sigemptyset(&until_it_listens);
    sigaddset(&until_it_listens, stop_signal);
    sigset_t before;
    ::pthread_sigmask(SIG_BLOCK, &until_it_listens, &before);
    const pid_t process = ::fork();
    const int system_error = errno;
    if (process != 0)
        ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (process < 0) {
        ::close(ends[0]);
        ::close(ends[1]);
        return system_error;
    }
    if (process == 0) {
        std::signal(stop_signal, SIG_DFL); // it may have been ignored
        signal_when_parent_ends(stop_signal);
        if (::getppid() != parent)
            ::_exit(0);
        ::close(ends[0]);
        for (const WorkerProcess& other : others)
            if (other.channel_.is_open())
                ::close(descriptor_of(other.channel_.input()));
        ::_exit(serve({ends[1], ends[1]})); // resources of the parent process must not be released here
    }
    ::close(ends[1]);
    process_ = process;
    channel_ = {ends[0], ends[0]};
    return 0;
}

void WorkerProcess::ask_to_stop() const noexcept {
    ::kill(static_cast<pid_t>(process_), stop_signal);
}

ProcessEnd WorkerProcess::finish() noexcept {
    channel_.close();
    int status = 0;
    while (::waitpid(static_cast<pid_t>(process_), &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    if (WIFEXITED(status))
        return {ProcessEnd::Kind::exited, WEXITSTATUS(status),
                "exit code " + std::to_string(WEXITSTATUS(status))};
    const int signal = WTERMSIG(status);
    return {signal == SIGXCPU   ? ProcessEnd::Kind::time_is_up
            : signal == SIGKILL ? ProcessEnd::Kind::killed
                                : ProcessEnd::Kind::crashed,
            0, "signal " + std::to_string(signal) + ", " + ::strsignal(signal)};
}

int wait_for_messages(std::span<const WorkerProcess* const> processes, int milliseconds,
                      std::vector<std::size_t>& ready) {
    std::vector<pollfd> awaited;
    for (const WorkerProcess* process : processes)
        awaited.push_back({descriptor_of(process->channel().input()), POLLIN, 0});
    while (::poll(awaited.data(), static_cast<nfds_t>(awaited.size()), milliseconds) < 0)
        if (errno != EINTR)
            return errno;
    for (std::size_t i = 0; i < awaited.size(); ++i)
        if (awaited[i].revents != 0)
            ready.push_back(i);
    return 0;
}

bool is_started_as_worker() noexcept {
    return false;
}

WorkerChannel channel_to_owner() {
    return {};
}

} // namespace lamella
