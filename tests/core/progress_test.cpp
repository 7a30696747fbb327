#include "core/progress.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace lamella {
namespace {

TEST(WithProgress, ReportsWhatIsTranslatedAndKeepsTheRest) {
    std::vector<std::uint64_t> reported;
    CancelFlag cancel;
    const Execution given{.threads = 3,
                          .progress = [&](const Progress& progress) { reported.push_back(progress.done); },
                          .cancel = &cancel};
    const Execution part = with_progress(given, [](const Progress& progress) {
        return progress.stage == Stage::slice ? std::optional(Progress{Stage::slice, 10 + progress.done, 20})
                                              : std::nullopt;
    });
    EXPECT_EQ(part.threads, 3U);
    EXPECT_EQ(part.cancel, &cancel);
    part.progress({Stage::slice, 1, 2});
    part.progress({Stage::read, 5, 5});
    part.progress({Stage::slice, 2, 2});
    EXPECT_EQ(reported, (std::vector<std::uint64_t>{11, 12}));
}

TEST(WithProgress, CallsNothingIfNobodyListens) {
    const Execution part =
        with_progress({}, [](const Progress& progress) { return std::optional(progress); });
    EXPECT_FALSE(part.progress);
    EXPECT_FALSE(without_progress({.progress = [](const Progress&) {
                 }}).progress);
}

} // namespace
} // namespace lamella
