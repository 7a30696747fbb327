#include "system/windows/renaming.hpp"

#include "system/windows/calls.hpp"

#include <cstring>
#include <memory>

namespace lamella {

namespace {

// Of FileRenameInfoEx, which the headers of older compilers lack.
constexpr auto rename_with_flags = static_cast<FILE_INFO_BY_HANDLE_CLASS>(22);
constexpr DWORD replace_if_exists = 1;
constexpr DWORD posix_semantics = 2;

} // namespace

bool rename_open(const NativeFile& file, const std::string& name, bool replaces) {
    std::wstring full(std::size_t{1} << 15, L'\0');
    const DWORD length =
        GetFullPathNameW(wide_path(name).c_str(), static_cast<DWORD>(full.size()), full.data(), nullptr);
    if (length == 0 || length >= full.size()) {
        set_errno(ERROR_FILENAME_EXCED_RANGE);
        return false;
    }
    full.resize(length);
    const std::size_t size = sizeof(FILE_RENAME_INFO) + full.size() * sizeof(wchar_t);
    const auto memory = std::make_unique<std::byte[]>(size);
    auto* const request = reinterpret_cast<FILE_RENAME_INFO*>(memory.get());
    request->FileNameLength = static_cast<DWORD>(full.size() * sizeof(wchar_t));
    std::memcpy(request->FileName, full.data(), full.size() * sizeof(wchar_t));
    if (replaces) {
        // The flags are in the place of the Boolean.
        const DWORD flags = replace_if_exists | posix_semantics;
        std::memcpy(request, &flags, sizeof flags);
        if (SetFileInformationByHandle(handle_of(file), rename_with_flags, request,
                                       static_cast<DWORD>(size)) != 0)
            return true;
        const DWORD none = 0;
        std::memcpy(request, &none, sizeof none);
    }
    request->ReplaceIfExists = replaces ? TRUE : FALSE;
    if (SetFileInformationByHandle(handle_of(file), FileRenameInfo, request, static_cast<DWORD>(size)) != 0)
        return true;
    set_errno();
    return false;
}

bool set_removal(const NativeFile& file, bool removed) noexcept {
    FILE_DISPOSITION_INFO disposition{};
    disposition.DeleteFile = removed ? TRUE : FALSE;
    if (SetFileInformationByHandle(handle_of(file), FileDispositionInfo, &disposition, sizeof disposition) !=
        0)
        return true;
    set_errno();
    return false;
}

} // namespace lamella
