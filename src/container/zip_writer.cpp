// PKWARE's APPNOTE.TXT, version 6.3: 4.3 has the order of the records, 4.4 their fields, 4.5.3 the extra
// field of zip64.

#include "container/zip_writer.hpp"

#include "container/deflate.hpp"
#include "container/inflate.hpp"
#include "container/zip_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace lamella {

namespace {

// What a reader has to understand: 2.0 is Deflate and folders, 4.5 is zip64.
constexpr unsigned version_plain = 20;
constexpr unsigned version_zip64 = 45;

constexpr unsigned flag_utf8_name = 1U << 11;
constexpr unsigned midnight = 0;
constexpr unsigned first_of_january_1980 = (0U << 9) | (1U << 5) | 1U;
constexpr unsigned zip64_extra = 1;

// Little-endian numbers.
class Record {
  public:
    Record& u16(std::uint64_t value) { return put(value, 2); }
    Record& u32(std::uint64_t value) { return put(value, 4); }
    Record& u64(std::uint64_t value) { return put(value, 8); }
    Record& text(std::string_view text) {
        bytes_ += text;
        return *this;
    }
    [[nodiscard]] std::string_view view() const noexcept { return bytes_; }

  private:
    Record& put(std::uint64_t value, int bytes) {
        for (int i = 0; i < bytes; ++i)
            bytes_ += static_cast<char>(value >> (8 * i));
        return *this;
    }

    std::string bytes_;
};

unsigned flags(std::string_view name, bool sizes_behind) {
    const bool plain = std::all_of(name.begin(), name.end(), [](char c) { return (c & 0x80) == 0; });
    return (plain ? 0U : flag_utf8_name) | (sizes_behind ? flag_sizes_behind : 0U);
}

// In front of a stored entry of any size.
std::string large_head(std::string_view name, std::uint64_t size, std::uint32_t crc) {
    Record head;
    head.u32(0x04034b50).u16(version_zip64).u16(flags(name, false));
    head.u16(static_cast<std::uint64_t>(ZipMethod::stored)).u16(midnight).u16(first_of_january_1980);
    head.u32(crc).u32(full32).u32(full32).u16(name.size()).u16(20).text(name);
    head.u16(zip64_extra).u16(16).u64(size).u64(size);
    return std::string(head.view());
}

std::uint64_t capped(std::uint64_t value) {
    return std::min(value, full32);
}

} // namespace

ZipWriter::ZipWriter(std::string path, Overwriting overwriting) : file_(std::move(path), overwriting) {}

void ZipWriter::add(std::string_view name, std::string_view content, ZipMethod method) {
    const std::uint32_t crc = crc32_of(content);
    if (method == ZipMethod::stored) {
        add_ready(name, method, {content, content.size(), crc});
        return;
    }
    std::string stream;
    Deflater().append_piece(content, stream);
    stream += deflate_end;
    add_ready(name, method, {stream, content.size(), crc});
}

void ZipWriter::add_ready(std::string_view name, ZipMethod method, const ZipPiece& content) {
    if (open_)
        throw Error(ErrorKind::internal, fmt::format("zip entry '{}' begins within another", name));
    const bool large = content.size >= full32 || content.bytes.size() >= full32;
    Record extra;
    if (large)
        extra.u16(zip64_extra).u16(16).u64(content.size).u64(content.bytes.size());
    entries_.push_back(
        {std::string(name), method, false, content.crc, content.bytes.size(), content.size, file_.bytes()});
    Record head;
    head.u32(0x04034b50).u16(large ? version_zip64 : version_plain).u16(flags(name, false));
    head.u16(static_cast<std::uint64_t>(method)).u16(midnight).u16(first_of_january_1980).u32(content.crc);
    head.u32(large ? full32 : content.bytes.size()).u32(large ? full32 : content.size);
    head.u16(name.size()).u16(extra.view().size()).text(name).text(extra.view());
    file_.append(head.view());
    file_.append(content.bytes);
}

