#include "system/memory_size.hpp"

#include <windows.h>

#include <algorithm>

namespace lamella {

namespace {

constexpr std::uint64_t unlimited = ~std::uint64_t{0};

std::uint64_t physical_memory() {
    MEMORYSTATUSEX status{};
    status.dwLength = sizeof status;
    return GlobalMemoryStatusEx(&status) != 0 ? status.ullTotalPhys : unlimited;
}

/// Returns the limit of the job object, such as a container, that this process belongs to.
std::uint64_t job_limit() {
    JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits{};
    if (QueryInformationJobObject(nullptr, JobObjectExtendedLimitInformation, &limits, sizeof limits,
                                  nullptr) == 0)
        return unlimited;
    std::uint64_t limit = unlimited;
    if ((limits.BasicLimitInformation.LimitFlags & JOB_OBJECT_LIMIT_JOB_MEMORY) != 0)
        limit = std::min<std::uint64_t>(limit, limits.JobMemoryLimit);
    if ((limits.BasicLimitInformation.LimitFlags & JOB_OBJECT_LIMIT_PROCESS_MEMORY) != 0)
        limit = std::min<std::uint64_t>(limit, limits.ProcessMemoryLimit);
    return limit;
}

} // namespace

std::uint64_t memory_size() {
    static const std::uint64_t size = std::min(physical_memory(), job_limit());
    return size;
}

} // namespace lamella
