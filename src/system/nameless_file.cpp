#include "system/nameless_file.hpp"

#include <fmt/format.h>

#include <cerrno>

namespace lamella {
namespace {

// Returns a name for an unfinished file: hidden, in the folder of the target.
std::string temporary_name(const std::filesystem::path& target, std::string_view owner, int attempt) {
    // Leaves space for the rest of the name: most file systems allow 255 bytes.
    const std::string stem = target.filename().string().substr(0, 200);
    return (target.parent_path() / fmt::format(".{}.{}-{}.tmp", stem, owner, attempt)).string();
}

} // namespace

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

} // namespace lamella