void ZipWriter::begin(std::string_view name, ZipMethod method, bool may_be_large) {
    if (open_)
        throw Error(ErrorKind::internal, fmt::format("zip entry '{}' begins within another", name));
    open_ = true;
    open_is_large_ = may_be_large;
    entries_.push_back({std::string(name), method, true, 0, 0, 0, file_.bytes()});
    Record extra;
    if (may_be_large) // what is behind has 64 bits, then
        extra.u16(zip64_extra).u16(16).u64(0).u64(0);
    Record head;
    head.u32(0x04034b50).u16(may_be_large ? version_zip64 : version_plain).u16(flags(name, true));
    head.u16(static_cast<std::uint64_t>(method)).u16(midnight).u16(first_of_january_1980).u32(0);
    head.u32(may_be_large ? full32 : 0).u32(may_be_large ? full32 : 0);
    head.u16(name.size()).u16(extra.view().size()).text(name).text(extra.view());
    file_.append(head.view());
}

void ZipWriter::append(const ZipPiece& piece) {
    Entry& entry = entries_.back();
    entry.crc = crc32_joined(entry.crc, piece.crc, piece.size);
    entry.stored_size += piece.bytes.size();
    entry.size += piece.size;
    file_.append(piece.bytes);
}

void ZipWriter::append_stored(std::string_view content) {
    append({content, content.size(), crc32_of(content)});
}

void ZipWriter::end() {
    open_ = false;
    Entry& entry = entries_.back();
    if (entry.method == ZipMethod::deflated) {
        file_.append(deflate_end);
        entry.stored_size += deflate_end.size();
    }
    Record descriptor;
    descriptor.u32(0x08074b50).u32(entry.crc);
    if (open_is_large_ || entry.size >= full32 || entry.stored_size >= full32)
        descriptor.u64(entry.stored_size).u64(entry.size);
    else
        descriptor.u32(entry.stored_size).u32(entry.size);
    file_.append(descriptor.view());
}

void ZipWriter::begin_headed(std::string_view name, std::size_t head_size) {
    if (open_)
        throw Error(ErrorKind::internal, fmt::format("zip entry '{}' begins within another", name));
    open_ = true;
    entries_.push_back({std::string(name), ZipMethod::stored, false, 0, 0, 0, file_.bytes()});
    file_.append(large_head(name, 0, 0));
    file_.append(std::string(head_size, '\0'));
}

void ZipWriter::end_headed(std::string_view head) {
    open_ = false;
    Entry& entry = entries_.back();
    entry.crc = crc32_joined(crc32_of(head), entry.crc, entry.size);
    entry.size += head.size();
    entry.stored_size = entry.size;
    file_.overwrite(entry.place, large_head(entry.name, entry.size, entry.crc) + std::string(head));
}

void ZipWriter::append_directory() {
    for (const Entry& entry : entries_) {
        // Only those that do not fit, in this order.
        Record large;
        for (const std::uint64_t value : {entry.size, entry.stored_size, entry.place})
            if (value >= full32)
                large.u64(value);
        Record extra;
        if (!large.view().empty())
            extra.u16(zip64_extra).u16(large.view().size()).text(large.view());
        const unsigned version = large.view().empty() ? version_plain : version_zip64;
        Record record;
        record.u32(0x02014b50).u16(version).u16(version).u16(flags(entry.name, entry.sizes_behind));
        record.u16(static_cast<std::uint64_t>(entry.method)).u16(midnight).u16(first_of_january_1980);
        record.u32(entry.crc).u32(capped(entry.stored_size)).u32(capped(entry.size));
        record.u16(entry.name.size()).u16(extra.view().size());
        record.u16(0).u16(0).u16(0).u32(0); // no comment, first disk, no attributes
        record.u32(capped(entry.place)).text(entry.name).text(extra.view());
        file_.append(record.view());
    }
}

void ZipWriter::finish() {
    if (open_)
        throw Error(ErrorKind::internal, fmt::format("zip entry '{}' was not ended", entries_.back().name));
    const std::uint64_t place = file_.bytes();
    append_directory();
    const std::uint64_t size = file_.bytes() - place;
    const std::uint64_t count = entries_.size();
    if (count >= full16 || size >= full32 || place >= full32) {
        constexpr unsigned rest_of_record = 44;
        Record record;
        record.u32(0x06064b50).u64(rest_of_record).u16(version_zip64).u16(version_zip64).u32(0).u32(0);
        record.u64(count).u64(count).u64(size).u64(place);
        record.u32(0x07064b50).u32(0).u64(place + size).u32(1);
        file_.append(record.view());
    }
    Record end;
    end.u32(0x06054b50).u16(0).u16(0).u16(std::min(count, full16)).u16(std::min(count, full16));
    end.u32(capped(size)).u32(capped(place)).u16(0);
    file_.append(end.view());
    file_.commit();
}

} // namespace lamella
