#pragma once

// What the tests of files and folders that appear complete or not at all share.

#include "fixtures/expect_error.hpp"
#include "system/atomic_directory.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lamella::test {

using Names = std::vector<std::string>;

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// Returns the text of the error of an output.
inline std::string output_error_of(const std::function<void()>& action) {
    return error_of(ErrorKind::output, action);
}

/// Whether a folder of layers may hold this file.
inline bool is_layer(const std::filesystem::path& path) {
    return path.extension() == ".svg";
}

/// Returns the error of a folder of layers.
inline std::string error_of_folder(const std::string& path) {
    return output_error_of([&] { const AtomicDirectory directory(path, is_layer); });
}

} // namespace lamella::test
