#include "interrupt.hpp"

#include "crash.hpp"

#include <new>
#include <string>

namespace lamella::app {
namespace {

constexpr int cancelled_exit_code = 130;
constexpr int patience_ms = 700;
constexpr int together_ms = 200; // some programs signal a process and then its group; both signals count as
                                 // one

} // namespace

Interrupt::Interrupt(const Messages& messages, Interrupts kind) : messages_(messages), watch_(kind) {
    watcher_ = std::thread([this] { watch(); });
    // Wait until the thread has started. While it starts, it may hold locks of the allocator, and a fork of
    // the process would copy these in the locked state.
    watching_.get_future().wait();
}

Interrupt::~Interrupt() {
    watch_.end();
    watcher_.join();
}

void Interrupt::watch() {
    using Event = InterruptWatch::Event;
    watching_.set_value();
    if (watch_.wait(InterruptWatch::for_ever) == Event::end)
        return;
    flag_.request();
    std::string words;
    try {
        words = messages_.last_words("cancelled", cancelled_exit_code);
    } catch (const std::bad_alloc&) { // there is then no message
    }
    if (watch_.wait_for_end(together_ms))
        return;
    watch_.forget(); // so that a second interrupt can be detected
    if (watch_.wait(patience_ms - together_ms) != Event::end)
        leave_at_once(words, cancelled_exit_code);
}

} // namespace lamella::app
