#include "slices/engine/sequential_writer.hpp"

#include "container/gzip.hpp"

#include <cassert>
#include <utility>

namespace lamella {

SequentialWriter::SequentialWriter(const std::string& path, const LayerFileInfo& info,
                                   std::string_view header, Holds holds)
    : OrderedWriter(info, holds), compressed_(info.memory == nullptr && has_gzip_extension(path)),
      chunk_(info.chunk), file_layers_(info.layers) {
    if (chunk_ == nullptr)
        file_.emplace(path, Overwriting::no, info.memory);
    if (chunk_ == nullptr || chunk_->before == 0)
        append_bytes(header);
}

/// Appends bytes to the file or range. Without an owner, they are copied or written before this returns.
void SequentialWriter::append_bytes(std::string_view bytes, std::shared_ptr<const void> owner,
                                    Completions& after) {
    assert(file_.has_value() == (chunk_ == nullptr));
    if (chunk_ != nullptr) {
        chunk_bytes_ += bytes.size();
        chunk_->put(bytes, std::move(owner), after);
    } else if (owner) {
        file_->append(bytes, std::move(owner), after);
    } else {
        file_->append(bytes);
    }
}

void SequentialWriter::append_bytes(std::string_view bytes) {
    Completions none;
    append_bytes(compressed_ ? std::string_view(gzip_member(bytes)) : bytes, nullptr, none);
    assert(none.empty());
}

OrderedWriter::Write SequentialWriter::formatted(const Plane& plane) {
    const std::shared_ptr<ByteBuffer> text = buffer();
    format(plane, *text);
    std::shared_ptr<const void> owner = text;
    std::string_view bytes = text->view();
    if (compressed_) {
        const auto member = std::make_shared<const std::string>(gzip_member(bytes));
        owner = member;
        bytes = *member;
    }
    return [this, owner, bytes](const PlanePosition& place, Completions& after) {
        append_bytes(layer_header(place));
        append_bytes(bytes, owner, after);
    };
}

void SequentialWriter::end_file() {
    if (chunk_ == nullptr || chunk_->before + chunk_->layers == file_layers_)
        append_bytes(tail());
    if (file_)
        file_->commit();
}

} // namespace lamella
