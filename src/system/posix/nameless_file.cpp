#include "system/nameless_file.hpp"

#include "system/posix/kernel.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace lamella {

namespace {
constexpr mode_t everybody = 0666; // the umask applies
}

NativeFile create_nameless(const std::string& folder) {
    NativeFile file(open_nameless(folder, everybody));
    if (!file.is_open() || can_link_nameless(static_cast<int>(file.handle())))
        return file;
    file.close();
    errno = EOPNOTSUPP;
    return file;
}

NativeFile create_named(const char* name) {
    return NativeFile(::open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, everybody));
}

std::string this_process() {
    return std::to_string(::getpid());
}

bool name_file(const NativeFile& file, const char* name) {
    return link_nameless(static_cast<int>(file.handle()), name);
}

bool close_and_rename(NativeFile& file, const std::string& name, const std::string& target) {
    return file.close() && std::rename(name.c_str(), target.c_str()) == 0;
}

void remove_file(const std::string& name) noexcept {
    ::unlink(name.c_str());
}

std::string_view scratch_variable() noexcept {
    return "TMPDIR";
}

std::string scratch_folder() {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): no code here changes the environment
    const char* const wished = std::getenv("TMPDIR");
    if (wished != nullptr && *wished != '\0')
        return wished;
    return ::access("/var/tmp", W_OK | X_OK) == 0 ? "/var/tmp" : "/tmp";
}

NativeFile create_scratch(const std::string& folder) {
    constexpr mode_t only_mine = 0600;
    NativeFile nameless(open_nameless(folder, only_mine));
    if (nameless.is_open() || errno != EOPNOTSUPP)
        return nameless;
    std::string pattern = folder + "/lamella-XXXXXX";
    NativeFile named(::mkostemp(pattern.data(), O_CLOEXEC));
    if (named.is_open())
        ::unlink(pattern.c_str());
    return named;
}

} // namespace lamella
