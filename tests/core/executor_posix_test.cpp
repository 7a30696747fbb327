#include "core/executor.hpp"
#include "fixtures/child_process.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/rounds.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace lamella::executor_posix_cases {
namespace {

/// Lets this process take so many more bytes of addresses than it has.
void leave_addresses(std::uint64_t bytes) {
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlimit limit{pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) + bytes, RLIM_INFINITY};
    if (setrlimit(RLIMIT_AS, &limit) != 0)
        std::abort();
}

TEST(Executor, WorksWithTheThreadsThatThereAreWhereTheSystemGivesNoMore) {
    if (test::slowed)
        GTEST_SKIP() << "sanitizers and emulators need addresses of their own";
    const int code = exit_code_of_child([] {
        constexpr unsigned asked = 1000;
        pthread_attr_t large;
        pthread_attr_init(&large);
        pthread_attr_setstacksize(&large, std::size_t{64} << 20);
        if (pthread_setattr_default_np(&large) != 0)
            std::abort();
        leave_addresses(std::uint64_t{1} << 30);
        Executor executor({.threads = asked});
        for (int region = 0; region < 3; ++region) {
            std::vector<std::atomic<int>> seen(10 * asked);
            executor.for_chunks(seen.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned worker) {
                if (worker < executor.workers())
                    ++seen[i];
            });
            if (!std::all_of(seen.begin(), seen.end(), [](int count) { return count == 1; }))
                _exit(1);
        }
        _exit(executor.workers() < 100 ? 0 : 2);
    });
    EXPECT_EQ(code, 0);
}

} // namespace
} // namespace lamella::executor_posix_cases
