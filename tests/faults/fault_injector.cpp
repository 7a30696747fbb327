// Preloaded into a program under test: makes one call of the system go wrong, or all of a kind.
//
// LAMELLA_FAULT is OPERATION:NUMBER:ACTION. The operation is one of those below; the number counts its calls
// from 1, 0 means each of them. The action is the name of an error (EIO, ENOSPC, ...), which the call returns
// without having done anything, or
//     short      the call does the half of it (read, write)
//     shrink     before it is done, the file loses its content (read at a position)
//     kill       the process is killed before the call
//     killed     the process is killed after the call
//     jump       the clock of the day is off by a month, back and forth (clock)
// LAMELLA_FAULT_LOG names a file that gets one line for each call: its operation.
//
// Of calls with a descriptor only those on regular files and folders count, or only those on pipes where
// LAMELLA_FAULT_PIPES is set. The log is written by bare calls, which are not counted.

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <string_view>
#include <utility>

namespace {

constexpr std::array<std::pair<std::string_view, int>, 8> errors{{{"EIO", EIO},
                                                                  {"ENOSPC", ENOSPC},
                                                                  {"EINTR", EINTR},
                                                                  {"EACCES", EACCES},
                                                                  {"EMFILE", EMFILE},
                                                                  {"ENOMEM", ENOMEM},
                                                                  {"EDQUOT", EDQUOT},
                                                                  {"EROFS", EROFS}}};

struct Fault {
    std::string operation;
    unsigned long number = 0;
    std::string action;

    static Fault from_environment() {
        Fault fault;
        const char* const text = std::getenv("LAMELLA_FAULT");
        if (text == nullptr)
            return fault;
        const std::string_view all = text;
        const std::size_t first = all.find(':');
        const std::size_t second = all.find(':', first + 1);
        fault.operation = all.substr(0, first);
        fault.number = std::strtoul(text + first + 1, nullptr, 10);
        fault.action = all.substr(second + 1);
        return fault;
    }

