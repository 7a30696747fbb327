#pragma once

// The viewer that is built into the programs and the Python module: the contents of viewer/ as one HTML page.

#include <string_view>

namespace lamella {

/// Returns the page; "" if it was not built (viewer/CMakeLists.txt).
[[nodiscard]] std::string_view viewer_page() noexcept;
/// Returns the reason why viewer_page() is empty.
[[nodiscard]] std::string_view no_viewer() noexcept;

} // namespace lamella
