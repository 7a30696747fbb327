#pragma once

// What is often found under the name of a mesh file, and is none.

#include <string_view>

namespace lamella {

/// What such a file is, and what to do about it: the end of a sentence that begins with its name. Empty for
/// any other file.
[[nodiscard]] std::string_view foreign_advice(std::string_view text);

} // namespace lamella
