#include "meshes/stl_attributes.hpp"

#include "meshes/stl_binary.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

namespace lamella {

namespace {

constexpr std::size_t attribute_count_at = 48; // in a record

/// Reads a source from front to back. A source in windows is read in larger steps.
class Forward {
  public:
    explicit Forward(const ByteSource& source) : source_(source) {}

    /// Returns `count` bytes (at most a record) at an offset that is not less than any before, or no bytes if
    /// they are not all there.
    std::span<const std::byte> at(std::uint64_t offset, std::size_t count) {
        if (offset + count > source_.size())
            return {};
        if (source_.bytes.size() == source_.size())
            return source_.bytes.subspan(offset, count);
        if (offset < begin_ || offset + count > begin_ + window_.size()) {
            begin_ = offset;
            window_.resize(std::min<std::uint64_t>(std::size_t{1} << 20, source_.size() - offset));
            copy_out(source_, begin_, window_);
        }
        return std::span<const std::byte>(window_).subspan(offset - begin_, count);
    }

  private:
    const ByteSource& source_;
    std::vector<std::byte> window_;
    std::uint64_t begin_ = 0;
};

std::uint64_t attribute_bytes(std::span<const std::byte> count) {
    std::uint16_t number = 0;
    std::memcpy(&number, count.data(), sizeof number);
    return number;
}

} // namespace

bool has_attribute_bytes(const ByteSource& source) {
    if (source.size() < stl_header_bytes)
        return false;
    const std::uint64_t triangles = stl_declared_count(source.bytes);
    std::uint64_t offset = stl_header_bytes;
    if (source.size() <= offset + triangles * stl_record_bytes)
        return false;
    Forward file(source);
    for (std::uint64_t i = 0; i < triangles; ++i) {
        const auto count = file.at(offset + attribute_count_at, sizeof(std::uint16_t));
        if (count.empty())
            return false;
        offset += stl_record_bytes + attribute_bytes(count);
    }
    return offset == source.size();
}

ByteSource without_attribute_bytes(const ByteSource& source, ReadLimits& limits) {
    const std::uint64_t triangles = stl_declared_count(source.bytes);
    const std::uint64_t size = stl_header_bytes + triangles * stl_record_bytes;
    limits.add_bytes(size);
    const auto bytes = std::make_shared<std::vector<std::byte>>(size);
    const std::span<std::byte> to(*bytes);
    copy_out(source, 0, to.first(stl_header_bytes));
    Forward file(source);
    std::uint64_t offset = stl_header_bytes;
    for (std::uint64_t i = 0; i < triangles; ++i) {
        const auto record = file.at(offset, stl_record_bytes);
        std::copy(record.begin(), record.end(),
                  to.begin() + static_cast<std::ptrdiff_t>(stl_header_bytes + i * stl_record_bytes));
        offset += stl_record_bytes + attribute_bytes(record.subspan(attribute_count_at));
    }
    return {.name = source.name, .bytes = to, .owner = bytes};
}

} // namespace lamella
