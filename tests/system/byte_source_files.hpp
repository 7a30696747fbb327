#pragma once

// What the tests of byte sources share.

#include "fixtures/expect_error.hpp"
#include "system/byte_source.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>
#include <functional>
#include <string>

namespace lamella::test {

/// A folder with files of known bytes.
class ByteSourceFiles : public testing::Test {
  protected:
    [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }

    /// Returns the path.
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name), std::ios::binary) << text;
        return path(name);
    }

  private:
    TemporaryFolder folder_;
};

inline std::string text_of(const ByteSource& source) {
    return {reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size()};
}

/// Returns the text of the error of an input.
inline std::string input_error_of(const std::function<void()>& action) {
    return error_of(ErrorKind::input, action);
}

inline std::string some_text(std::size_t size) {
    std::string text(size, ' ');
    for (std::size_t i = 0; i < size; ++i)
        text[i] = static_cast<char>('a' + i * i % 23);
    return text;
}

} // namespace lamella::test
