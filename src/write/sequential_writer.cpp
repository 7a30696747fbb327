#include "write/sequential_writer.hpp"

namespace lamella {

SequentialWriter::SequentialWriter(const std::string& path, const LayerFileInfo& info, std::string_view head,
                                   Holds holds)
    : OrderedWriter(info, holds), piece_(info.piece), file_layers_(info.layers) {
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

OrderedWriter::Write SequentialWriter::formatted(std::span<const Layer> parts) {
    const std::shared_ptr<ByteBuffer> text = buffer();
    format(parts, *text);
    return [this, text](const PlanePlace& place) {
        append_bytes(layer_head(place));
        append_bytes(text->view());
    };
}

void SequentialWriter::end_file() {
    if (piece_ == nullptr || piece_->before + piece_->layers == file_layers_)
        append_bytes(tail());
    if (file_)
        file_->commit();
}

} // namespace lamella
