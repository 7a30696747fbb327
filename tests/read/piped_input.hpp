#pragma once

// Bytes on standard input.

#include <gtest/gtest.h>
#include <sys/types.h>
#include <unistd.h>

#include <cstddef>
#include <string>
#include <thread>
#include <utility>

namespace lamella::test {

/// Standard input is a pipe that delivers these bytes.
class PipedInput {
  public:
    explicit PipedInput(std::string bytes) : saved_(dup(STDIN_FILENO)) {
        int ends[2];
        EXPECT_EQ(pipe(ends), 0);
        dup2(ends[0], STDIN_FILENO);
        close(ends[0]);
        writer_ = std::thread([to = ends[1], sent = std::move(bytes)] {
            for (std::size_t at = 0; at < sent.size();) {
                const ssize_t written = write(to, sent.data() + at, sent.size() - at);
                if (written <= 0)
                    break;
                at += static_cast<std::size_t>(written);
            }
            close(to);
        });
    }
    ~PipedInput() {
        writer_.join();
        dup2(saved_, STDIN_FILENO);
        close(saved_);
    }
    PipedInput(const PipedInput&) = delete;
    PipedInput& operator=(const PipedInput&) = delete;

  private:
    int saved_;
    std::thread writer_;
};

} // namespace lamella::test
