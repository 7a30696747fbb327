#pragma once

// The only exception type of the library, with a closed list of kinds.

#include "lamella/core/api.hpp"

#include <stdexcept>
#include <string>

LAMELLA_API_BEGIN
namespace lamella {

/// The kinds of failures that a caller treats differently. The program's exit codes follow them.
enum class ErrorKind {
    internal,  ///< an error in Lamella itself; please report it
    usage,     ///< arguments that contradict one another or cannot be satisfied
    input,     ///< a file that cannot be read or contains nothing to slice
    defect,    ///< a defect of the mesh or the layers, if the caller accepts none (strict)
    limit,     ///< a limit was hit: time, triangles, memory, index range
    output,    ///< a file that cannot be written; nothing was left at its path
    cancelled, ///< the caller asked to stop
};

/// Every failure that Lamella reports. what() is one line for a person: the file, the byte or line in it,
/// what was found and what was expected. If the line mentions a field of the options, the field's name is
/// between backquotes, as in `max_memory`, so that a program can replace the name by that of its own option.
class Error : public std::runtime_error {
  public:
    Error(ErrorKind kind, const std::string& text, int system_error = 0)
        : std::runtime_error(text), kind_(kind), system_error_(system_error) {}

    [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }
    /// Returns the error of the operating system (an errno) if that is the cause, otherwise 0.
    [[nodiscard]] int system_error() const noexcept { return system_error_; }

  private:
    ErrorKind kind_;
    int system_error_;
};

} // namespace lamella
LAMELLA_API_END
