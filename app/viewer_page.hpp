#pragma once

// The viewer that is built into the program: the contents of viewer/ as one HTML page.

#include <string_view>

namespace lamella::app {

/// Returns the page; "" if the program was built without it (viewer/CMakeLists.txt).
[[nodiscard]] std::string_view viewer_page() noexcept;
/// Returns the reason why viewer_page() is empty.
[[nodiscard]] std::string_view no_viewer() noexcept;

} // namespace lamella::app
