#pragma once

// The viewer that the program carries in itself: viewer/ as one HTML page.

#include <string_view>

namespace lamella::app {

/// "" where it was built without (viewer/CMakeLists.txt).
[[nodiscard]] std::string_view viewer_page() noexcept;
/// Why it was.
[[nodiscard]] std::string_view no_viewer() noexcept;

} // namespace lamella::app
