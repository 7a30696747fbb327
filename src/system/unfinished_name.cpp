#include "system/unfinished_name.hpp"

#include "lamella/core/error.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cassert>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <ctime>
#include <memory>
#include <utility>

namespace lamella {

// A slot of the list of temporary names, the only global state of the library. It is needed because a thread
// that ends the process cannot use the objects of other threads, which may be in any state. The list has no
// locks, so that a stuck thread blocks no other. Slots are reused but never freed. The thread that takes a
// name out of its slot owns the name.
struct UnfinishedName::Slot {
    std::atomic<const char*> path{nullptr};
    Slot* next = nullptr;
};

namespace {

using Slot = UnfinishedName::Slot;

std::atomic<Slot*> slots{nullptr};
std::atomic<bool> ending{false};
std::atomic<int> creations{0};

// Replaces the names that remove_unfinished has taken. Their slots must not be used again.
constexpr char taken[] = "";

// Empties the folder once and removes it; returns false if entries have been added in the meantime.
bool remove_folder(const char* path) noexcept {
    const int folder = ::open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder < 0)
        return true;
    alignas(dirent64) char entries[4096];
    for (;;) {
        // The system call itself, because opendir allocates memory.
        const long size = ::syscall(SYS_getdents64, folder, entries, sizeof entries);
        if (size <= 0)
            break;
        for (long at = 0; at < size;) {
            const char* const entry = entries + at;
            unsigned short length = 0;
            std::memcpy(&length, entry + offsetof(dirent64, d_reclen), sizeof length);
            ::unlinkat(folder, entry + offsetof(dirent64, d_name), 0); // "." and ".." are refused
            at += length;
        }
    }
    ::close(folder);
    return ::rmdir(path) == 0 || errno != ENOTEMPTY;
}

void remove(const char* path) noexcept {
    if (::unlink(path) == 0 || (errno != EISDIR && errno != EPERM))
        return;
    // Unlinking entries while a folder is listed may hide others.
    constexpr int most_attempts = 100;
    for (int attempt = 0; attempt < most_attempts && !remove_folder(path); ++attempt) {
    }
}

} // namespace

UnfinishedName::Creation::Creation() {
    sigset_t time_is_up;
    sigemptyset(&time_is_up);
    sigaddset(&time_is_up, SIGXCPU);
    pthread_sigmask(SIG_BLOCK, &time_is_up, &signals_before_);
    ++creations;
    // Either remove_unfinished sees this creation, or this thread sees that it has begun.
    if (ending) {
        end();
        throw Error(ErrorKind::cancelled, "cancelled");
    }
}

UnfinishedName::Creation::~Creation() {
    end();
}

void UnfinishedName::Creation::end() noexcept {
    --creations;
    pthread_sigmask(SIG_SETMASK, &signals_before_, nullptr);
}

bool UnfinishedName::announce(const std::string& path) {
    assert(slot_ == nullptr);
    auto copy = std::make_unique<char[]>(path.size() + 1);
    std::memcpy(copy.get(), path.c_str(), path.size() + 1);
    Slot* slot = slots;
    for (; slot != nullptr; slot = slot->next) {
        const char* unused = nullptr;
        if (slot->path.compare_exchange_strong(unused, copy.get()))
            break;
    }
    if (slot == nullptr) {
        slot = new Slot;
        slot->path = copy.get();
        slot->next = slots;
        while (!slots.compare_exchange_weak(slot->next, slot)) {
        }
    }
    static_cast<void>(copy.release()); // the slot owns it now
    slot_ = slot;
    // Either remove_unfinished sees the name, or this thread sees that it has begun.
    if (!ending)
        return true;
    withdraw();
    return false;
}

bool UnfinishedName::withdraw() noexcept {
    if (slot_ == nullptr)
        return true;
    const char* const path = std::exchange(slot_, nullptr)->path.exchange(nullptr);
    if (path == taken)
        return false;
    delete[] path;
    return true;
}

void remove_unfinished() noexcept {
    ending = true;
    // The time is limited, because a file system may be stuck, and a thread that crashed during a creation
    // never ends it.
    constexpr timespec a_moment{.tv_sec = 0, .tv_nsec = 1'000'000};
    for (int moments = 0; creations != 0 && moments < 200; ++moments)
        ::nanosleep(&a_moment, nullptr);
    for (Slot* slot = slots; slot != nullptr; slot = slot->next) {
        const char* const path = slot->path.exchange(taken);
        if (path != nullptr && path != taken)
            remove(path);
    }
}

} // namespace lamella