    [[nodiscard]] int error() const {
        for (const auto& [name, number_of_it] : errors)
            if (action == name)
                return number_of_it;
        return 0;
    }
};

const Fault& fault() {
    static const Fault only = Fault::from_environment();
    return only;
}

template <class Function>
Function* original(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

void log(std::string_view operation) {
    static const char* const path = std::getenv("LAMELLA_FAULT_LOG");
    if (path == nullptr)
        return;
    const std::string line = std::string(operation) + "\n";
    const long file = syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    static_cast<void>(!syscall(SYS_write, file, line.data(), line.size()));
    syscall(SYS_close, file);
}

void kill_now() {
    syscall(SYS_kill, syscall(SYS_getpid), SIGKILL);
}

bool counts(int descriptor) {
    static const bool pipes = std::getenv("LAMELLA_FAULT_PIPES") != nullptr;
    struct stat status {};
    return fstat(descriptor, &status) == 0 &&
           (pipes ? S_ISFIFO(status.st_mode) : S_ISREG(status.st_mode) || S_ISDIR(status.st_mode));
}

/// Whether the call that is about to be made is the one to go wrong. Does not return where it is to be
/// killed.
bool strikes(std::string_view operation) {
    static std::atomic<unsigned long> calls{0};
    log(operation);
    const Fault& wanted = fault();
    if (operation != wanted.operation)
        return false;
    const unsigned long number = ++calls;
    if (wanted.number != 0 && number != wanted.number)
        return false;
    // A call that is interrupted each time would never be made.
    if (wanted.number == 0 && wanted.action == "EINTR" && number % 2 == 0)
        return false;
    if (wanted.action == "kill")
        kill_now();
    return true;
}

bool strikes(std::string_view operation, int descriptor) {
    return counts(descriptor) && strikes(operation);
}

/// Makes a call whose failure is `failed`.
template <class Result, class Call>
Result made(bool struck, Result failed, const Call& call) {
    if (struck && fault().error() != 0) {
        errno = fault().error();
        return failed;
    }
    const Result result = call();
    if (struck && fault().action == "killed")
        kill_now();
    return result;
}

std::size_t some_of(bool struck, std::size_t bytes) {
    return struck && fault().action == "short" ? std::max<std::size_t>(1, bytes / 2) : bytes;
}

} // namespace

#define ORIGINAL(name) static auto* const real = original<decltype(name)>(#name)

extern "C" {

ssize_t read(int descriptor, void* to, std::size_t bytes) {
    ORIGINAL(read);
    const bool struck = strikes("read", descriptor);
    return made<ssize_t>(struck, -1, [&] { return real(descriptor, to, some_of(struck, bytes)); });
}

ssize_t pread(int descriptor, void* to, std::size_t bytes, off_t place) {
    ORIGINAL(pread);
    const bool struck = strikes("read", descriptor);
    if (struck && fault().action == "shrink") {
        const std::string path = "/proc/self/fd/" + std::to_string(descriptor);
        static_cast<void>(!truncate(path.c_str(), 0));
    }
    return made<ssize_t>(struck, -1, [&] { return real(descriptor, to, some_of(struck, bytes), place); });
}

ssize_t write(int descriptor, const void* from, std::size_t bytes) {
    ORIGINAL(write);
    const bool struck = strikes("write", descriptor);
    return made<ssize_t>(struck, -1, [&] { return real(descriptor, from, some_of(struck, bytes)); });
}

ssize_t pwrite(int descriptor, const void* from, std::size_t bytes, off_t place) {
    ORIGINAL(pwrite);
    const bool struck = strikes("write", descriptor);
    return made<ssize_t>(struck, -1, [&] { return real(descriptor, from, some_of(struck, bytes), place); });
}

int open(const char* path, int flags, ...) {
    ORIGINAL(open);
    std::va_list list;
    va_start(list, flags);
    const mode_t mode = va_arg(list, mode_t);
    va_end(list);
    const bool creates = (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
    return made(strikes(creates ? "create" : "open"), -1, [&] { return real(path, flags, mode); });
}

int close(int descriptor) {
    ORIGINAL(close);
    const bool struck = strikes("close", descriptor);
    if (struck && fault().error() != 0) {
        real(descriptor); // it is closed all the same
        errno = fault().error();
        return -1;
    }
    return made(struck, -1, [&] { return real(descriptor); });
}

int mkdir(const char* path, mode_t mode) noexcept {
    ORIGINAL(mkdir);
    return made(strikes("mkdir"), -1, [&] { return real(path, mode); });
}

int rename(const char* from, const char* to) noexcept {
    ORIGINAL(rename);
    return made(strikes("rename"), -1, [&] { return real(from, to); });
}

int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) noexcept {
    ORIGINAL(linkat);
    return made(strikes("link"), -1, [&] { return real(from_folder, from, to_folder, to, flags); });
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
    ORIGINAL(renameat2);
    return made(strikes("exchange"), -1, [&] { return real(from_folder, from, to_folder, to, flags); });
}

int unlink(const char* path) noexcept {
    ORIGINAL(unlink);
    return made(strikes("unlink"), -1, [&] { return real(path); });
}

void* mmap(void* at, std::size_t bytes, int protection, int flags, int descriptor, off_t place) noexcept {
    ORIGINAL(mmap);
    if (descriptor < 0 || real == nullptr)
        // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the system tells it
        return reinterpret_cast<void*>(syscall(SYS_mmap, at, bytes, protection, flags, descriptor, place));
    return made<void*>(strikes("mmap", descriptor), MAP_FAILED,
                       [&] { return real(at, bytes, protection, flags, descriptor, place); });
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
    ORIGINAL(clock_gettime);
    const int result = real(clock, time);
    constexpr time_t month = 30 * 24 * 3600;
    if (clock == CLOCK_REALTIME && strikes("clock") && fault().action == "jump")
        time->tv_sec += time->tv_nsec % 2 == 0 ? month : -month;
    return result;
}

} // extern "C"
