// Starts a program as tests want it, where Wine has no other method.
// usage: windows_start [SETTING]... -- PROGRAM [ARGUMENT]...
//   NAME=VALUE  a variable of the environment; Wine has its own folder of temporary files
//   closed=012  standard streams that do not exist
//   open=FILE   a file that is open meanwhile, and that nobody else may write or replace

#include <windows.h>

#include <array>
#include <cstddef>
#include <string>

namespace {

/// Returns a word as programs expect it in their command lines.
std::wstring quoted(const std::wstring& word) {
    std::wstring text = L"\"";
    std::size_t slashes = 0;
    for (const wchar_t c : word) {
        if (c == L'"')
            text.append(slashes + 1, L'\\');
        slashes = c == L'\\' ? slashes + 1 : 0;
        text += c;
    }
    return text.append(slashes, L'\\') + L'"';
}

} // namespace

int wmain(int argc, wchar_t** argv) {
    std::array<HANDLE, 3> streams{GetStdHandle(STD_INPUT_HANDLE), GetStdHandle(STD_OUTPUT_HANDLE),
                                  GetStdHandle(STD_ERROR_HANDLE)};
    int i = 1;
    for (; i < argc && std::wstring(argv[i]) != L"--"; ++i) {
        const std::wstring setting = argv[i];
        const std::size_t equals = setting.find(L'=');
        const std::wstring name = setting.substr(0, equals);
        const std::wstring value = setting.substr(equals + 1);
        if (name == L"closed") {
            for (const wchar_t number : value)
                streams[static_cast<std::size_t>(number - L'0')] = nullptr;
        } else if (name != L"open") {
            SetEnvironmentVariableW(name.c_str(), value.c_str());
        } else if (CreateFileW(value.c_str(), GENERIC_READ, FILE_SHARE_READ, nullptr, OPEN_EXISTING, 0,
                               nullptr) == INVALID_HANDLE_VALUE) {
            return 120;
        }
    }
    std::wstring line;
    for (++i; i < argc; ++i)
        line += quoted(argv[i]) + L' ';
    STARTUPINFOW start{};
    start.cb = sizeof start;
    start.dwFlags = STARTF_USESTDHANDLES;
    start.hStdInput = streams[0];
    start.hStdOutput = streams[1];
    start.hStdError = streams[2];
    PROCESS_INFORMATION process{};
    if (CreateProcessW(nullptr, line.data(), nullptr, nullptr, TRUE, 0, nullptr, nullptr, &start, &process) ==
        0)
        return 121;
    WaitForSingleObject(process.hProcess, INFINITE);
    DWORD code = 122;
    GetExitCodeProcess(process.hProcess, &code);
    return static_cast<int>(code);
}
