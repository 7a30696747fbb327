#include "write/sequential_writer.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"

#include <fmt/format.h>

namespace lamella {

void LayerOrder::check_parts(std::size_t parts) const {
    if (parts != parts_)
        throw Error(ErrorKind::usage,
                    fmt::format("{} parts were announced and a plane has layers of {}", parts_, parts));
}

void LayerOrder::next(double z) {
    if (count_ > 0 && !(z > last_z_))
        throw Error(ErrorKind::usage,
                    fmt::format("layers must be written in ascending z: z = {} follows z = {}", z, last_z_));
    last_z_ = z;
    ++count_;
}

void LayerOrder::next(double z, std::uint64_t index) {
    next(z);
    if (count_ > 1 && index <= last_index_)
        throw Error(ErrorKind::usage,
                    fmt::format("the layer with index {} follows the one with {}", index, last_index_));
    last_index_ = index;
}

void LayerOrder::end() const {
    if (count_ != announced_)
        throw Error(ErrorKind::usage,
                    fmt::format("{} layers were announced and {} were written", announced_, count_));
}

std::vector<MeasuredRing> measured_rings(const Layer& layer) {
    std::vector<MeasuredRing> rings(layer.rings);
    for (std::size_t i = 0; i < rings.size(); ++i)
        rings[i] = {i, ring_area(layer.contour(i))};
    return rings;
}

SequentialWriter::SequentialWriter(const std::string& path, const LayerFileInfo& info, std::string_view head,
                                   Holds holds)
    : piece_(info.piece), file_layers_(info.layers), order_(info), left_out_(holds) {
    if (piece_ == nullptr)
        file_.emplace(path);
    if (piece_ == nullptr || piece_->before == 0)
        append_bytes(head);
}

void SequentialWriter::append_bytes(std::string_view bytes) {
    if (piece_ == nullptr) {
        file_->append(bytes);
        return;
    }
    piece_bytes_ += bytes.size();
    piece_->put(bytes);
}

std::function<void()> SequentialWriter::prepare(std::span<const Layer> parts) {
    order_.check_parts(parts.size());
    const std::shared_ptr<ByteBuffer> buffer = buffers_->take();
    format(parts, *buffer);
    const Layer& layer = parts.front();
    return [this, buffer, extras = extras_of(parts), index = layer.index, z = layer.z, bottom = layer.bottom,
            top = layer.top] {
        order_.next(z);
        left_out_.note(extras);
        const std::uint64_t before = piece_ != nullptr ? piece_->before : 0;
        append_bytes(layer_head({before + order_.count() - 1, index, z, bottom, top}));
        append_bytes(buffer->view());
    };
}

void SequentialWriter::finish() {
    order_.end();
    if (piece_ == nullptr || piece_->before + piece_->layers == file_layers_)
        append_bytes(tail());
    if (file_)
        file_->commit();
}

} // namespace lamella
