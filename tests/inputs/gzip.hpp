#pragma once

// Texts compressed by the program gzip.

#include "temporary_folder.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace lamella::test {

/// Returns the content compressed as a gzip file; "" if the program is missing.
inline std::string compressed(std::string_view content) {
    const TemporaryFolder folder;
    const std::string path = folder.file("content");
    std::ofstream(path, std::ios::binary) << content;
    if (std::system(fmt::format("gzip -n '{}'", path).c_str()) != 0)
        return {};
    std::ifstream file(path + ".gz", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

} // namespace lamella::test
