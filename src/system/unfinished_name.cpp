#include "system/unfinished_name.hpp"

#include "lamella/core/error.hpp"

#include <atomic>
#include <cassert>
#include <cstring>
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

} // namespace

UnfinishedName::Creation::Creation() {
    ++creations;
    // Either remove_unfinished sees this creation, or this thread sees that it has begun.
    if (ending) {
        --creations;
        throw Error(ErrorKind::cancelled, "cancelled");
    }
}

UnfinishedName::Creation::~Creation() {
    --creations;
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
    for (int moments = 0; creations != 0 && moments < 200; ++moments)
        wait_a_moment();
    for (Slot* slot = slots; slot != nullptr; slot = slot->next) {
        const char* const path = slot->path.exchange(taken);
        if (path != nullptr && path != taken)
            remove_at_once(path);
    }
}

} // namespace lamella
