#include "system/native_file.hpp"

#include "system/windows/calls.hpp"

#include <winioctl.h>

#include <algorithm>
#include <cerrno>

namespace lamella {

namespace {

constexpr std::size_t most_at_once = std::size_t{1} << 30;
OVERLAPPED at_offset(std::uint64_t offset) {
    OVERLAPPED position{};
    position.Offset = static_cast<DWORD>(offset);
    position.OffsetHigh = static_cast<DWORD>(offset >> 32);
    return position;
}

/// Writes all bytes, at a position or, if it is nullptr, after those written before.
bool write_bytes(HANDLE handle, std::uint64_t* offset, std::string_view bytes) {
    while (!bytes.empty()) {
        OVERLAPPED position = at_offset(offset != nullptr ? *offset : 0);
        DWORD written = 0;
        if (WriteFile(handle, bytes.data(), static_cast<DWORD>(std::min(bytes.size(), most_at_once)),
                      &written, offset != nullptr ? &position : nullptr) == 0) {
            set_errno();
            return false;
        }
        bytes.remove_prefix(written);
        if (offset != nullptr)
            *offset += written;
    }
    return true;
}

/// Returns an error for a failed call on an input; 0 if the failure means that the input has ended.
std::ptrdiff_t end_or_error() {
    const DWORD error = GetLastError();
    if (error == ERROR_HANDLE_EOF || error == ERROR_BROKEN_PIPE)
        return 0;
    set_errno(error);
    return -1;
}

} // namespace

const int quota_error = 10069; // WSAEDQUOT

bool NativeFile::close() noexcept {
    if (!is_open() || CloseHandle(reinterpret_cast<HANDLE>(release())) != 0)
        return true;
    set_errno();
    return false;
}

NativeFile open_input(const std::string& path) {
    if (path != "-") {
        // The flag lets folders be opened, so that they can be recognised.
        NativeFile file = owner_of(CreateFileW(wide_path(path).c_str(), GENERIC_READ, share_all, nullptr,
                                               OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr));
        if (!file.is_open())
            set_errno();
        return file;
    }
    const HANDLE input = GetStdHandle(STD_INPUT_HANDLE);
    HANDLE copy = INVALID_HANDLE_VALUE;
    if (input == nullptr || input == INVALID_HANDLE_VALUE ||
        DuplicateHandle(GetCurrentProcess(), input, GetCurrentProcess(), &copy, 0, FALSE,
                        DUPLICATE_SAME_ACCESS) == 0) {
        errno = EBADF;
        return {};
    }
    return owner_of(copy);
}

std::optional<InputStatus> status_of_input(const NativeFile& file) {
    switch (GetFileType(handle_of(file))) {
    case FILE_TYPE_PIPE:
        return InputStatus{InputKind::stream};
    case FILE_TYPE_CHAR: {
        // A device may have no end. A terminal has one, when its user ends the input.
        DWORD mode = 0;
        return InputStatus{GetConsoleMode(handle_of(file), &mode) != 0 ? InputKind::stream
                                                                       : InputKind::device};
    }
    case FILE_TYPE_DISK:
        break;
    default:
        return InputStatus{InputKind::unreadable};
    }
    BY_HANDLE_FILE_INFORMATION status{};
    if (GetFileInformationByHandle(handle_of(file), &status) == 0) {
        set_errno();
        return std::nullopt;
    }
    if ((status.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0)
        return InputStatus{InputKind::folder};
    const std::uint64_t size = (std::uint64_t{status.nFileSizeHigh} << 32) | status.nFileSizeLow;
    LARGE_INTEGER position{};
    // Standard input may have been read in part.
    if (size == 0 || SetFilePointerEx(handle_of(file), {}, &position, FILE_CURRENT) == 0 ||
        position.QuadPart != 0)
        return InputStatus{InputKind::stream};
    return InputStatus{InputKind::file, size};
}

std::optional<std::uint64_t> size_of(const NativeFile& file) {
    LARGE_INTEGER size{};
    if (GetFileSizeEx(handle_of(file), &size) == 0)
        return std::nullopt;
    return static_cast<std::uint64_t>(size.QuadPart);
}

bool may_stay_open(const NativeFile& /*file*/) noexcept {
    return true; // a process may have millions of files open
}

void read_ahead(const NativeFile& /*file*/) noexcept {}

std::ptrdiff_t read_at(const NativeFile& file, std::uint64_t offset, std::span<std::byte> to) {
    std::size_t done = 0;
    while (done < to.size()) {
        OVERLAPPED position = at_offset(offset + done);
        DWORD got = 0;
        if (ReadFile(handle_of(file), to.data() + done,
                     static_cast<DWORD>(std::min(to.size() - done, most_at_once)), &got, &position) == 0) {
            if (end_or_error() < 0)
                return -1;
            break;
        }
        if (got == 0)
            break;
        done += got;
    }
    return static_cast<std::ptrdiff_t>(done);
}

bool wait_for_bytes(const NativeFile& file, int milliseconds) {
    switch (GetFileType(handle_of(file))) {
    case FILE_TYPE_CHAR:
        return WaitForSingleObject(handle_of(file), static_cast<DWORD>(milliseconds)) != WAIT_TIMEOUT;
    case FILE_TYPE_PIPE:
        break;
    default:
        return true;
    }
    // No call waits for bytes of a pipe without reading them.
    const ULONGLONG end = GetTickCount64() + static_cast<ULONGLONG>(milliseconds);
    for (;;) {
        DWORD available = 0;
        if (PeekNamedPipe(handle_of(file), nullptr, 0, nullptr, &available, nullptr) == 0 || available > 0)
            return true; // ready, or an error that the next read reports
        if (GetTickCount64() >= end)
            return false;
        Sleep(1);
    }
}

std::ptrdiff_t read_some(const NativeFile& file, std::span<std::byte> to) {
    DWORD got = 0;
    if (ReadFile(handle_of(file), to.data(), static_cast<DWORD>(std::min(to.size(), most_at_once)), &got,
                 nullptr) == 0)
        return end_or_error();
    return got;
}

NativeFile standard_output() noexcept {
    const HANDLE output = GetStdHandle(STD_OUTPUT_HANDLE);
    // If it is closed, writing to it must fail.
    return owner_of(output == INVALID_HANDLE_VALUE ? nullptr : output);
}

NativeFile open_in_place(const std::string& path) {
    const std::wstring name = wide_path(path);
    NativeFile file = owner_of(CreateFileW(name.c_str(), GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE,
                                           nullptr, OPEN_EXISTING, 0, nullptr));
    if (!file.is_open() && GetLastError() == ERROR_FILE_NOT_FOUND)
        file = owner_of(CreateFileW(name.c_str(), GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE, nullptr,
                                    CREATE_ALWAYS, 0, nullptr));
    if (!file.is_open())
        set_errno();
    else if (GetFileType(handle_of(file)) == FILE_TYPE_DISK)
        SetEndOfFile(handle_of(file));
    return file;
}

NativeFile open_existing(const std::string& path) {
    NativeFile file = owner_of(
        CreateFileW(wide_path(path).c_str(), GENERIC_WRITE, share_all, nullptr, OPEN_EXISTING, 0, nullptr));
    if (!file.is_open())
        set_errno();
    return file;
}

bool write_all(const NativeFile& file, std::string_view bytes) {
    return write_bytes(handle_of(file), nullptr, bytes);
}

bool write_all_at(const NativeFile& file, std::uint64_t offset, std::string_view bytes) {
    // Writing at an offset moves the position of `write_all`.
    LARGE_INTEGER before{};
    const bool known = SetFilePointerEx(handle_of(file), {}, &before, FILE_CURRENT) != 0;
    const bool written = write_bytes(handle_of(file), &offset, bytes);
    if (known)
        SetFilePointerEx(handle_of(file), before, nullptr, FILE_BEGIN);
    return written;
}

bool synchronise(const NativeFile& file) {
    if (FlushFileBuffers(handle_of(file)) != 0 || GetFileType(handle_of(file)) != FILE_TYPE_DISK)
        return true;
    set_errno();
    return false;
}

bool reserve_space(const NativeFile& file, std::uint64_t bytes) {
    std::wstring path(std::size_t{1} << 15, L'\0');
    path.resize(GetFinalPathNameByHandleW(handle_of(file), path.data(), static_cast<DWORD>(path.size()), 0));
    ULARGE_INTEGER free{};
    if (GetDiskFreeSpaceExW(path.substr(0, path.find_last_of(L'\\')).c_str(), &free, nullptr, nullptr) != 0 &&
        free.QuadPart < bytes) {
        errno = ENOSPC;
        return false;
    }
    FILE_ALLOCATION_INFO size{};
    size.AllocationSize.QuadPart = static_cast<LONGLONG>(bytes);
    if (SetFileInformationByHandle(handle_of(file), FileAllocationInfo, &size, sizeof size) != 0)
        return true;
    set_errno();
    return errno != ENOSPC && errno != quota_error && errno != EFBIG;
}

void free_space(const NativeFile& file, std::uint64_t offset, std::uint64_t bytes) noexcept {
    DWORD ignored = 0;
    FILE_ZERO_DATA_INFORMATION range{};
    range.FileOffset.QuadPart = static_cast<LONGLONG>(offset);
    range.BeyondFinalZero.QuadPart = static_cast<LONGLONG>(offset + bytes);
    DeviceIoControl(handle_of(file), FSCTL_SET_SPARSE, nullptr, 0, nullptr, 0, &ignored, nullptr);
    DeviceIoControl(handle_of(file), FSCTL_SET_ZERO_DATA, &range, sizeof range, nullptr, 0, &ignored,
                    nullptr);
}

std::optional<std::uint64_t> free_bytes(const std::string& folder) {
    ULARGE_INTEGER free{};
    if (GetDiskFreeSpaceExW(wide_path(folder).c_str(), &free, nullptr, nullptr) == 0)
        return std::nullopt;
    return free.QuadPart;
}

} // namespace lamella
