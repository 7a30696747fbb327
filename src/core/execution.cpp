#include "lamella/core/execution.hpp"

namespace lamella {

const char* stage_name(Stage stage) noexcept {
    switch (stage) {
    case Stage::read:
        return "read";
    case Stage::weld:
        return "weld";
    case Stage::link:
        return "link";
    case Stage::slice:
        return "slice";
    case Stage::polygon:
        return "polygon";
    case Stage::write:
        return "write";
    }
    return "?";
}

} // namespace lamella
