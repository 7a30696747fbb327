#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

namespace lamella {

/// Runs `action`, which ends by _exit, in a process of its own and returns the exit code; -1 when the process
/// ended otherwise.
template <class Action>
int exit_code_of_child(const Action& action) {
    const pid_t child = fork();
    if (child == 0) {
        action();
        std::abort();
    }
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

} // namespace lamella
