#include "system/working_folder.hpp"

#include "system/nameless_file.hpp"
#include "system/windows/calls.hpp"

#include <algorithm>
#include <cerrno>
#include <cwctype>
#include <system_error>

namespace lamella {

namespace fs = std::filesystem;

namespace {

/// Returns the name of the mutex that exists as long as the process of a folder.
std::wstring mutex_of(const std::string& folder) {
    std::wstring path(std::size_t{1} << 15, L'\0');
    const DWORD size =
        GetFullPathNameW(wide(folder).c_str(), static_cast<DWORD>(path.size()), path.data(), nullptr);
    path.resize(size < path.size() ? size : 0);
    // Names of files ignore the case; names of mutexes have at most 260 characters, none of which is a
    // backslash.
    std::uint64_t hash = 14695981039346656037U; // FNV-1a
    for (const wchar_t unit : path)
        hash = (hash ^ static_cast<std::uint64_t>(std::towlower(static_cast<wint_t>(unit)))) * 1099511628211U;
    return L"Global\\lamella-folder-" + std::to_wstring(hash);
}

} // namespace

std::string this_machine() {
    wchar_t name[MAX_COMPUTERNAME_LENGTH + 1];
    DWORD size = MAX_COMPUTERNAME_LENGTH + 1;
    if (GetComputerNameW(name, &size) == 0)
        return this_process();
    std::string result = narrow({name, size});
    std::erase_if(result, [](char c) { return c == '.' || c == '/' || c == '\\'; });
    return result;
}

bool create_locked(const char* name, NativeFile& lock, const std::function<bool(const char*)>& may_remove) {
    // The mutex comes first, so whoever has it may remove a folder of that name.
    const HANDLE mutex = CreateMutexW(nullptr, FALSE, mutex_of(name).c_str());
    if (mutex == nullptr || GetLastError() == ERROR_ALREADY_EXISTS) {
        if (mutex != nullptr)
            CloseHandle(mutex);
        errno = EEXIST;
        return false;
    }
    lock = owner_of(mutex);
    const std::wstring path = wide_path(name);
    if (CreateDirectoryW(path.c_str(), nullptr) != 0)
        return true;
    set_errno();
    if (errno == EEXIST && may_remove(name)) {
        remove_folder(name);
        if (CreateDirectoryW(path.c_str(), nullptr) != 0)
            return true;
        set_errno();
    }
    const int system_error = errno;
    lock.close();
    errno = system_error;
    return false;
}

std::optional<unsigned> take_permissions(const fs::path& /*replaced*/, const fs::path& /*working*/) {
    return std::nullopt; // the new folder inherits those of its parent folder
}

void set_permissions(const fs::path& /*folder*/, unsigned /*permissions*/) {}

bool rename_folder(NativeFile& /*lock*/, const fs::path& folder, const fs::path& name) {
    const std::wstring from = wide_path(folder.string());
    const std::wstring to = wide_path(name.string());
    const DWORD attributes = GetFileAttributesW(to.c_str());
    if (attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_DIRECTORY) != 0 &&
        RemoveDirectoryW(to.c_str()) == 0) { // succeeds only if it is empty
        set_errno();
        return false;
    }
    // Virus scanners and indexers open new files for a moment, and their folder then cannot be renamed.
    constexpr int most_attempts = 40;
    constexpr DWORD moment_ms = 25;
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
        if (MoveFileExW(from.c_str(), to.c_str(), 0) != 0)
            return true;
        set_errno();
        if (errno != ETXTBSY && errno != EACCES)
            return false;
        Sleep(moment_ms);
    }
    return false;
}

bool exchange_folders(const fs::path& /*one*/, const fs::path& /*other*/) {
    errno = EOPNOTSUPP;
    return false;
}

bool is_mount_point(const fs::path& folder) {
    if (folder == folder.root_path())
        return true;
    WIN32_FIND_DATAW entry{};
    const HANDLE search = FindFirstFileW(wide_path(folder.string()).c_str(), &entry);
    if (search == INVALID_HANDLE_VALUE)
        return false;
    FindClose(search);
    return (entry.dwFileAttributes & FILE_ATTRIBUTE_REPARSE_POINT) != 0 &&
           entry.dwReserved0 == IO_REPARSE_TAG_MOUNT_POINT;
}

void remove_folder(const fs::path& folder) {
    std::error_code ignored;
    fs::remove_all(fs::path(wide_path(folder.string())), ignored);
}

} // namespace lamella
