#include "lamella/core/execution.hpp"

#include <array>
#include <cassert>
#include <cstddef>

namespace lamella {

const char* stage_name(Stage stage) noexcept {
    constexpr std::array names{"read", "weld", "link", "slice", "polygon", "write"};
    assert(static_cast<std::size_t>(stage) < names.size());
    return names[static_cast<std::size_t>(stage)];
}

} // namespace lamella
