#pragma once

// The build includes this header before every source for Windows (cmake/compile_options.cmake): in the
// standard library of GCC, a path gives its text in UTF-8, but takes each byte of a text as one character.

#include <filesystem>
#include <string>

extern "C" __declspec(dllimport) int __stdcall MultiByteToWideChar(unsigned, unsigned long, const char*, int,
                                                                   wchar_t*, int);

namespace std::filesystem {

template <>
inline auto path::_S_convert<char>(const char* first, const char* last) {
    constexpr unsigned utf8 = 65001;
    const auto size = static_cast<int>(last - first);
    std::wstring text(static_cast<std::size_t>(size), L'\0'); // at most one unit for each byte
    const int length = size == 0 ? 0 : ::MultiByteToWideChar(utf8, 0, first, size, text.data(), size);
    text.resize(static_cast<std::size_t>(length));
    return text;
}

} // namespace std::filesystem
