#include "system/program_start.hpp"

#include "system/native_file.hpp"
#include "system/windows/calls.hpp"

#include <fcntl.h>
#include <io.h>
#include <psapi.h>
#include <shellapi.h>

#include <array>
#include <cerrno>
#include <cstdlib>

namespace lamella {

namespace {

/// Restores the code page of the console, which outlives this program.
UINT code_page_before = 0;

void restore_code_page() {
    SetConsoleOutputCP(code_page_before);
}

} // namespace

std::vector<std::string> program_arguments(int /*argc*/, char** /*argv*/) {
    // Those of main are in the code page of the system.
    int n = 0;
    wchar_t** const words = CommandLineToArgvW(GetCommandLineW(), &n);
    std::vector<std::string> arguments;
    for (int i = 1; i < n; ++i)
        arguments.push_back(narrow(words[i]));
    LocalFree(words);
    return arguments;
}

void prepare_standard_streams() noexcept {
    // A closed stream has no handle, and its number of the C library is not given to files of this library.
    for (const int number : {0, 1, 2})
        _setmode(number, _O_BINARY);
    DWORD mode = 0;
    for (const DWORD stream : {STD_OUTPUT_HANDLE, STD_ERROR_HANDLE})
        if (const HANDLE console = GetStdHandle(stream); GetConsoleMode(console, &mode) != 0) {
            SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
            if (code_page_before == 0) {
                code_page_before = GetConsoleOutputCP();
                SetConsoleOutputCP(CP_UTF8);
                std::atexit(restore_code_page);
            }
        }
}

bool output_is_closed() noexcept {
    const HANDLE output = GetStdHandle(STD_OUTPUT_HANDLE);
    return output == nullptr || output == INVALID_HANDLE_VALUE;
}

bool errors_are_on_terminal() noexcept {
    DWORD mode = 0;
    return GetConsoleMode(GetStdHandle(STD_ERROR_HANDLE), &mode) != 0 &&
           (mode & ENABLE_VIRTUAL_TERMINAL_PROCESSING) != 0;
}

int read_text(const std::string& path, std::string& text) {
    const NativeFile file = open_input(path);
    if (!file.is_open())
        return errno;
    const std::optional<InputStatus> status = status_of_input(file);
    if (status && status->kind == InputKind::folder)
        return EISDIR;
    std::array<std::byte, 1 << 16> block;
    for (;;) {
        const std::ptrdiff_t got = read_some(file, block);
        if (got < 0)
            return errno;
        if (got == 0)
            return 0;
        text.append(reinterpret_cast<const char*>(block.data()), static_cast<std::size_t>(got));
    }
}

std::optional<FileIdentity> identity_of(const std::string& path) {
    const NativeFile file = owner_of(CreateFileW(wide_path(path).c_str(), 0, share_all, nullptr,
                                                 OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr));
    BY_HANDLE_FILE_INFORMATION status{};
    if (!file.is_open() || GetFileInformationByHandle(handle_of(file), &status) == 0)
        return std::nullopt;
    return FileIdentity{status.dwVolumeSerialNumber,
                        (std::uint64_t{status.nFileIndexHigh} << 32) | status.nFileIndexLow};
}

std::uint64_t peak_memory() {
    PROCESS_MEMORY_COUNTERS counters{};
    counters.cb = sizeof counters;
    return GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters) != 0
               ? counters.PeakWorkingSetSize
               : 0;
}

void set_heap(int /*own_pages*/, int /*kept*/) noexcept {}

std::size_t longest_path() noexcept {
    return std::size_t{1} << 15;
}

} // namespace lamella
