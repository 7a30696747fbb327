#pragma once

// Chooses the folder of scratch files.

#include "system/nameless_file.hpp"

#include <cstdlib>
#include <string>

namespace lamella::test {

/// Scratch files are in this folder while this object lives.
class ScratchFolder {
  public:
    explicit ScratchFolder(const std::string& path) : before_(scratch_folder()) { choose(path); }
    ~ScratchFolder() { choose(before_); }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

  private:
    static void choose(const std::string& path) {
        // The environment refers to this text from now on.
        static std::string assignment;
        static std::string previous;
        previous.swap(assignment);
        assignment = std::string(scratch_variable()) + "=" + path;
        putenv(assignment.data());
    }

    std::string before_;
};

} // namespace lamella::test
