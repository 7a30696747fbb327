#include "write/ordered_writer.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "contour/same_height.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <string>

namespace lamella {

PlanePosition plane_position(std::span<const Layer> parts) {
    const Layer& layer = parts.front();
    return {0, layer.index, layer.z, layer.bottom, layer.top};
}

void check_same_planes(std::span<const LayerStack> parts, const LayerFileInfo& info) {
    if (parts.size() != info.parts.size())
        throw Error(ErrorKind::usage, fmt::format("{} parts were announced and layers of {} are given",
                                                  info.parts.size(), parts.size()));
    const auto refuse = [&](std::size_t part, const std::string& difference) {
        throw Error(ErrorKind::usage, fmt::format("the part \"{}\" has other planes than the first one: {}",
                                                  excerpt(info.parts[part].label), difference));
    };
    const auto same = [](double a, double b) {
        return std::abs(a - b) <= same_height_mm;
    };
    for (std::size_t part = 1; part < parts.size(); ++part) {
        const LayerStack& first = parts.front();
        const LayerStack& other = parts[part];
        if (other.size() != first.size())
            refuse(part, fmt::format("{} layers, and not {}", other.size(), first.size()));
        for (std::size_t i = 0; i < first.size(); ++i) {
            const Layer& a = first[i];
            const Layer& b = other[i];
            if (a.index != b.index || !same(a.z, b.z) || !same(a.bottom, b.bottom) || !same(a.top, b.top))
                refuse(part, fmt::format("layer {} at z = {} mm (from {} to {}), and not layer {} at {} "
                                         "(from {} to {})",
                                         b.index, b.z, b.bottom, b.top, a.index, a.z, a.bottom, a.top));
        }
    }
}

PlaneOrder::PlaneOrder(const LayerFileInfo& info, Ascending ascending)
    : known_finite_(info.known_finite), before_(info.chunk != nullptr ? info.chunk->before : 0),
      announced_(info.chunk != nullptr ? info.chunk->layers : info.layers), parts_(info.parts.size()),
      ascending_(ascending) {}

void PlaneOrder::check_number(std::size_t parts) const {
    if (parts != parts_)
        throw Error(ErrorKind::usage,
                    fmt::format("{} parts were announced and a plane has layers of {}", parts_, parts));
}

void PlaneOrder::check_parts(std::span<const Layer> parts) const {
    check_number(parts.size());
    if (!known_finite_)
        for (const Layer& layer : parts)
            check(layer);
}

void PlaneOrder::check_parts(const ScanVectors& vectors) const {
    check_number(vectors.exposures());
    if (!known_finite_)
        check(vectors);
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

Commit OrderedWriter::prepare(std::span<const Layer> parts) {
    order_.check_parts(parts);
    return prepare_view({parts});
}

Commit OrderedWriter::prepare(const ScanVectors& vectors) {
    order_.check_parts(vectors);
    return prepare_view({vectors.polylines, vectors.hatches});
}

Commit OrderedWriter::prepare_view(const PlaneView& plane) {
    return [this, write = formatted(plane), losses = losses_of_plane(plane),
            offset = plane_position(plane.layers)](Completions& after) mutable {
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
