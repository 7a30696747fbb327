#include "worker_team.hpp"

#include "lamella/core/error.hpp"

#include "crash.hpp"
#include "heap.hpp"
#include "interrupt.hpp"
#include "messages.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>
#include <utility>

namespace lamella::app {
namespace {

// Packets preserve message boundaries; an empty packet means that the other side has ended.
constexpr int packets = SOCK_SEQPACKET | SOCK_CLOEXEC;
constexpr int moment_ms = 20;
// Asks a worker to stop. No other program sends this signal.
constexpr int stop_signal = SIGUSR1;

sigset_t stop_signals() {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, stop_signal);
    return set;
}

// Exit code of a process that cannot become a worker.
constexpr int cannot_work = 71;

[[noreturn]] void fail(int system_error) {
    throw Error(ErrorKind::limit, fmt::format("no further process can be started: {}; choose fewer --jobs",
                                              std::generic_category().message(system_error)));
}

/// Returns whether all bytes were sent; the other side may be gone.
bool send_packet(int socket, const void* data, std::size_t bytes) {
    ssize_t sent = 0;
    do
        sent = send(socket, data, bytes, MSG_NOSIGNAL);
    while (sent < 0 && errno == EINTR);
    return sent == static_cast<ssize_t>(bytes);
}

/// Returns the length of the packet; 0 or less if the other side is gone.
ssize_t receive_packet(int socket, void* data, std::size_t bytes) {
    ssize_t got = 0;
    do
        got = recv(socket, data, bytes, 0);
    while (got < 0 && errno == EINTR);
    return got;
}

} // namespace

WorkerTeam::WorkerTeam(std::size_t size, Work work) : work_(std::move(work)), workers_(size) {}

WorkerTeam::~WorkerTeam() {
    stop();
    for (const Worker& worker : workers_)
        if (worker.process > 0)
            close(worker.socket);
    for (const Worker& worker : workers_)
        while (worker.process > 0 && waitpid(worker.process, nullptr, 0) < 0 && errno == EINTR) {
        }
}

void WorkerTeam::stop() noexcept {
    for (const Worker& worker : workers_)
        if (worker.task)
            kill(worker.process, stop_signal);
}

bool WorkerTeam::is_busy() const noexcept {
    return std::any_of(workers_.begin(), workers_.end(),
                       [](const Worker& worker) { return worker.task.has_value(); });
}

void WorkerTeam::start(const WorkerTask& task) {
    const auto first_of = [this](auto&& chosen) {
        return std::find_if(workers_.begin(), workers_.end(), chosen);
    };
    auto worker = first_of([](const Worker& w) { return !w.task && w.process > 0; });
    if (worker == workers_.end())
        worker = first_of([](const Worker& w) { return !w.task; });
    if (worker == workers_.end())
        throw Error(ErrorKind::internal, "all workers have a task");
    // A worker may have died since its last answer. A new one then replaces it.
    while (worker->process < 0 || !send_packet(worker->socket, &task, sizeof task)) {
        if (worker->process > 0)
            static_cast<void>(answer_of(*worker));
        launch(*worker);
    }
    worker->task = task;
}

void WorkerTeam::launch(Worker& worker) {
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, packets, 0, ends.data()) != 0)
        fail(errno);
    static_cast<void>(std::fflush(nullptr)); // buffered output must be written by this process only
    const pid_t parent = getpid();
    const sigset_t until_it_listens = stop_signals();
    sigset_t before;
    pthread_sigmask(SIG_BLOCK, &until_it_listens, &before);
    const pid_t process = fork();
    const int system_error = errno;
    if (process != 0)
        pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (process < 0) {
        close(ends[0]);
        close(ends[1]);
        fail(system_error);
    }
    if (process == 0) {
        std::signal(stop_signal, SIG_DFL); // it may have been ignored
        prctl(PR_SET_PDEATHSIG, stop_signal);
        if (getppid() != parent)
            _exit(0);
        close(ends[0]);
        for (const Worker& other : workers_)
            if (other.process > 0)
                close(other.socket);
        serve(ends[1]);
    }
    close(ends[1]);
    worker = {process, ends[0], std::nullopt};
}

void WorkerTeam::serve(int socket) const {
    return_freed_memory();
    Messages messages;
    messages.set_style(ProgressStyle::silent);
    report_crashes(ProgressStyle::silent);
    std::optional<Interrupt> interrupt;
    try {
        interrupt.emplace(messages, stop_signals());
    } catch (const std::system_error&) { // starting its thread failed
        _exit(cannot_work);
    }
    const CancelFlag& stopped = interrupt->flag();
    WorkerTask task;
    while (!stopped.requested() && receive_packet(socket, &task, sizeof task) == sizeof task) {
        const std::string text = work_(task, stopped);
        if (!send_packet(socket, text.data(), std::min(text.size(), longest_answer)))
            break;
    }
    _exit(0); // resources of the parent process must not be released here
}

std::vector<WorkerAnswer> WorkerTeam::wait() {
    // Only busy workers are polled, because poll limits the number of descriptors.
    std::vector<pollfd> awaited;
    std::vector<Worker*> at_work;
    for (Worker& worker : workers_)
        if (worker.task) {
            awaited.push_back({worker.socket, POLLIN, 0});
            at_work.push_back(&worker);
        }
    while (poll(awaited.data(), awaited.size(), moment_ms) < 0)
        if (errno != EINTR)
            throw std::system_error(errno, std::generic_category(), "cannot wait for workers");
    std::vector<WorkerAnswer> answers;
    for (std::size_t i = 0; i < awaited.size(); ++i)
        if (awaited[i].revents != 0)
            answers.push_back(answer_of(*at_work[i]));
    return answers;
}

WorkerAnswer WorkerTeam::answer_of(Worker& worker) {
    WorkerAnswer answer;
    answer.task = worker.task.value_or(WorkerTask{});
    std::string text(longest_answer, '\0');
    const ssize_t got = receive_packet(worker.socket, text.data(), text.size());
    worker.task.reset();
    if (got > 0) {
        text.resize(static_cast<std::size_t>(got));
        answer.text = std::move(text);
        return answer;
    }
    close(worker.socket);
    while (waitpid(worker.process, &answer.status, 0) < 0 && errno == EINTR) {
    }
    worker = {};
    answer.begun = !(WIFEXITED(answer.status) && WEXITSTATUS(answer.status) == cannot_work);
    if (!answer.begun &&
        std::none_of(workers_.begin(), workers_.end(), [](const Worker& other) { return other.process > 0; }))
        fail(EAGAIN);
    return answer;
}

} // namespace lamella::app
