#include "names.hpp"

#include <system_error>

namespace lamella::app {

std::filesystem::path place_of(const std::string& name) {
    constexpr int most_links = 40; // the limit of Linux
    std::error_code error;
    std::filesystem::path path = std::filesystem::absolute(name, error);
    if (error)
        path = name;
    for (int i = 0; i < most_links && std::filesystem::is_symlink(path, error); ++i)
        path = path.parent_path() / std::filesystem::read_symlink(path, error);
    const std::filesystem::path place = std::filesystem::weakly_canonical(path, error);
    return error ? path.lexically_normal() : place;
}

} // namespace lamella::app
