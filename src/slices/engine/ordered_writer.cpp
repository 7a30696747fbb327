#include "slices/engine/ordered_writer.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "contour/same_height.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <string>

namespace lamella {

PlanePosition plane_position(const Plane& plane) {
    const Layer& layer = plane.polylines.front();
    return {0, layer.index, layer.z, layer.bottom, layer.top};
}

PlaneOrder::PlaneOrder(const LayerFileInfo& info, Ascending ascending)
    : known_finite_(info.known_finite), before_(info.chunk != nullptr ? info.chunk->before : 0),
      announced_(info.chunk != nullptr ? info.chunk->layers : info.layers), parts_(info.parts.size()),
      ascending_(ascending) {}

void PlaneOrder::check_parts(const Plane& plane) const {
    if (plane.parts() != parts_)
        throw Error(ErrorKind::usage, fmt::format("{} parts were announced and a plane has layers of {}",
                                                  parts_, plane.parts()));
    if (!known_finite_)
        check(plane);
}

void PlaneOrder::next(PlanePosition& plane) {
    if (count_ > 0 && !(plane.z > last_.z))
        throw Error(
            ErrorKind::usage,
            fmt::format("layers must be written in ascending z: z = {} follows z = {}", plane.z, last_.z));
    if (count_ > 0 && ascending_ == Ascending::z_and_index && plane.index <= last_.index)
        throw Error(ErrorKind::usage,
                    fmt::format("the layer with index {} follows the one with {}", plane.index, last_.index));
    plane.position = before_ + count_++;
    last_ = plane;
}

void PlaneOrder::end() const {
    if (count_ != announced_)
        throw Error(ErrorKind::usage,
                    fmt::format("{} layers were announced and {} were written", announced_, count_));
}

Commit OrderedWriter::prepare(const Plane& plane) {
    order_.check_parts(plane);
    return [this, write = formatted(plane), losses = losses_of_plane(plane),
            offset = plane_position(plane)](Completions& after) mutable {
        order_.next(offset);
        left_out_.add(losses);
        write(offset, after);
    };
}

void OrderedWriter::finish() {
    order_.end();
    end_file();
}

} // namespace lamella
