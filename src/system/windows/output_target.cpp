#include "system/output_target.hpp"

#include "system/windows/calls.hpp"

#include <aclapi.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <string_view>
#include <utility>

namespace lamella {

namespace {

/// Returns whether a path is one of a device, such as NUL or \\.\pipe\name.
bool is_device(const std::wstring& path) {
    wchar_t full[MAX_PATH];
    const DWORD size = GetFullPathNameW(path.c_str(), MAX_PATH, full, nullptr);
    return size > 0 && size < MAX_PATH && std::wstring_view(full, size).starts_with(L"\\\\.\\");
}

/// Returns the file at the end of a chain of links; "" if it does not exist.
std::string end_of_links(const std::wstring& path) {
    const NativeFile file = owner_of(
        CreateFileW(path.c_str(), 0, share_all, nullptr, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr));
    std::wstring name(std::size_t{1} << 15, L'\0');
    const DWORD size = file.is_open()
                           ? GetFinalPathNameByHandleW(handle_of(file), name.data(),
                                                       static_cast<DWORD>(name.size()), FILE_NAME_NORMALIZED)
                           : 0;
    name.resize(size < name.size() ? size : 0);
    return narrow(name);
}

} // namespace

bool leads_through_foreign_link(const std::string&) {
    return false; // links need a privilege here
}

OutputTarget find_target(const std::string& path) {
    const std::wstring name = wide_path(path);
    if (is_device(name))
        return {.path = {}, .in_place = true};
    constexpr std::size_t longest_name = 255; // of all file systems of Windows
    if (name.size() - (name.find_last_of(L'\\') + 1) > longest_name)
        return {.path = {}, .error = ENAMETOOLONG};
    const DWORD attributes = GetFileAttributesW(name.c_str());
    const bool exists = attributes != INVALID_FILE_ATTRIBUTES;
    if (exists && (attributes & FILE_ATTRIBUTE_DIRECTORY) != 0)
        return {.path = {}, .error = EISDIR};
    if (path.ends_with('/') || path.ends_with('\\'))
        return {.path = {}, .error = exists ? EISDIR : ENOENT};
    if (!exists || (attributes & FILE_ATTRIBUTE_REPARSE_POINT) == 0)
        return {.path = path};
    // A link stays; only a file that exists can be replaced behind it.
    std::string target = end_of_links(name);
    const bool in_place = target.empty();
    return {.path = std::move(target), .in_place = in_place};
}

std::string device_named(const std::string& path) {
    constexpr std::array<std::string_view, 6> devices{"AUX", "CON", "CONIN$", "CONOUT$", "NUL", "PRN"};
    constexpr std::array<std::string_view, 3> superscripts{"\u00b9", "\u00b2", "\u00b3"}; // count as digits
    if (path.starts_with(R"(\\.\)") || path.starts_with(R"(\\?\)"))
        return {}; // names of the system itself
    const std::string file = path.substr(path.find_last_of("/\\:") + 1);
    std::string name = file.substr(0, file.find('.'));
    name.resize(name.find_last_not_of(' ') + 1);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    if (name == "NUL" && path.size() == name.size())
        return {};
    if (std::find(devices.begin(), devices.end(), name) != devices.end())
        return name;
    constexpr std::size_t letters = 3;
    const std::string_view number = std::string_view(name).substr(std::min(letters, name.size()));
    const bool is_digit = (number.size() == 1 && number[0] >= '0' && number[0] <= '9') ||
                          std::find(superscripts.begin(), superscripts.end(), number) != superscripts.end();
    return is_digit && (name.starts_with("COM") || name.starts_with("LPT")) ? name : std::string();
}

Replaces replaced_at(const std::string& target) {
    const std::wstring name = wide_path(target);
    const DWORD attributes = GetFileAttributesW(name.c_str());
    if (attributes == INVALID_FILE_ATTRIBUTES) {
        set_errno();
        return errno == ENAMETOOLONG || errno == EILSEQ ? Replaces::unknown : Replaces::nothing;
    }
    if ((attributes & FILE_ATTRIBUTE_READONLY) != 0)
        return Replaces::protected_file;
    // A file that another program has open, without permission to replace it, is found now, not at the end.
    const NativeFile file =
        owner_of(CreateFileW(name.c_str(), DELETE, share_all, nullptr, OPEN_EXISTING, 0, nullptr));
    if (file.is_open())
        return Replaces::file;
    set_errno();
    return errno == EACCES ? Replaces::protected_file : Replaces::unknown;
}

void keep_permissions(const NativeFile& replacement, const std::string& target) {
    // Permissions that a file inherits are those of its folder, which the replacement inherits, too.
    PACL permissions = nullptr;
    PSECURITY_DESCRIPTOR descriptor = nullptr;
    if (GetNamedSecurityInfoW(wide_path(target).data(), SE_FILE_OBJECT, DACL_SECURITY_INFORMATION, nullptr,
                              nullptr, &permissions, nullptr, &descriptor) != ERROR_SUCCESS)
        return;
    SECURITY_DESCRIPTOR_CONTROL control = 0;
    DWORD revision = 0;
    if (GetSecurityDescriptorControl(descriptor, &control, &revision) != 0 &&
        (control & SE_DACL_PROTECTED) != 0)
        SetSecurityInfo(handle_of(replacement), SE_FILE_OBJECT,
                        DACL_SECURITY_INFORMATION | PROTECTED_DACL_SECURITY_INFORMATION, nullptr, nullptr,
                        permissions, nullptr);
    LocalFree(descriptor);
}

} // namespace lamella
