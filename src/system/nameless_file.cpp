#include "system/nameless_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

namespace lamella {
namespace {

// Returns a path that leads to an open file, which need not have another one.
std::string path_of(int descriptor) {
    return fmt::format("/proc/self/fd/{}", descriptor);
}

int open_nameless(const std::string& folder, mode_t permissions) {
    int descriptor = -1;
    do
        descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, permissions);
    while (descriptor < 0 && errno == EINTR);
    // File systems and kernels without O_TMPFILE report one of these.
    if (descriptor < 0 && (errno == EISDIR || errno == EINVAL))
        errno = EOPNOTSUPP;
    return descriptor;
}

// Returns a name for an unfinished file: hidden, in the folder of the target.
std::string temporary_name(const std::filesystem::path& target, std::string_view owner, int attempt) {
    // Leaves space for the rest of the name: most file systems allow 255 bytes.
    const std::string stem = target.filename().string().substr(0, 200);
    return (target.parent_path() / fmt::format(".{}.{}-{}.tmp", stem, owner, attempt)).string();
}

} // namespace

int create_nameless(const std::string& folder, mode_t permissions) {
    const int descriptor = open_nameless(folder, permissions);
    if (descriptor < 0 || ::access(path_of(descriptor).c_str(), F_OK) == 0)
        return descriptor;
    ::close(descriptor); // there is no /proc
    errno = EOPNOTSUPP;
    return -1;
}

std::string take_free_name(const std::filesystem::path& target, std::string_view owner,
                           const std::function<bool(const char* name)>& take) {
    constexpr int most_attempts = 10'000;
    for (int attempt = 0; attempt < most_attempts;) {
        std::string name = temporary_name(target, owner, attempt);
        if (take(name.c_str()))
            return name;
        if (errno == EEXIST)
            ++attempt;
        else if (errno != EINTR)
            break;
    }
    return {};
}

std::string this_process() {
    return std::to_string(getpid());
}

bool name_file(int descriptor, const char* name) {
    return ::linkat(AT_FDCWD, path_of(descriptor).c_str(), AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0;
}

std::string scratch_folder() {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): no code here changes the environment
    const char* const wished = std::getenv("TMPDIR");
    if (wished != nullptr && *wished != '\0')
        return wished;
    return ::access("/var/tmp", W_OK | X_OK) == 0 ? "/var/tmp" : "/tmp";
}

int create_scratch(const std::string& folder) {
    constexpr mode_t only_mine = 0600;
    const int nameless = open_nameless(folder, only_mine);
    if (nameless >= 0 || errno != EOPNOTSUPP)
        return nameless;
    std::string pattern = folder + "/lamella-XXXXXX";
    const int named = ::mkostemp(pattern.data(), O_CLOEXEC);
    if (named >= 0)
        ::unlink(pattern.c_str());
    return named;
}

} // namespace lamella
