// In the place of the page, in a build without it.

#include "viewer_page.hpp"

std::string_view lamella::app::viewer_page() noexcept {
    return {};
}
