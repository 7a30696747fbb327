#pragma once

// Calls of Windows: names in UTF-16, errors as errno.

#include "system/native_file.hpp"

#include <windows.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace lamella {

/// Returns a text of UTF-8 in UTF-16 and back; bytes that are invalid become U+FFFD.
[[nodiscard]] std::wstring wide(std::string_view text);
[[nodiscard]] std::string narrow(std::wstring_view text);
/// Returns a path for calls of Windows, with a prefix that permits more than 260 characters if it is long.
[[nodiscard]] std::wstring wide_path(const std::string& path);

/// Other programs may read, write and replace a file while it is open.
inline constexpr DWORD share_all = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

/// Sets errno to the one that corresponds best to an error of Windows.
void set_errno(DWORD error) noexcept;
/// Sets errno to that of the last error.
inline void set_errno() noexcept {
    set_errno(GetLastError());
}

[[nodiscard]] inline HANDLE handle_of(const NativeFile& file) noexcept {
    return reinterpret_cast<HANDLE>(file.handle());
}
[[nodiscard]] inline HANDLE handle_of_number(std::intptr_t number) noexcept {
    return reinterpret_cast<HANDLE>(number);
}
[[nodiscard]] inline std::intptr_t number_of(HANDLE handle) noexcept {
    return reinterpret_cast<std::intptr_t>(handle);
}
/// Returns the owner of a handle, which may be invalid.
[[nodiscard]] inline NativeFile owner_of(HANDLE handle) noexcept {
    return NativeFile(reinterpret_cast<NativeFile::Handle>(handle));
}

} // namespace lamella
