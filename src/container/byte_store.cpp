#include "container/byte_store.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

namespace lamella {

void ByteStore::add(std::string_view bytes) {
    size_ += bytes.size();
    while (!bytes.empty()) {
        if (last_.capacity() < block_bytes && last_.size() + bytes.size() > last_.capacity())
            last_.reserve(std::min(block_bytes, std::max(2 * last_.capacity(), last_.size() + bytes.size())));
        const std::size_t part = std::min(bytes.size(), block_bytes - last_.size());
        last_.append(bytes.substr(0, part));
        bytes.remove_prefix(part);
        if (last_.size() < block_bytes)
            continue;
        if (blocks_.size() < most_blocks_) {
            blocks_.push_back(std::exchange(last_, {}));
        } else {
            if (!file_)
                file_.emplace();
            file_->write(spilled_, std::as_bytes(std::span(last_)));
            spilled_ += last_.size();
            last_.clear();
        }
    }
    assert(size_ == blocks_.size() * block_bytes + spilled_ + last_.size());
}

void ByteStore::read(std::uint64_t position, std::span<char> bytes) const {
    assert(position + bytes.size() <= size_);
    const std::uint64_t in_blocks = blocks_.size() * block_bytes;
    while (!bytes.empty()) {
        std::size_t part = 0;
        if (position < in_blocks) {
            const std::uint64_t within = position % block_bytes;
            part = std::min<std::uint64_t>(bytes.size(), block_bytes - within);
            std::memcpy(bytes.data(), blocks_[position / block_bytes].data() + within, part);
        } else if (position < in_blocks + spilled_) {
            const std::uint64_t within = position - in_blocks;
            part = std::min<std::uint64_t>(bytes.size(), spilled_ - within);
            file_->read(within, std::as_writable_bytes(bytes.first(part)));
        } else {
            part = bytes.size();
            std::memcpy(bytes.data(), last_.data() + (position - in_blocks - spilled_), part);
        }
        bytes = bytes.subspan(part);
        position += part;
    }
}

} // namespace lamella
