// PKWARE's APPNOTE.TXT, version 6.3: 4.3 has the order of the records, 4.4 their fields, 4.5.3 the extra
// field of zip64.

#include "container/zip_writer.hpp"

#include "container/deflate.hpp"
#include "container/inflate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace lamella {

namespace {

// Versions that a reader must support: 2.0 for Deflate and folders, 4.5 for zip64.
constexpr unsigned version_plain = 20;
constexpr unsigned version_zip64 = 45;

constexpr unsigned flag_utf8_name = 1U << 11;
constexpr unsigned midnight = 0;
constexpr unsigned first_of_january_1980 = (0U << 9) | (1U << 5) | 1U;

// Little-endian encoder.
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

std::uint64_t capped(std::uint64_t value) {
    return std::min(value, full32);
}

// Returns the extra field for 64-bit sizes; empty if there are none.
Record zip64_extra(const Record& sizes) {
    Record extra;
    if (!sizes.view().empty())
        extra.u16(1).u16(sizes.view().size()).text(sizes.view());
    return extra;
}

// Writes the fields after the version that the entry's header and its directory record have in common.
void put_common(const ZipEntry& entry, std::uint64_t compressed_size, std::uint64_t size, const Record& extra,
                Record& to) {
    to.u16(entry.flags)
        .u16(static_cast<std::uint64_t>(entry.method))
        .u16(midnight)
        .u16(first_of_january_1980);
    to.u32(entry.crc).u32(compressed_size).u32(size).u16(entry.name.size()).u16(extra.view().size());
}

bool is_large(const ZipEntry& entry) {
    return entry.size >= full32 || entry.compressed_size >= full32;
}

// Returns the header of an entry. A large entry has 64-bit sizes. `room` reserves space for them if the size
// is not yet known; if they are not needed, the space becomes a growth hint of Open Packaging (0xA220).
std::string header_of(const ZipEntry& entry, bool room = false) {
    const bool large = is_large(entry);
    Record sizes;
    if (large)
        sizes.u64(entry.size).u64(entry.compressed_size);
    Record extra = zip64_extra(sizes);
    if (room && !large)
        extra.u16(0xA220).u16(16).u16(0xA028).u16(0).u64(0).u32(0);
    Record header;
    header.u32(zip_entry_signature).u16(large ? version_zip64 : version_plain);
    put_common(entry, large ? full32 : entry.compressed_size, large ? full32 : entry.size, extra, header);
    header.text(entry.name).text(extra.view());
    return std::string(header.view());
}

} // namespace

ZipWriter::ZipWriter(std::string path, Overwriting overwriting, std::string* memory)
    : file_(std::move(path), overwriting, memory) {}

void ZipWriter::add(std::string_view name, std::string_view content, ZipMethod method) {
    const std::uint32_t crc = crc32_of(content);
    const std::string compressed = method == ZipMethod::stored ? std::string() : deflated(content);
    const std::string_view bytes = method == ZipMethod::stored ? content : compressed;
    append_header(name, method, {bytes, content.size(), crc});
    file_.append(bytes);
}

ZipEntry& ZipWriter::add_entry(std::string_view name, ZipMethod method, bool sizes_behind) {
    if (open_)
        throw Error(ErrorKind::internal, fmt::format("zip entry '{}' begins within another", name));
    const bool plain = std::all_of(name.begin(), name.end(), [](char c) { return (c & 0x80) == 0; });
    ZipEntry& entry = entries_.emplace_back();
    entry.name = name;
    entry.method = method;
    entry.flags =
        static_cast<std::uint16_t>((plain ? 0U : flag_utf8_name) | (sizes_behind ? flag_sizes_behind : 0U));
    entry.offset = file_.bytes();
    return entry;
}

void ZipWriter::append_header(std::string_view name, ZipMethod method, const ZipChunk& content) {
    ZipEntry& entry = add_entry(name, method, false);
    entry.size = content.size;
    entry.compressed_size = content.bytes.size();
    entry.crc = content.crc;
    file_.append(header_of(entry));
}

void ZipWriter::add_ready(std::string_view name, ZipMethod method, const ZipChunk& content,
                          std::shared_ptr<const void> owner, Completions& after) {
    append_header(name, method, content);
    file_.append(content.bytes, std::move(owner), after);
}

