#pragma once

// Holds planes until their neighbours arrive.

#include "lamella/core/commit.hpp"
#include "lamella/slicing/plan.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace lamella {

/// Returns a range extended by these numbers of planes below and above, within `all`.
[[nodiscard]] inline PlaneRange widened(PlaneRange planes, std::uint32_t below, std::uint32_t above,
                                        PlaneRange all) noexcept {
    return {planes.begin - std::min(below, planes.begin - all.begin),
            planes.end + std::min(above, all.end - planes.end)};
}

/// The contents of a plane, of the planes below it and of the planes above it. The nearest plane is first.
template <class Content>
struct PlaneNeighbours {
    std::uint32_t plane = 0;
    const Content* own = nullptr;
    std::vector<const Content*> below = {};
    std::vector<const Content*> above = {};
};

/// Passes planes on together with their neighbours below and above. Each plane arrives once, and is processed
/// in two halves (see Commit). `prepare` stores the content of the plane, and works on the planes whose
/// neighbours are then complete. The commit of plane i commits the planes whose last neighbour is i. So no
/// thread waits for another, and the number of planes in memory is bounded.
template <class Content>
class PlaneWindow {
  public:
    /// Prepares a plane with its neighbours; see Commit.
    using Work = std::function<Commit(const PlaneNeighbours<Content>& plane)>;
    using Shared = std::shared_ptr<const Content>;

    /// `coming` is the range of planes that will arrive; those in `wanted` are worked on, each with up to
    /// `below` and `above` of the arriving planes.
    PlaneWindow(PlaneRange coming, PlaneRange wanted, std::uint32_t below, std::uint32_t above, Work work)
        : coming_(coming), wanted_(wanted), below_(below), above_(above), work_(std::move(work)) {
        assert(wanted.size() == 0 || (coming.begin <= wanted.begin && wanted.end <= coming.end));
    }

    /// Adds the content of a plane. May be called from any thread.
    [[nodiscard]] Commit prepare(std::uint32_t plane, Shared content) {
        assert(coming_.begin <= plane && plane < coming_.end);
        for (const Complete& complete : store(plane, std::move(content)))
            work_on(complete);
        return [this, plane](Completions& after) {
            finish(plane, after);
        };
    }

    /// Returns the content of an adjacent plane that is held; null if there is none.
    [[nodiscard]] Shared held_beside(std::uint32_t plane) {
        const std::lock_guard lock(mutex_);
        for (const std::uint32_t beside :
             {plane - 1, plane + 1}) // an index that is not a plane is never held
            if (const auto found = held_.find(beside); found != held_.end())
                return found->second.content;
        return nullptr;
    }

    /// Returns the number of planes that are held. No other call may run at the same time.
    [[nodiscard]] std::size_t held() const noexcept { return held_.size(); }

  private:
    struct Held {
        Shared content;
        std::uint32_t users; ///< number of planes that still need the content
    };
    struct Complete {
        std::uint32_t plane;
        std::vector<Shared> contents; ///< ascending
    };

    /// Returns the planes that a plane needs, including itself.
    [[nodiscard]] PlaneRange neighbours(std::uint32_t plane) const noexcept {
        return widened({plane, plane + 1}, below_, above_, coming_);
    }

    /// Returns the planes that need a plane.
    [[nodiscard]] PlaneRange users(std::uint32_t plane) const noexcept {
        const PlaneRange all = widened({plane, plane + 1}, above_, below_, coming_);
        const std::uint32_t begin = std::max(wanted_.begin, all.begin);
        return {begin, std::max(begin, std::min(wanted_.end, all.end))};
    }

    [[nodiscard]] std::vector<Complete> store(std::uint32_t plane, Shared content) {
        const std::lock_guard lock(mutex_);
        const PlaneRange its_users = users(plane);
        if (its_users.size() == 0)
            return {};
        const bool is_new = held_.emplace(plane, Held{std::move(content), its_users.size()}).second;
        assert(is_new);
        static_cast<void>(is_new);
        std::vector<Complete> complete;
        for (std::uint32_t user = its_users.begin; user < its_users.end; ++user) {
            std::uint32_t& missing = missing_.emplace(user, neighbours(user).size()).first->second;
            if (--missing == 0)
                complete.push_back(take(user));
        }
        return complete;
    }

    /// Returns a plane with its neighbours, and releases contents that no further plane needs. The mutex must
    /// be held.
    [[nodiscard]] Complete take(std::uint32_t plane) {
        missing_.erase(plane);
        Complete complete{plane, {}};
        const PlaneRange range = neighbours(plane);
        for (std::uint32_t p = range.begin; p < range.end; ++p) {
            const auto found = held_.find(p);
            assert(found != held_.end());
            complete.contents.push_back(found->second.content);
            if (--found->second.users == 0)
                held_.erase(found);
        }
        return complete;
    }

    void work_on(const Complete& complete) {
        const std::uint32_t first = neighbours(complete.plane).begin;
        const std::size_t own = complete.plane - first;
        PlaneNeighbours<Content> plane{.plane = complete.plane, .own = complete.contents[own].get()};
        for (std::size_t i = own; i-- > 0;)
            plane.below.push_back(complete.contents[i].get());
        for (std::size_t i = own + 1; i < complete.contents.size(); ++i)
            plane.above.push_back(complete.contents[i].get());
        Commit commit = work_(plane);
        const std::lock_guard lock(mutex_);
        ready_.emplace(complete.plane, std::move(commit));
    }

    // The commit of a plane is called after all planes below are prepared, so the work on complete planes has
    // ended.
    void finish(std::uint32_t last, Completions& after) {
        const PlaneRange its_users = users(last);
        for (std::uint32_t plane = its_users.begin; plane < its_users.end; ++plane) {
            if (neighbours(plane).end != last + 1)
                continue;
            Commit commit;
            {
                const std::lock_guard lock(mutex_);
                const auto found = ready_.find(plane);
                assert(found != ready_.end());
                commit = std::move(found->second);
                ready_.erase(found);
            }
            if (commit)
                commit.in_order(after);
        }
    }

    PlaneRange coming_;
    PlaneRange wanted_;
    std::uint32_t below_;
    std::uint32_t above_;
    Work work_;
    std::mutex mutex_;
    std::map<std::uint32_t, Held> held_;
    std::map<std::uint32_t, std::uint32_t> missing_; ///< number of missing neighbours, if any
    std::map<std::uint32_t, Commit> ready_;
};

} // namespace lamella
