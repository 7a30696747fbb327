#include "system/nameless_file.hpp"

#include "system/windows/calls.hpp"
#include "system/windows/renaming.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cerrno>

namespace lamella {

namespace {

NativeFile create(const std::string& name, DWORD access, DWORD flags) {
    NativeFile file = owner_of(
        CreateFileW(wide_path(name).c_str(), access, share_all, nullptr, CREATE_NEW, flags, nullptr));
    if (!file.is_open())
        set_errno();
    return file;
}

/// Creates a file whose name no other file of this process has had.
NativeFile create_hidden(const std::string& folder, DWORD access, DWORD flags) {
    static std::atomic<unsigned> next{0};
    for (;;) {
        NativeFile file =
            create(fmt::format("{}\\.lamella-{}-{}.tmp", folder, this_process(), next++), access, flags);
        if (file.is_open() || errno != EEXIST)
            return file;
    }
}

} // namespace

NativeFile create_nameless(const std::string& folder) {
    constexpr DWORD access = GENERIC_READ | GENERIC_WRITE | DELETE;
    NativeFile file = create_hidden(folder, access | WRITE_DAC, 0);
    if (!file.is_open() && errno == EACCES)
        file = create_hidden(folder, access, 0);
    // From here on, the system removes the file when its last handle is closed, even by a kill.
    if (file.is_open() && !set_removal(file, true)) {
        file.close();
        errno = EOPNOTSUPP;
    }
    return file;
}

NativeFile create_named(const char* name) {
    return create(name, GENERIC_WRITE | DELETE | WRITE_DAC, 0);
}

std::string this_process() {
    return std::to_string(GetCurrentProcessId());
}

bool name_file(const NativeFile& file, const char* name) {
    if (!set_removal(file, false))
        return false;
    if (rename_open(file, name, false))
        return true;
    const int system_error = errno;
    static_cast<void>(set_removal(file, true));
    errno = system_error;
    return false;
}

bool close_and_rename(NativeFile& file, const std::string& name, const std::string& target) {
    // Virus scanners open new files for a moment, which then can be neither renamed nor replaced.
    constexpr int most_attempts = 40;
    constexpr DWORD moment_ms = 25;
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
        if (file.is_open() && rename_open(file, target, true))
            return file.close();
        file.close();
        if (MoveFileExW(wide_path(name).c_str(), wide_path(target).c_str(), MOVEFILE_REPLACE_EXISTING) != 0)
            return true;
        set_errno();
        if (errno != ETXTBSY && errno != EACCES)
            return false;
        Sleep(moment_ms);
    }
    return false;
}

void remove_file(const std::string& name) noexcept {
    DeleteFileW(wide_path(name).c_str());
}

std::string_view scratch_variable() noexcept {
    return "TMP";
}

std::string scratch_folder() {
    wchar_t folder[MAX_PATH + 1];
    const DWORD size = GetTempPathW(MAX_PATH + 1, folder);
    std::wstring_view name(folder, size <= MAX_PATH ? size : 0);
    if (name.ends_with(L'\\') && !name.ends_with(L":\\"))
        name.remove_suffix(1);
    return name.empty() ? "." : narrow(name);
}

NativeFile create_scratch(const std::string& folder) {
    // The folder for temporary files belongs to the user.
    return create_hidden(folder, GENERIC_READ | GENERIC_WRITE | DELETE,
                         FILE_ATTRIBUTE_TEMPORARY | FILE_FLAG_DELETE_ON_CLOSE);
}

} // namespace lamella
