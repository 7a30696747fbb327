#include "system/windows/calls.hpp"

#include <algorithm>
#include <cerrno>

namespace lamella {

namespace {
constexpr DWORD quota_exceeded = 1295; // ERROR_DISK_QUOTA_EXCEEDED, which headers of MinGW lack
}

std::wstring wide(std::string_view text) {
    std::wstring result(text.size(), L'\0'); // at most one unit for each byte
    const int size = MultiByteToWideChar(CP_UTF8, 0, text.data(), static_cast<int>(text.size()),
                                         result.data(), static_cast<int>(result.size()));
    result.resize(static_cast<std::size_t>(std::max(size, 0)));
    return result;
}

std::string narrow(std::wstring_view text) {
    std::string result(3 * text.size(), '\0'); // at most three bytes for each unit
    const int size = WideCharToMultiByte(CP_UTF8, 0, text.data(), static_cast<int>(text.size()),
                                         result.data(), static_cast<int>(result.size()), nullptr, nullptr);
    result.resize(static_cast<std::size_t>(std::max(size, 0)));
    return result;
}

std::wstring wide_path(const std::string& path) {
    // Folders may have only 248 characters, and names of temporary files are longer than those of their
    // targets.
    constexpr std::size_t long_path = 180;
    std::wstring name = wide(path);
    std::replace(name.begin(), name.end(), L'/', L'\\');
    if (name.size() < long_path && !name.empty() && (name.front() == L'\\' || name.find(L':') != name.npos))
        return name;
    // A relative path may become long in its folder. The prefix requires an absolute path without "..".
    std::wstring full(std::size_t{1} << 15, L'\0');
    const DWORD size = GetFullPathNameW(name.c_str(), static_cast<DWORD>(full.size()), full.data(), nullptr);
    if (size < long_path || size >= full.size() || full.starts_with(L"\\\\?\\") ||
        full.starts_with(L"\\\\.\\"))
        return name;
    full.resize(size);
    return full.starts_with(L"\\\\") ? L"\\\\?\\UNC" + full.substr(1) : L"\\\\?\\" + full;
}

void set_errno(DWORD error) noexcept {
    switch (error) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
    case ERROR_INVALID_DRIVE:
    case ERROR_BAD_NETPATH:
    case ERROR_BAD_NET_NAME:
    case ERROR_NOT_READY:
        errno = ENOENT;
        return;
    case ERROR_INVALID_NAME:
    case ERROR_BAD_PATHNAME:
        errno = EILSEQ;
        return;
    case ERROR_DIRECTORY:
        errno = ENOTDIR;
        return;
    case ERROR_ACCESS_DENIED:
    case ERROR_CANNOT_MAKE:
    case ERROR_NETWORK_ACCESS_DENIED:
        errno = EACCES;
        return;
    case ERROR_SHARING_VIOLATION:
    case ERROR_LOCK_VIOLATION:
    case ERROR_DELETE_PENDING:
    case ERROR_USER_MAPPED_FILE:
        errno = ETXTBSY; // another program has the file open
        return;
    case ERROR_WRITE_PROTECT:
        errno = EROFS;
        return;
    case ERROR_DISK_FULL:
    case ERROR_HANDLE_DISK_FULL:
        errno = ENOSPC;
        return;
    case quota_exceeded:
        errno = quota_error;
        return;
    case ERROR_FILE_TOO_LARGE:
        errno = EFBIG;
        return;
    case ERROR_FILENAME_EXCED_RANGE:
    case ERROR_BUFFER_OVERFLOW:
        errno = ENAMETOOLONG;
        return;
    case ERROR_FILE_EXISTS:
    case ERROR_ALREADY_EXISTS:
        errno = EEXIST;
        return;
    case ERROR_DIR_NOT_EMPTY:
        errno = ENOTEMPTY;
        return;
    case ERROR_CANT_RESOLVE_FILENAME:
        errno = ELOOP;
        return;
    case ERROR_BROKEN_PIPE:
    case ERROR_NO_DATA:
    case ERROR_PIPE_NOT_CONNECTED:
        errno = EPIPE;
        return;
    case ERROR_INVALID_HANDLE:
        errno = EBADF;
        return;
    case ERROR_TOO_MANY_OPEN_FILES:
        errno = EMFILE;
        return;
    case ERROR_NOT_ENOUGH_MEMORY:
    case ERROR_OUTOFMEMORY:
    case ERROR_COMMITMENT_LIMIT:
        errno = ENOMEM;
        return;
    default:
        errno = EIO;
    }
}

} // namespace lamella
