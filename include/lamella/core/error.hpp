#pragma once

// The one exception type of the library and the short closed list of its kinds.

#include "lamella/core/api.hpp"

#include <stdexcept>
#include <string>

LAMELLA_API_BEGIN
namespace lamella {

/// What went wrong, in the classes that a caller treats differently. The program's exit codes follow it.
enum class ErrorKind {
    internal,  ///< a broken promise of Lamella itself; please report it
    usage,     ///< arguments that contradict themselves or cannot be met
    input,     ///< a file that cannot be read or holds nothing to slice
    defect,    ///< a defect of the mesh or the layers, where the caller asked for none (strict)
    limit,     ///< a limit was hit: time, triangles, memory, index range
    output,    ///< a file that cannot be written; nothing was left at its path
    cancelled, ///< the caller asked to stop
};

/// Every failure that Lamella reports. what() is one line for a person: the file, the place in it (byte or
/// line), what was found and what was expected. Where it speaks of a field of the options that the caller
/// gave, the field's name stands between backquotes, as in `max_memory`: a program puts its own name there.
class Error : public std::runtime_error {
  public:
    Error(ErrorKind kind, const std::string& text) : std::runtime_error(text), kind_(kind) {}

    [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }

  private:
    ErrorKind kind_;
};

} // namespace lamella
LAMELLA_API_END