void ZipWriter::begin(std::string_view name, ZipMethod method, std::size_t header_size) {
    const bool stored = method == ZipMethod::stored;
    const ZipEntry& entry = add_entry(name, method, !stored);
    open_ = true;
    file_.append(header_of(entry, stored));
    file_.append(std::string(header_size, '\0'));
}

void ZipWriter::add_sum(const ZipChunk& chunk) {
    sums_.push_back({chunk.crc, chunk.size});
    entries_.back().compressed_size += chunk.bytes.size();
}

void ZipWriter::append(const ZipChunk& chunk) {
    add_sum(chunk);
    file_.append(chunk.bytes);
}

void ZipWriter::append(const ZipChunk& chunk, std::shared_ptr<const void> owner, Completions& after) {
    add_sum(chunk);
    file_.append(chunk.bytes, std::move(owner), after);
}

void ZipWriter::append_stored(std::string_view content) {
    append({content, content.size(), crc32_of(content)});
}

void ZipWriter::append_stored(std::string_view content, std::shared_ptr<const void> owner,
                              Completions& after) {
    Completions writes;
    file_.append(content, owner, writes);
    if (writes.empty())
        return add_sum({content, content.size(), crc32_of(content)});
    add_sum({content, content.size(), 0});
    after.emplace_back([&sum = sums_.back(), content, owner = std::move(owner), writes = std::move(writes)] {
        sum.crc = crc32_of(content);
        for (const auto& write : writes)
            write();
    });
}

void ZipWriter::end(std::string_view header) {
    open_ = false;
    ZipEntry& entry = entries_.back();
    for (const Sum& sum : std::exchange(sums_, {})) {
        entry.crc = crc32_joined(entry.crc, sum.crc, sum.size);
        entry.size += sum.size;
    }
    if (entry.method == ZipMethod::stored) {
        entry.crc = crc32_joined(crc32_of(header), entry.crc, entry.size);
        entry.size += header.size();
        entry.compressed_size = entry.size;
        file_.overwrite(entry.offset, header_of(entry, true) + std::string(header));
        return;
    }
    assert(header.empty());
    file_.append(deflate_end);
    entry.compressed_size += deflate_end.size();
    Record descriptor;
    descriptor.u32(0x08074b50).u32(entry.crc);
    if (is_large(entry))
        descriptor.u64(entry.compressed_size).u64(entry.size);
    else
        descriptor.u32(entry.compressed_size).u32(entry.size);
    file_.append(descriptor.view());
}

void ZipWriter::append_directory() {
    for (const ZipEntry& entry : entries_) {
        // Contains only the values that do not fit, in this order.
        Record large;
        for (const std::uint64_t value : {entry.size, entry.compressed_size, entry.offset})
            if (value >= full32)
                large.u64(value);
        const Record extra = zip64_extra(large);
        const unsigned version = large.view().empty() ? version_plain : version_zip64;
        Record record;
        record.u32(zip_directory_signature).u16(version).u16(version);
        put_common(entry, capped(entry.compressed_size), capped(entry.size), extra, record);
        record.u16(0).u16(0).u16(0).u32(0); // no comment, first disk, no attributes
        record.u32(capped(entry.offset)).text(entry.name).text(extra.view());
        file_.append(record.view());
    }
}

void ZipWriter::finish() {
    if (open_)
        throw Error(ErrorKind::internal, fmt::format("zip entry '{}' was not ended", entries_.back().name));
    const std::uint64_t offset = file_.bytes();
    append_directory();
    const std::uint64_t size = file_.bytes() - offset;
    const std::uint64_t count = entries_.size();
    if (count >= full16 || size >= full32 || offset >= full32) {
        constexpr unsigned rest_of_record = 44;
        Record record;
        record.u32(zip_end64_signature)
            .u64(rest_of_record)
            .u16(version_zip64)
            .u16(version_zip64)
            .u32(0)
            .u32(0);
        record.u64(count).u64(count).u64(size).u64(offset);
        record.u32(zip_end64_locator_signature).u32(0).u64(offset + size).u32(1);
        file_.append(record.view());
    }
    Record end;
    end.u32(zip_end_signature).u16(0).u16(0).u16(std::min(count, full16)).u16(std::min(count, full16));
    end.u32(capped(size)).u32(capped(offset)).u16(0);
    file_.append(end.view());
    file_.commit();
}

} // namespace lamella
