#include "system/memory_size.hpp"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace lamella {

namespace {

constexpr std::uint64_t unlimited = ~std::uint64_t{0};

/// Returns the number in a file of one line; unlimited if there is none ("max").
std::uint64_t number_in(const std::string& path) {
    std::ifstream file(path);
    std::uint64_t number = 0;
    return file >> number ? number : unlimited;
}

/// Returns the lowest limit of a control group and its ancestors.
std::uint64_t limit_upwards(const std::string& root, std::string group, const char* name) {
    std::uint64_t limit = number_in(root + "/" + name); // a container may see its own group as the root
    while (!group.empty() && group != "/") {
        limit = std::min(limit, number_in(root + group + "/" + name));
        group.resize(group.find_last_of('/'));
    }
    return limit;
}

std::uint64_t control_group_limit() {
    std::uint64_t limit = unlimited;
    std::ifstream groups("/proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {
        // "0::/path" in version 2, "5:memory:/path" in version 1.
        const std::size_t first = line.find(':');
        const std::size_t second = line.find(':', first + 1);
        if (second == std::string::npos || line.find('/', second) != second + 1)
            continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const std::string group = line.substr(second + 1);
        if (controllers.empty())
            limit = std::min(limit, limit_upwards("/sys/fs/cgroup", group, "memory.max"));
        else if (controllers == "memory")
            limit = std::min(limit, limit_upwards("/sys/fs/cgroup/memory", group, "memory.limit_in_bytes"));
    }
    return limit;
}

std::uint64_t physical_memory() {
    const long pages = sysconf(_SC_PHYS_PAGES);
    const long page = sysconf(_SC_PAGESIZE);
    return pages > 0 && page > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page)
                                 : unlimited;
}

} // namespace

std::uint64_t memory_size() {
    static const std::uint64_t size = std::min(physical_memory(), control_group_limit());
    return size;
}

} // namespace lamella
