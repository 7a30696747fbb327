#pragma once

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

namespace lamella {

/// Runs `action`, which ends by _exit, in its own process and returns the exit code; -1 if the process ended
/// otherwise.
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

/// Makes permissions apply to this process from now on even if it runs as root, whose capabilities allow
/// reading and writing everywhere.
inline bool give_up_capabilities() {
    __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
    const std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> none{};
    return syscall(SYS_capset, &header, none.data()) == 0;
}

} // namespace lamella
