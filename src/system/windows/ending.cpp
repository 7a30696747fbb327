#include "system/ending.hpp"

#include "system/windows/calls.hpp"

#include <string>

namespace lamella {

void remove_at_once(const char* path) noexcept {
    const std::wstring name = wide_path(path);
    const DWORD attributes = GetFileAttributesW(name.c_str());
    if (attributes == INVALID_FILE_ATTRIBUTES)
        return;
    if ((attributes & FILE_ATTRIBUTE_DIRECTORY) == 0) {
        DeleteFileW(name.c_str());
        return;
    }
    // Other threads may still add files.
    constexpr int most_attempts = 100;
    for (int attempt = 0; attempt < most_attempts && RemoveDirectoryW(name.c_str()) == 0; ++attempt) {
        WIN32_FIND_DATAW entry{};
        const HANDLE search = FindFirstFileW((name + L"\\*").c_str(), &entry);
        if (search == INVALID_HANDLE_VALUE)
            return;
        do
            DeleteFileW((name + L'\\' + entry.cFileName).c_str()); // fails for "." and ".."
        while (FindNextFileW(search, &entry) != 0);
        FindClose(search);
    }
}

void wait_a_moment() noexcept {
    Sleep(1);
}

EndingSignalHold::EndingSignalHold() noexcept : before_{} {}

EndingSignalHold::~EndingSignalHold() = default;

} // namespace lamella
