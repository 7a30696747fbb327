#include "lamella/core/error.hpp"
#include "lamella/slicing/slice.hpp"

#include "even_planes.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string>
#include <thread>

namespace lamella::slice_posix_cases {
namespace {

using test::even_planes;

/// The memory that this process has touched and holds, in bytes.
std::uint64_t resident_bytes() {
    std::ifstream file("/proc/self/statm");
    std::uint64_t all = 0;
    std::uint64_t resident = 0;
    file >> all >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

/// The most that this process has held since `forget_peak`.
std::uint64_t peak_bytes() {
    std::ifstream file("/proc/self/status");
    for (std::string word; file >> word;) {
        std::uint64_t kilobytes = 0;
        if (word == "VmHWM:" && file >> kilobytes)
            return kilobytes << 10;
    }
    return 0;
}

/// False where the system refuses to.
bool forget_peak() {
    std::ofstream file("/proc/self/clear_refs");
    file << 5 << std::flush;
    return file.good();
}

TEST(Slice, WritesNextToNothingAfterItIsCancelled) {
    // Hundreds of megabytes of points, written in one go by each thread. How much of them is written after
    // the wish to stop shows in the memory that is touched.
    const TriangleSoup soup = make_sheet({});
    const Plan plan = even_planes(0, 3, 1000);
    constexpr std::uint64_t enough = std::uint64_t{64} << 20;
    for (const unsigned threads : {1U, 2U}) {
        std::uint64_t written = ~std::uint64_t{0};
        bool stopped = false;
        // A watcher that the system let sleep has seen nothing.
        for (int attempt = 0; attempt < 20 && !stopped; ++attempt) {
            CancelFlag stop;
            std::uint64_t at_wish = 0;
            if (!forget_peak())
                GTEST_SKIP() << "this system does not forget how much memory a process held";
            const std::uint64_t before = resident_bytes();
            CancelFlag over;
            std::thread watcher([&] {
                while (!over.requested() && resident_bytes() < before + enough)
                    std::this_thread::yield();
                stop.request();
                at_wish = resident_bytes();
            });
            try {
                (void)slice(soup, plan, {.execution = {.threads = threads, .cancel = &stop}});
            } catch (const Error& error) {
                ASSERT_EQ(error.kind(), ErrorKind::cancelled);
                stopped = true;
            }
            over.request();
            watcher.join();
            written = peak_bytes() - std::min(peak_bytes(), at_wish);
        }
        ASSERT_TRUE(stopped);
        EXPECT_LT(written, enough);
    }
}

} // namespace
} // namespace lamella::slice_posix_cases
