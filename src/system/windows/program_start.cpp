#include "system/program_start.hpp"

#include "system/native_file.hpp"
#include "system/windows/calls.hpp"

#include <fcntl.h>
#include <io.h>
#include <psapi.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// Restores the code page of the console, which outlives this program.
UINT code_page_before = 0;

void restore_code_page() {
    SetConsoleOutputCP(code_page_before);
}

/// Returns the words of a command line behind the name of the program, by the rules of the C library of
/// Windows: a word ends at a blank that is not between quotes, and only in front of a quote do backslashes
/// stand for something else.
std::vector<std::wstring> words_of_command_line(std::wstring_view line) {
    constexpr std::wstring_view blanks = L" \t";
    const std::wstring_view end_of_name = line.starts_with(L'"') ? L"\"" : blanks;
    line.remove_prefix(std::min(line.find_first_of(end_of_name, 1), line.size()));
    if (line.starts_with(L'"'))
        line.remove_prefix(1);
    std::vector<std::wstring> words;
    for (;;) {
        line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
        if (line.empty())
            return words;
        std::wstring& word = words.emplace_back();
        bool quoted = false;
        while (!line.empty() && (quoted || blanks.find(line.front()) == blanks.npos)) {
            const std::size_t slashes = std::min(line.find_first_not_of(L'\\'), line.size());
            line.remove_prefix(slashes);
            const bool before_quote = line.starts_with(L'"');
            word.append(before_quote ? slashes / 2 : slashes, L'\\');
            if (!before_quote) {
                if (slashes == 0) {
                    word += line.front();
                    line.remove_prefix(1);
                }
                continue;
            }
            line.remove_prefix(1);
            if (slashes % 2 == 1) {
                word += L'"';
            } else if (quoted && line.starts_with(L'"')) { // two quotes between quotes are one
                word += L'"';
                line.remove_prefix(1);
            } else {
                quoted = !quoted;
            }
        }
    }
}

/// Returns whether a name of a file agrees with a pattern in which * stands for any characters and ? for one.
/// Both are in lower case.
bool agrees(std::wstring_view name, std::wstring_view pattern) {
    std::size_t after_star =
        pattern.npos; // of the last star, and the part of the name that it stands for so far
    std::size_t taken = 0;
    std::size_t i = 0;
    std::size_t k = 0;
    while (i < name.size()) {
        if (k < pattern.size() && pattern[k] == L'*') {
            after_star = ++k;
            taken = i;
        } else if (k < pattern.size() && (pattern[k] == L'?' || pattern[k] == name[i])) {
            ++i;
            ++k;
        } else if (after_star != pattern.npos) {
            i = ++taken;
            k = after_star;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of(L'*', k) == pattern.npos;
}

std::wstring in_lower_case(std::wstring text) {
    CharLowerBuffW(text.data(), static_cast<DWORD>(text.size()));
    return text;
}

} // namespace

std::vector<std::string> program_arguments(int /*argc*/, char** /*argv*/) {
    // Those of main are in the code page of the system. CommandLineToArgvW needs a library that takes as long
    // to load as all others together.
    std::vector<std::string> arguments;
    for (const std::wstring& word : words_of_command_line(GetCommandLineW()))
        arguments.push_back(narrow(word));
    return arguments;
}

void prepare_standard_streams() noexcept {
    // A closed stream has no handle, and its number of the C library is not given to files of this library.
    for (const int number : {0, 1, 2})
        _setmode(number, _O_BINARY);
    // Without a buffer, a console gets each byte by itself and cannot join those of a character. What is
    // written is flushed.
    constexpr std::size_t buffer_size = 1 << 16;
    for (std::FILE* const stream : {stdout, stderr})
        std::setvbuf(stream, nullptr, _IOFBF, buffer_size);
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

std::optional<unsigned> terminal_columns() noexcept {
    const HANDLE console = GetStdHandle(STD_ERROR_HANDLE);
    DWORD mode = 0;
    if (GetConsoleMode(console, &mode) == 0 || (mode & ENABLE_VIRTUAL_TERMINAL_PROCESSING) == 0)
        return std::nullopt;
    constexpr unsigned usual = 80;
    CONSOLE_SCREEN_BUFFER_INFO info{};
    const bool known =
        GetConsoleScreenBufferInfo(console, &info) != 0 && info.srWindow.Right >= info.srWindow.Left;
    return known ? static_cast<unsigned>(info.srWindow.Right - info.srWindow.Left + 1) : usual;
}

std::optional<unsigned> output_columns() noexcept {
    CONSOLE_SCREEN_BUFFER_INFO info{};
    if (GetConsoleScreenBufferInfo(GetStdHandle(STD_OUTPUT_HANDLE), &info) == 0 ||
        info.srWindow.Right < info.srWindow.Left)
        return std::nullopt;
    return static_cast<unsigned>(info.srWindow.Right - info.srWindow.Left + 1);
}

std::optional<std::vector<std::string>> files_matching(const std::string& pattern) {
    const std::size_t name_at = pattern.find_last_of("/\\:") + 1; // 0 if there is none
    const std::string folder = pattern.substr(0, name_at);
    const std::wstring name = in_lower_case(wide(pattern.substr(name_at)));
    if (name.find_first_of(L"*?") == name.npos)
        return std::nullopt;
    // The pattern of this call would also be compared with short names, such as PART~1.STL for part.stlx.
    WIN32_FIND_DATAW entry{};
    const HANDLE search = FindFirstFileExW(wide_path(folder + "*").c_str(), FindExInfoBasic, &entry,
                                           FindExSearchNameMatch, nullptr, FIND_FIRST_EX_LARGE_FETCH);
    std::vector<std::pair<std::wstring, std::wstring>> found; // in lower case, and as they are
    if (search != INVALID_HANDLE_VALUE) {
        do {
            const std::wstring one = entry.cFileName;
            const std::wstring lower = in_lower_case(one);
            const bool hidden = (one.starts_with(L'.') && !name.starts_with(L'.')) ||
                                (entry.dwFileAttributes & FILE_ATTRIBUTE_HIDDEN) != 0;
            if ((entry.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) == 0 && !hidden && agrees(lower, name))
                found.emplace_back(lower, one);
        } while (FindNextFileW(search, &entry) != 0);
        FindClose(search);
    }
    std::sort(found.begin(), found.end());
    std::vector<std::string> files;
    for (const auto& [lower, one] : found)
        files.push_back(folder + narrow(one));
    return files;
}

void keep_window_open() {
    const HANDLE input = GetStdHandle(STD_INPUT_HANDLE);
    DWORD others = 0;
    DWORD mode = 0;
    // A console that only this program uses was made for it.
    if (GetConsoleProcessList(&others, 1) != 1 || GetConsoleMode(input, &mode) == 0 || !output_columns())
        return;
    std::fputs("\nPress a key to close this window.\n", stderr);
    std::fflush(stderr);
    FlushConsoleInputBuffer(input);
    INPUT_RECORD event{};
    DWORD got = 0;
    while (ReadConsoleInputW(input, &event, 1, &got) != 0 && got == 1)
        if (event.EventType == KEY_EVENT && event.Event.KeyEvent.bKeyDown != 0)
            return;
}

int read_text(const std::string& path, std::string& text, std::uint64_t most) {
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
        if (static_cast<std::uint64_t>(got) > most - text.size())
            return EFBIG;
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

std::string quoted_for_shell(const std::string& path) {
    return "\"" + path + "\""; // no name has quotes
}

} // namespace lamella
