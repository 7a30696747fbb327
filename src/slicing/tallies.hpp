#pragma once

#include <mutex>
#include <utility>
#include <vector>

namespace lamella {

/// Tallies that any number of threads count on at once, without waiting for one another: as many as ever
/// counted at the same time.
template <class Tally>
class Tallies {
  public:
    explicit Tallies(Tally blank) : blank_(std::move(blank)) {}

    /// count(tally) on one that nobody else counts on meanwhile.
    template <class Count>
    void add(const Count& count) {
        Tally tally = take();
        count(tally);
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(tally));
    }

    /// All of them; while nobody counts.
    [[nodiscard]] const std::vector<Tally>& all() const noexcept { return idle_; }

  private:
    Tally take() {
        const std::lock_guard lock(mutex_);
        if (idle_.empty())
            return blank_;
        Tally tally = std::move(idle_.back());
        idle_.pop_back();
        return tally;
    }

    Tally blank_;
    std::mutex mutex_;
    std::vector<Tally> idle_;
};

} // namespace lamella
