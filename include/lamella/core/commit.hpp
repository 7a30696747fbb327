#pragma once

// Work in three steps: in parallel, in order, and again in parallel.

#include "lamella/core/api.hpp"

#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Work that a commit leaves for later, such as writing bytes whose position in the file the commit has
/// determined. Each is called once, from any thread, at the same time as others, and in any order.
using Completions = std::vector<std::function<void()>>;

/// The second step of the work on a plane, such as determining its position in a file. A function named
/// `prepare` does the first step, such as formatting, and returns the commit. `prepare` may be called for
/// several planes at once, from any threads and in any order. The commits are called one at a time, in the
/// order of the planes, but not always from the same thread. As nothing else can happen in order meanwhile,
/// a commit should be short, and add longer work to the completions. An empty commit has nothing to do.
///
/// A function without parameters, or with a parameter `Completions&`, is a commit.
class Commit {
  public:
    Commit() = default;

    template <class Work,
              std::enable_if_t<!std::is_same_v<Work, Commit> &&
                                   (std::is_invocable_v<Work&> || std::is_invocable_v<Work&, Completions&>),
                               int> = 0>
    Commit(Work work) { // NOLINT(google-explicit-constructor): prepare returns lambdas
        if constexpr (std::is_invocable_v<Work&, Completions&>)
            work_ = std::move(work);
        else
            work_ = [work = std::move(work)](Completions&) mutable {
                work();
            };
    }

    [[nodiscard]] explicit operator bool() const noexcept { return work_ != nullptr; }

    /// Does the step that must be in order, and adds the rest to `after`. Must be called once.
    void in_order(Completions& after) const { work_(after); }

    /// Does all of the work.
    void operator()() const {
        Completions after;
        in_order(after);
        for (const auto& completion : after)
            completion();
    }

  private:
    std::function<void(Completions&)> work_;
};

} // namespace lamella
LAMELLA_API_END
