#include "lamella/core/version.hpp"

namespace lamella {

const char* version() noexcept {
    return LAMELLA_VERSION;
}

} // namespace lamella
