#pragma once

// A sample archive, and Python's reader of zip archives, which is independent of ours.

#include "container/deflate.hpp"
#include "container/inflate.hpp"
#include "container/zip_writer.hpp"

#include <cstddef>
#include <cstdio>
#include <string>

namespace lamella::zip_test {

/// Returns the output of a Python program that is given the path.
inline std::string python(const std::string& program, const std::string& path) {
    const std::string command = "python3 -c '" + program + "' '" + path + "' 2>&1";
    std::FILE* const pipe = popen(command.c_str(), "r");
    if (pipe == nullptr)
        return "no python3";
    std::string output;
    char part[4096];
    while (const std::size_t size = std::fread(part, 1, sizeof part, pipe))
        output.append(part, size);
    pclose(pipe);
    return output;
}

/// Writes entries of all kinds.
inline void write_sample(const std::string& path) {
    ZipWriter zip(path, Overwriting::yes);
    zip.add("plain", "content");
    zip.add("folder/empty", "");
    zip.add("d\xc3\xa9j\xc3\xa0", std::string(10'000, 'x'), ZipMethod::deflated);
    zip.add("none", "", ZipMethod::deflated);
    zip.begin("stream", ZipMethod::deflated);
    Deflater deflater;
    for (int i = 0; i < 10; ++i) {
        const std::string text(static_cast<std::size_t>(i) * 1000, static_cast<char>('a' + i));
        std::string chunk;
        deflater.append_chunk(text, chunk);
        zip.append({chunk, text.size(), crc32_of(text)});
    }
    zip.end();
    zip.begin("stored stream", ZipMethod::stored);
    zip.append_stored("in two ");
    zip.append_stored("pieces");
    zip.end();
    zip.begin("empty stream", ZipMethod::deflated);
    zip.end();
    zip.finish();
}

} // namespace lamella::zip_test
