#pragma once

// Collects warnings about a file, which are errors for strict callers.

#include "lamella/core/error.hpp"

#include "core/counted.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

/// The number of occurrences of an irregularity in a file, and the first one.
struct Occurrences {
    std::uint64_t count = 0;
    std::size_t first = 0; ///< byte or line

    void note(std::size_t location) {
        if (count++ == 0)
            first = location;
    }
    /// Adds the occurrences in a later part of the file.
    void add(const Occurrences& later) {
        first = count == 0 ? later.first : first;
        count += later.count;
    }
};

/// Collects warnings, one line each. For a strict caller the first one is an error.
class Remarks {
  public:
    Remarks(std::string file_name, bool strict) : file_name_(std::move(file_name)), strict_(strict) {}

    [[nodiscard]] const std::string& file_name() const noexcept { return file_name_; }

    /// Adds a warning; throws Error{defect} if strict.
    void add(std::string text) {
        if (strict_)
            throw Error(ErrorKind::defect, file_name_ + ": " + text);
        texts_.push_back(std::move(text));
    }

    /// Adds a note. Notes follow the warnings and are not errors for strict callers.
    void note(std::string text) { notes_.push_back(std::move(text)); }

    [[nodiscard]] std::vector<std::string> take() {
        for (std::string& note : std::exchange(notes_, {}))
            texts_.push_back(std::move(note));
        return std::exchange(texts_, {});
    }

  private:
    std::string file_name_;
    bool strict_;
    std::vector<std::string> texts_;
    std::vector<std::string> notes_;
};

/// Warns that `count` of `stored` triangles (`count` is not 0) were skipped, the first at `location`. Throws
/// Error{input} if no triangle is left.
inline void report_nonfinite(Remarks& remarks, std::string_view location, std::uint64_t count,
                             std::uint64_t stored) {
    if (count == stored)
        throw Error(ErrorKind::input,
                    fmt::format("{}: {}: holds no usable triangle: each of the {} has a corner that is NaN "
                                "or infinite",
                                remarks.file_name(), location, stored));
    remarks.add(fmt::format("{}: left out {} of {} triangles, which have a corner that is NaN or infinite "
                            "(this is the first)",
                            location, count, stored));
}

/// Warns that `count` faces (not 0) were skipped, the first at `location`.
inline void report_thin_faces(Remarks& remarks, std::string_view location, std::uint64_t count) {
    remarks.add(fmt::format("{}: left out {} of fewer than three corners (this is the first)", location,
                            counted(count, "face")));
}

} // namespace lamella
