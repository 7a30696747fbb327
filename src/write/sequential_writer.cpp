#include "write/sequential_writer.hpp"

#include <cassert>

namespace lamella {

SequentialWriter::SequentialWriter(const std::string& path, const LayerFileInfo& info,
                                   std::string_view header, Holds holds)
    : OrderedWriter(info, holds), chunk_(info.chunk), file_layers_(info.layers) {
    if (chunk_ == nullptr)
        file_.emplace(path);
    if (chunk_ == nullptr || chunk_->before == 0)
        append_bytes(header);
}

void SequentialWriter::append_bytes(std::string_view bytes) {
    assert(file_.has_value() == (chunk_ == nullptr));
    if (chunk_ == nullptr) {
        file_->append(bytes);
        return;
    }
    chunk_bytes_ += bytes.size();
    chunk_->put(bytes);
}

OrderedWriter::Write SequentialWriter::formatted(const PlaneView& plane) {
    const std::shared_ptr<ByteBuffer> text = buffer();
    format(plane, *text);
    return [this, text](const PlanePosition& place) {
        append_bytes(layer_header(place));
        append_bytes(text->view());
    };
}

void SequentialWriter::end_file() {
    if (chunk_ == nullptr || chunk_->before + chunk_->layers == file_layers_)
        append_bytes(tail());
    if (file_)
        file_->commit();
}

} // namespace lamella
