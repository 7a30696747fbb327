// In place of clipping.cpp where Clipper is missing, or was compiled for another standard library than this
// is.

#include "lamella/core/error.hpp"

#include "polygon/clipping.hpp"

namespace lamella {

std::vector<Ring> grown(std::span<const std::span<const Point2>> /*rings*/, double /*distance*/,
                        const ClippingGrid& /*grid*/) {
    throw Error(ErrorKind::usage,
                "this build of Lamella was made without Clipper, and cannot offset contours");
}

} // namespace lamella
