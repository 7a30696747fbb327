#include "worker_team.hpp"

#include "lamella/core/error.hpp"

#include "crash.hpp"
#include "heap.hpp"
#include "interrupt.hpp"
#include "messages.hpp"
#include "system/program_ending.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

namespace lamella::app {
namespace {

constexpr int moment_ms = 20;

// Exit code of a process that cannot become a worker.
constexpr int cannot_work = 71;

[[noreturn]] void fail(int system_error) {
    throw Error(ErrorKind::limit, fmt::format("no further process can be started: {}; choose fewer --jobs",
                                              std::generic_category().message(system_error)));
}

std::string_view bytes_of(const WorkerTask& task) {
    return {reinterpret_cast<const char*>(&task), sizeof task};
}

/// Returns the index of the first of n workers that is chosen; n if there is none.
template <class Chosen>
std::size_t first_of(std::size_t n, const Chosen& chosen) {
    std::size_t i = 0;
    while (i < n && !chosen(i))
        ++i;
    return i;
}

} // namespace

WorkerTeam::WorkerTeam(std::size_t size, Work work, std::string introduction)
    : work_(std::move(work)), introduction_(std::move(introduction)), processes_(size), tasks_(size) {
    if (is_started_as_worker())
        leave(serve(channel_to_owner()));
}

WorkerTeam::~WorkerTeam() {
    stop();
    for (WorkerProcess& process : processes_)
        process.close_channel();
    for (WorkerProcess& process : processes_)
        if (process.exists())
            static_cast<void>(process.finish());
}

void WorkerTeam::stop() noexcept {
    for (std::size_t i = 0; i < tasks_.size(); ++i)
        if (tasks_[i])
            processes_[i].ask_to_stop();
}

bool WorkerTeam::is_busy() const noexcept {
    return std::any_of(tasks_.begin(), tasks_.end(), [](const auto& task) { return task.has_value(); });
}

void WorkerTeam::start(const WorkerTask& task) {
    const std::size_t n = processes_.size();
    std::size_t worker = first_of(n, [this](std::size_t i) { return !tasks_[i] && processes_[i].exists(); });
    if (worker == n)
        worker = first_of(n, [this](std::size_t i) { return !tasks_[i]; });
    if (worker == n)
        throw Error(ErrorKind::internal, "all workers have a task");
    // A worker may have died since its last answer. A new one then replaces it.
    while (!processes_[worker].exists() || !processes_[worker].channel().send(bytes_of(task))) {
        if (processes_[worker].exists())
            static_cast<void>(answer_of(worker));
        launch(worker);
    }
    tasks_[worker] = task;
}

void WorkerTeam::launch(std::size_t worker) {
    const int system_error = processes_[worker].start(
        [this](const WorkerChannel& channel) { return serve(channel); }, processes_, introduction_);
    if (system_error != 0)
        fail(system_error);
}

int WorkerTeam::serve(const WorkerChannel& channel) const {
    return_freed_memory();
    Messages messages;
    messages.set_style(ProgressStyle::silent);
    report_crashes(ProgressStyle::silent);
    std::optional<Interrupt> interrupt;
    try {
        interrupt.emplace(messages, Interrupts::of_owner);
    } catch (const std::system_error&) { // starting its thread failed
        return cannot_work;
    }
    const CancelFlag& stopped = interrupt->flag();
    while (!stopped.requested()) {
        const std::optional<std::string> request = channel.receive();
        WorkerTask task;
        if (!request || request->size() != sizeof task)
            break;
        std::memcpy(&task, request->data(), sizeof task);
        const std::string text = work_(task, stopped);
        if (!channel.send(std::string_view(text).substr(0, longest_answer)))
            break;
    }
    leave(0); // before the destructor of `interrupt`
}

std::vector<WorkerAnswer> WorkerTeam::wait() {
    // Only busy workers are waited for, because systems limit the number.
    std::vector<const WorkerProcess*> awaited;
    std::vector<std::size_t> at_work;
    for (std::size_t i = 0; i < tasks_.size(); ++i)
        if (tasks_[i]) {
            awaited.push_back(&processes_[i]);
            at_work.push_back(i);
        }
    std::vector<std::size_t> ready;
    if (const int system_error = wait_for_messages(awaited, moment_ms, ready); system_error != 0)
        throw std::system_error(system_error, std::generic_category(), "cannot wait for workers");
    std::vector<WorkerAnswer> answers;
    for (const std::size_t i : ready)
        answers.push_back(answer_of(at_work[i]));
    return answers;
}

WorkerAnswer WorkerTeam::answer_of(std::size_t worker) {
    WorkerAnswer answer;
    answer.task = tasks_[worker].value_or(WorkerTask{});
    tasks_[worker].reset();
    answer.text = processes_[worker].channel().receive();
    if (answer.text)
        return answer;
    answer.end = processes_[worker].finish();
    answer.begun = !(answer.end.kind == ProcessEnd::Kind::exited && answer.end.exit_code == cannot_work);
    if (!answer.begun && std::none_of(processes_.begin(), processes_.end(),
                                      [](const WorkerProcess& other) { return other.exists(); }))
        fail(EAGAIN);
    return answer;
}

std::optional<std::string> introduction_to_worker() {
    return is_started_as_worker() ? channel_to_owner().receive() : std::nullopt;
}

} // namespace lamella::app
