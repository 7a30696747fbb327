#include "system/program_ending.hpp"

#include "system/windows/calls.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <system_error>

namespace lamella {

namespace {

// Global, because handlers have no parameter for them.
void (*crashed)() noexcept = nullptr;
HANDLE user_interrupt = nullptr; // set by Ctrl-C; never closed

LONG WINAPI at_exception(EXCEPTION_POINTERS* /*exception*/) {
    crashed();
    return EXCEPTION_EXECUTE_HANDLER; // ends the process with the number of the exception
}

extern "C" void at_abort(int /*number*/) {
    crashed();
    constexpr UINT abort_code = 3; // as without this handler
    TerminateProcess(GetCurrentProcess(), abort_code);
}

/// Called on a thread of its own.
BOOL WINAPI at_control(DWORD event) {
    SetEvent(user_interrupt);
    // After these the process ends as soon as this returns; the program has five seconds.
    if (event != CTRL_C_EVENT && event != CTRL_BREAK_EVENT)
        Sleep(INFINITE);
    return TRUE;
}

} // namespace

/// The event by which the owner of a worker asks it to stop; see program_workers.cpp.
HANDLE stop_event_of_worker() noexcept;

void write_last_words(std::string_view text) noexcept {
    // A pipe that is full blocks; there is no way to ask before. Another thread writes, and is not waited for
    // long.
    constexpr DWORD patience_ms = 100;
    static std::string_view words;
    words = text;
    const HANDLE writer = CreateThread(
        nullptr, 0,
        [](void*) -> DWORD {
            DWORD written = 0;
            WriteFile(GetStdHandle(STD_ERROR_HANDLE), words.data(), static_cast<DWORD>(words.size()),
                      &written, nullptr);
            return 0;
        },
        nullptr, 0, nullptr);
    if (writer != nullptr)
        WaitForSingleObject(writer, patience_ms);
}

void leave(int exit_code) noexcept {
    // ExitProcess would wait for locks of threads that it has ended.
    TerminateProcess(GetCurrentProcess(), static_cast<UINT>(exit_code));
    std::abort();
}

void end_by_broken_pipe() noexcept {}

void handle_crashes(void (*at_crash)() noexcept, void (* /*at_time_limit*/)() noexcept) noexcept {
    crashed = at_crash;
    SetErrorMode(SEM_FAILCRITICALERRORS | SEM_NOGPFAULTERRORBOX | SEM_NOOPENFILEERRORBOX);
    SetUnhandledExceptionFilter(at_exception);
    std::signal(SIGABRT, at_abort);
}

void block_interrupts() noexcept {
    user_interrupt = CreateEventW(nullptr, TRUE, FALSE, nullptr);
    SetConsoleCtrlHandler(at_control, TRUE);
}

InterruptWatch::InterruptWatch(Interrupts kind)
    : interrupts_(reinterpret_cast<std::intptr_t>(kind == Interrupts::of_owner ? stop_event_of_worker()
                                                                               : user_interrupt)),
      ending_(reinterpret_cast<std::intptr_t>(CreateEventW(nullptr, TRUE, FALSE, nullptr))) {
    if (handle_of_number(interrupts_) == nullptr || handle_of_number(ending_) == nullptr)
        throw std::system_error(EAGAIN, std::generic_category(), "cannot watch for interrupts");
}

InterruptWatch::~InterruptWatch() {
    CloseHandle(handle_of_number(ending_));
}

InterruptWatch::Event InterruptWatch::wait(int milliseconds) const noexcept {
    const std::array<HANDLE, 2> awaited{handle_of_number(ending_), handle_of_number(interrupts_)};
    switch (WaitForMultipleObjects(2, awaited.data(), FALSE,
                                   milliseconds < 0 ? INFINITE : static_cast<DWORD>(milliseconds))) {
    case WAIT_OBJECT_0:
        return Event::end;
    case WAIT_OBJECT_0 + 1:
        return Event::interrupt;
    default:
        return Event::none;
    }
}

bool InterruptWatch::wait_for_end(int milliseconds) const noexcept {
    return WaitForSingleObject(handle_of_number(ending_), static_cast<DWORD>(milliseconds)) == WAIT_OBJECT_0;
}

void InterruptWatch::forget() noexcept {
    ResetEvent(handle_of_number(interrupts_));
}

void InterruptWatch::end() noexcept {
    SetEvent(handle_of_number(ending_));
}

} // namespace lamella
