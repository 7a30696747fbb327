#include "lamella/core/error.hpp"
#include "lamella/pipeline/processes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lamella::processes_cases {
namespace {

TEST(ProcessAlone, HearsItselfOnly) {
    EXPECT_EQ(alone().process(), 0U);
    EXPECT_EQ(alone().size(), 1U);
    std::vector<std::uint64_t> values{3, 5};
    alone().sum(values);
    EXPECT_EQ(values, (std::vector<std::uint64_t>{3, 5}));
    EXPECT_EQ(alone().gather("said"), std::vector<std::string>{"said"});
    EXPECT_EQ(alone().exchange(std::array<std::uint64_t, 1>{7}), std::vector<std::uint64_t>{7});
    const std::string sent = "bytes";
    std::string received(sent.size(), '?');
    const std::array out{std::as_bytes(std::span(sent))};
    const std::array in{std::as_writable_bytes(std::span(received))};
    alone().exchange(out, in);
    EXPECT_EQ(received, sent);
}

TEST(ProcessAlone, HasNobodyToSendToOrToHearFrom) {
    EXPECT_THROW(alone().send(0, "message"), Error);
    EXPECT_THROW(static_cast<void>(alone().receive(0)), Error);
}

} // namespace
} // namespace lamella::processes_cases
