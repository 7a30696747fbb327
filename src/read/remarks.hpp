#pragma once

// What is odd about a file, and that strict callers will not have it.

#include "lamella/core/error.hpp"

#include <string>
#include <utility>
#include <vector>

namespace lamella {

/// Collects warnings, one line each; for a strict caller the first one is an error instead.
class Remarks {
  public:
    Remarks(std::string file_name, bool strict) : file_name_(std::move(file_name)), strict_(strict) {}

    /// Throws Error{defect} when strict.
    void add(std::string text) {
        if (strict_)
            throw Error(ErrorKind::defect, file_name_ + ": " + text);
        texts_.push_back(std::move(text));
    }

    [[nodiscard]] std::vector<std::string> take() { return std::exchange(texts_, {}); }

  private:
    std::string file_name_;
    bool strict_;
    std::vector<std::string> texts_;
};

} // namespace lamella
