#pragma once

// Chooses the folder of scratch files.

#include "fixtures/environment.hpp"
#include "system/nameless_file.hpp"

#include <string>

namespace lamella::test {

/// Scratch files are in this folder while this object lives.
class ScratchFolder {
  public:
    explicit ScratchFolder(const std::string& path)
        : variable_(std::string(scratch_variable()), path, scratch_folder()) {}

  private:
    EnvironmentVariable variable_;
};

} // namespace lamella::test
