#include "system/program_workers.hpp"

#include "system/windows/calls.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <cwchar>
#include <utility>

namespace lamella {

namespace {

/// Passes a worker the handles that it inherits: its input, its output, and an event that asks it to stop.
constexpr const wchar_t* handles_variable = L"LAMELLA_WORKER_HANDLES";

struct WorkerHandles {
    std::intptr_t in = -1;
    std::intptr_t out = -1;
    std::intptr_t stop = 0;
};

/// The handles that this process inherited as a worker.
const WorkerHandles& inherited() noexcept {
    static const WorkerHandles handles = [] {
        WorkerHandles result;
        wchar_t text[100];
        const DWORD size = GetEnvironmentVariableW(handles_variable, text, 100);
        long long in = 0;
        long long out = 0;
        long long stop = 0;
        if (size > 0 && size < 100 && std::swscanf(text, L"%lld %lld %lld", &in, &out, &stop) == 3)
            result = {in, out, stop};
        return result;
    }();
    return handles;
}

/// All workers belong to this job, and end when its last handle is closed: when this process ends, in any
/// way.
HANDLE job_of_workers() noexcept {
    static const HANDLE job = [] {
        const HANDLE created = CreateJobObjectW(nullptr, nullptr);
        JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits{};
        limits.BasicLimitInformation.LimitFlags = JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE;
        SetInformationJobObject(created, JobObjectExtendedLimitInformation, &limits, sizeof limits);
        return created;
    }();
    return job;
}

} // namespace

HANDLE stop_event_of_worker() noexcept;
HANDLE stop_event_of_worker() noexcept {
    return handle_of_number(inherited().stop);
}

bool WorkerChannel::send(std::string_view message) const {
    const std::uint64_t size = message.size();
    std::string bytes(sizeof size, '\0');
    std::memcpy(bytes.data(), &size, sizeof size);
    bytes += message;
    NativeFile file(out_);
    const bool sent = write_all(file, bytes);
    file.release();
    return sent;
}

bool WorkerChannel::read(void* data, std::size_t bytes) const {
    NativeFile file(in_);
    auto* to = static_cast<std::byte*>(data);
    std::ptrdiff_t got = 1;
    while (bytes > 0 && got > 0) {
        got = read_some(file, {to, bytes});
        to += std::max<std::ptrdiff_t>(got, 0);
        bytes -= static_cast<std::size_t>(std::max<std::ptrdiff_t>(got, 0));
    }
    file.release();
    return bytes == 0;
}

std::optional<std::string> WorkerChannel::receive() const {
    std::uint64_t size = 0;
    if (!read(&size, sizeof size))
        return std::nullopt;
    std::string message(size, '\0');
    return read(message.data(), message.size()) ? std::optional(std::move(message)) : std::nullopt;
}

void WorkerChannel::close() noexcept {
    if (!is_open())
        return;
    CloseHandle(handle_of_number(in_));
    CloseHandle(handle_of_number(out_));
    in_ = out_ = -1;
}

int WorkerProcess::start(const Serve& /*serve*/, std::span<const WorkerProcess> /*others*/,
                         std::string_view introduction) {
    // The ends of pipes for the worker can be inherited until it has them.
    SECURITY_ATTRIBUTES inheritable{sizeof inheritable, nullptr, TRUE};
    std::array<HANDLE, 2> to_worker{};
    std::array<HANDLE, 2> from_worker{};
    if (CreatePipe(&to_worker[0], &to_worker[1], &inheritable, 0) == 0) {
        set_errno();
        return errno;
    }
    if (CreatePipe(&from_worker[0], &from_worker[1], &inheritable, 0) == 0) {
        set_errno();
        CloseHandle(to_worker[0]);
        CloseHandle(to_worker[1]);
        return errno;
    }
    SetHandleInformation(to_worker[1], HANDLE_FLAG_INHERIT, 0);
    SetHandleInformation(from_worker[0], HANDLE_FLAG_INHERIT, 0);
    const HANDLE stop = CreateEventW(&inheritable, TRUE, FALSE, nullptr);

    wchar_t handles[100];
    std::swprintf(handles, 100, L"%lld %lld %lld", static_cast<long long>(number_of(to_worker[0])),
                  static_cast<long long>(number_of(from_worker[1])), static_cast<long long>(number_of(stop)));
    SetEnvironmentVariableW(handles_variable, handles);
    std::wstring program(std::size_t{1} << 15, L'\0');
    program.resize(GetModuleFileNameW(nullptr, program.data(), static_cast<DWORD>(program.size())));
    std::wstring arguments = GetCommandLineW();
    // No standard streams: the worker reports to this process only.
    STARTUPINFOW start{};
    start.cb = sizeof start;
    start.dwFlags = STARTF_USESTDHANDLES;
    start.hStdInput = start.hStdOutput = start.hStdError = nullptr;
    PROCESS_INFORMATION created{};
    // In a process group of its own, the worker does not receive Ctrl-C.
    const bool started =
        CreateProcessW(program.c_str(), arguments.data(), nullptr, nullptr, TRUE,
                       CREATE_NEW_PROCESS_GROUP | CREATE_SUSPENDED, nullptr, nullptr, &start, &created) != 0;
    if (!started)
        set_errno();
    const int system_error = started ? 0 : errno;
    SetEnvironmentVariableW(handles_variable, nullptr);
    CloseHandle(to_worker[0]);
    CloseHandle(from_worker[1]);
    if (!started) {
        CloseHandle(to_worker[1]);
        CloseHandle(from_worker[0]);
        CloseHandle(stop);
        return system_error;
    }
    AssignProcessToJobObject(job_of_workers(), created.hProcess);
    ResumeThread(created.hThread);
    CloseHandle(created.hThread);
    SetHandleInformation(stop, HANDLE_FLAG_INHERIT, 0);
    process_ = number_of(created.hProcess);
    stop_ = number_of(stop);
    channel_ = {number_of(from_worker[0]), number_of(to_worker[1])};
    // If the worker has ended already, the first task finds this out.
    static_cast<void>(channel_.send(introduction));
    return 0;
}

void WorkerProcess::ask_to_stop() const noexcept {
    SetEvent(handle_of_number(stop_));
}

ProcessEnd WorkerProcess::finish() noexcept {
    channel_.close();
    const HANDLE process = handle_of_number(std::exchange(process_, -1));
    WaitForSingleObject(process, INFINITE);
    DWORD code = 0;
    GetExitCodeProcess(process, &code);
    CloseHandle(process);
    CloseHandle(handle_of_number(std::exchange(stop_, -1)));
    constexpr DWORD exceptions = 0x80000000;
    if (code < exceptions)
        return {ProcessEnd::Kind::exited, static_cast<int>(code), "exit code " + std::to_string(code)};
    char text[32];
    std::snprintf(text, sizeof text, "exception 0x%08lX", code);
    return {ProcessEnd::Kind::crashed, 0, text};
}

int wait_for_messages(std::span<const WorkerProcess* const> processes, int milliseconds,
                      std::vector<std::size_t>& ready) {
    // No call waits for bytes of several pipes.
    const ULONGLONG end = GetTickCount64() + static_cast<ULONGLONG>(milliseconds);
    for (;;) {
        for (std::size_t i = 0; i < processes.size(); ++i) {
            DWORD available = 0;
            if (PeekNamedPipe(handle_of_number(processes[i]->channel().input()), nullptr, 0, nullptr,
                              &available, nullptr) == 0 ||
                available > 0)
                ready.push_back(i);
        }
        if (!ready.empty() || GetTickCount64() >= end)
            return 0;
        Sleep(1);
    }
}

bool is_started_as_worker() noexcept {
    return inherited().in != -1;
}

WorkerChannel channel_to_owner() {
    return {inherited().in, inherited().out};
}

} // namespace lamella
