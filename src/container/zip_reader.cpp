// PKWARE's APPNOTE.TXT, version 6.3: 4.3 has the order of the records, 4.4 their fields, 4.5.3 the extra
// field of zip64.

#include "container/zip_reader.hpp"

#include "lamella/core/error.hpp"

#include "container/deflate.hpp"
#include "container/inflate.hpp"
#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "core/lower_case.hpp"
#include "core/pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

namespace lamella {

namespace {

constexpr std::size_t entry_header = 30;
constexpr std::size_t directory_header = 46;
constexpr std::size_t end_header = 22;
constexpr std::size_t end64_header = 56;
constexpr std::size_t end64_locator_size = 20;

constexpr unsigned flag_encrypted = 1U;
constexpr unsigned flag_strongly_encrypted = 1U << 6;
constexpr unsigned flag_masked = 1U << 13;

constexpr std::size_t longest_shown_name = 200;

std::uint64_t number(std::string_view bytes, std::size_t at, int size) {
    std::uint64_t value = 0;
    for (int i = 0; i < size; ++i)
        value |= std::uint64_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
    return value;
}

std::uint64_t u16(std::string_view bytes, std::size_t at) {
    return number(bytes, at, 2);
}
std::uint64_t u32(std::string_view bytes, std::size_t at) {
    return number(bytes, at, 4);
}
std::uint64_t u64(std::string_view bytes, std::size_t at) {
    return number(bytes, at, 8);
}

bool has_signature(std::string_view bytes, std::uint64_t at, std::uint32_t mark, std::size_t header) {
    return at <= bytes.size() && bytes.size() - at >= header && u32(bytes, at) == mark;
}

/// Replaces the values that refer to zip64 by the 64-bit values of the extra field, which has them in the
/// same order. Returns false if the field is missing or too short.
bool widen(std::string_view extra, std::initializer_list<std::uint64_t*> values) {
    std::string_view large;
    while (extra.size() >= 4 && large.data() == nullptr) {
        const std::size_t size = std::min<std::size_t>(u16(extra, 2), extra.size() - 4);
        if (u16(extra, 0) == 1)
            large = extra.substr(4, size);
        extra.remove_prefix(4 + size);
    }
    for (std::uint64_t* value : values) {
        if (*value != full32)
            continue;
        if (large.size() < 8)
            return false;
        *value = u64(large, 0);
        large.remove_prefix(8);
    }
    return true;
}

/// Position and extent of the directory.
struct Directory {
    std::uint64_t offset = 0;
    std::uint64_t size = 0;
    std::uint64_t entries = 0;
    std::uint64_t trailing = 0; ///< bytes after the end of the archive
};

class DirectoryFinder {
  public:
    DirectoryFinder(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    Directory find() const {
        const std::size_t end = find_end();
        Directory directory{u32(bytes_, end + 16), u32(bytes_, end + 12), u16(bytes_, end + 10), 0};
        directory.trailing = bytes_.size() - end - end_header - u16(bytes_, end + 20);
        std::uint64_t directory_end = end;
        if (end >= end64_locator_size && has_signature(bytes_, end - end64_locator_size,
                                                       zip_end64_locator_signature, end64_locator_size)) {
            directory_end = u64(bytes_, end - end64_locator_size + 8);
            read_end64(directory_end, end, directory);
        } else if (u16(bytes_, end + 4) != 0 || u16(bytes_, end + 6) != 0 ||
                   u16(bytes_, end + 8) != directory.entries) {
            fail("is one of several discs of a zip archive, expected a whole one");
        }
        if (directory.size > directory_end || directory.offset != directory_end - directory.size)
            fail(
                fmt::format("the directory of the zip archive should take {} bytes from byte {}, but its end "
                            "stands at byte {}; the file is cut off, or something is in front of it",
                            directory.size, directory.offset, directory_end));
        if (directory.entries > directory.size / directory_header)
            fail(fmt::format("the zip archive claims {} entries in a directory of {} bytes",
                             directory.entries, directory.size));
        return directory;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw Error(ErrorKind::input, fmt::format("{}: {}", name_, what));
    }

    /// Finds the end record. A comment, or appended data of any kind, may follow it.
    std::size_t find_end() const {
        std::optional<std::size_t> before_others;
        if (bytes_.size() >= end_header) {
            const std::size_t last = bytes_.size() - end_header;
            const std::size_t first = last - std::min<std::size_t>(last, full16);
            for (std::size_t at = last + 1; at-- > first;) {
                if (!has_signature(bytes_, at, zip_end_signature, end_header))
                    continue;
                const std::size_t end = at + end_header + u16(bytes_, at + 20);
                if (end == bytes_.size())
                    return at;
                if (end < bytes_.size() && !before_others)
                    before_others = at;
            }
        }
        if (!before_others)
            fail("the end of the zip archive is missing; the file is cut off");
        return *before_others;
    }

    /// Reads the zip64 records of the archive with the end record at `end`. The end record must agree with
    /// them, because otherwise different readers could find different directories.
    void read_end64(std::uint64_t at, std::size_t end, Directory& directory) const {
        constexpr std::size_t before_size_counts = 12;
        const bool is_there = has_signature(bytes_, at, zip_end64_signature, end64_header);
        const std::uint64_t size = is_there ? u64(bytes_, at + 4) : 0;
        if (size < end64_header - before_size_counts || size > end ||
            at + before_size_counts + size + end64_locator_size != end)
            fail(fmt::format("the zip archive should have its (64-bit) end at byte {}, but has not", at));
        const Directory classic = std::exchange(directory, {u64(bytes_, at + 48), u64(bytes_, at + 40),
                                                            u64(bytes_, at + 32), directory.trailing});
        if (u32(bytes_, at + 16) != 0 || u32(bytes_, at + 20) != 0 ||
            u64(bytes_, at + 24) != directory.entries)
            fail("is one of several discs of a zip archive, expected a whole one");
        if ((classic.offset != full32 && classic.offset != directory.offset) ||
            (classic.size != full32 && classic.size != directory.size) ||
            (classic.entries != full16 && classic.entries != directory.entries))
            fail("the two ends of the zip archive contradict each other, expected one directory");
    }

    std::string_view bytes_;
    const std::string& name_;
};

/// Returns the CRC-32, which all threads compute.
std::uint32_t crc32_by_all(std::string_view bytes, Executor& executor) {
    constexpr std::size_t chunk = std::size_t{1} << 20;
    std::vector<std::uint32_t> crcs(bytes.size() / chunk + 1);
    executor.for_chunks(crcs.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
        crcs[i] = crc32_of(bytes.substr(static_cast<std::size_t>(i) * chunk, chunk));
    });
    std::uint32_t crc = 0;
    for (std::size_t i = 0; i < crcs.size(); ++i)
        crc = crc32_joined(crc, crcs[i], bytes.substr(i * chunk, chunk).size());
    return crc;
}

bool before_in_any_case(std::string_view a, std::string_view b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                        [](char x, char y) { return lower_case(x) < lower_case(y); });
}

/// Returns whether name `a` comes before `b` in an order where names that differ only in case are adjacent.
bool comes_before(std::string_view a, std::string_view b) {
    return before_in_any_case(a, b) || (!before_in_any_case(b, a) && a < b);
}

/// Returns the indices of the entries in the order of their names.
std::vector<std::size_t> order_of_names(const std::vector<ZipEntry>& entries) {
    std::vector<std::size_t> order(entries.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return comes_before(entries[a].name, entries[b].name); });
    return order;
}

} // namespace

bool is_zip(std::string_view bytes) noexcept {
    return bytes.starts_with("PK\x03\x04") || bytes.starts_with("PK\x05\x06");
}

ZipReader::ZipReader(ByteSource source, std::uint64_t max_unpacked)
    : source_(std::move(source)),
      max_unpacked_(max_unpacked != 0 ? max_unpacked : usual_most_unpacked(source_.bytes.size())) {
    read_directory();
    was_read_ = std::vector<std::atomic<bool>>(entries_.size());
}

void ZipReader::read_directory() {
    const std::string_view bytes = source_.text();
    const Directory directory = DirectoryFinder(bytes, source_.name).find();
    if (directory.trailing != 0)
        counted_warnings_.push_back(fmt::format(
            "{} bytes follow the end of the zip archive; they were left out", directory.trailing));
    const auto fail = [&](std::uint64_t at, const std::string& what) {
        throw Error(ErrorKind::input, fmt::format("{}: byte {}: {}", source_.name, at, what));
    };
    std::uint64_t at = directory.offset;
    const std::uint64_t end = directory.offset + directory.size;
    entries_.reserve(directory.entries);
    for (std::uint64_t i = 0; i < directory.entries; ++i) {
        if (end - at < directory_header || u32(bytes, at) != zip_directory_signature)
            fail(at, fmt::format("entry {} of {} of the zip directory is missing", i + 1, directory.entries));
        ZipEntry entry;
        entry.flags = static_cast<std::uint16_t>(u16(bytes, at + 8));
        entry.method = static_cast<ZipMethod>(u16(bytes, at + 10));
        entry.crc = static_cast<std::uint32_t>(u32(bytes, at + 16));
        entry.compressed_size = u32(bytes, at + 20);
        entry.size = u32(bytes, at + 24);
        entry.offset = u32(bytes, at + 42);
        const std::uint64_t name_size = u16(bytes, at + 28);
        const std::uint64_t extra_size = u16(bytes, at + 30);
        const std::uint64_t size = directory_header + name_size + extra_size + u16(bytes, at + 32);
        if (end - at < size)
            fail(at, fmt::format("entry {} of the zip directory reaches beyond its end", i + 1));
        entry.name = bytes.substr(at + directory_header, name_size);
        const std::string_view extra = bytes.substr(at + directory_header + name_size, extra_size);
        if (!widen(extra, {&entry.size, &entry.compressed_size, &entry.offset}))
            fail(at, fmt::format("entry {} of the zip directory lacks its 64-bit sizes", i + 1));
        if (const std::uint64_t disc = u16(bytes, at + 34); disc != 0 && disc != full16)
            fail(at, fmt::format("entry {} of the zip directory is on disc {}, expected a single one", i + 1,
                                 disc));
        at += size;
        entries_.push_back(std::move(entry));
    }
    if (at != end)
        counted_warnings_.push_back(
            fmt::format("byte {}: {} bytes follow the last entry of the zip directory", at, end - at));
    settle_offsets(directory.offset);
    settle_names();
}

/// Reads the header of each entry, changes `offset` to the offset of the compressed bytes, and checks that no
/// two entries overlap.
void ZipReader::settle_offsets(std::uint64_t directory_offset) {
    const std::string_view bytes = source_.text();
    const auto fail = [&](const ZipEntry& entry, const std::string& what) {
        throw Error(ErrorKind::input,
                    fmt::format("{}: byte {}: zip entry '{}' {}", source_.name, entry.offset,
                                printable(entry.name, longest_shown_name), what));
    };
    struct Span {
        std::uint64_t begin;
        std::uint64_t end;
        std::size_t entry;
    };
    std::vector<Span> spans;
    spans.reserve(entries_.size());
    for (ZipEntry& entry : entries_) {
        const std::uint64_t at = entry.offset;
        if (!has_signature(bytes.substr(0, directory_offset), at, zip_entry_signature, entry_header))
            fail(entry, "does not begin where the directory says");
        const std::uint64_t name_size = u16(bytes, at + 26);
        const std::uint64_t extra_size = u16(bytes, at + 28);
        const std::uint64_t offset = at + entry_header + name_size + extra_size;
        if (offset > directory_offset || entry.compressed_size > directory_offset - offset)
            fail(entry, fmt::format("of {} bytes reaches into the directory at byte {}",
                                    entry.compressed_size, directory_offset));
        if (bytes.substr(at + entry_header, name_size) != entry.name)
            fail(entry, fmt::format("calls itself '{}'", printable(bytes.substr(at + entry_header, name_size),
                                                                   longest_shown_name)));
        const auto flags = static_cast<std::uint16_t>(u16(bytes, at + 6));
        std::uint64_t compressed_size = u32(bytes, at + 18);
        std::uint64_t size = u32(bytes, at + 22);
        const bool sizes_known = (flags & flag_sizes_behind) == 0;
        if (static_cast<ZipMethod>(u16(bytes, at + 8)) != entry.method ||
            (sizes_known &&
             (!widen(bytes.substr(at + entry_header + name_size, extra_size), {&size, &compressed_size}) ||
              size != entry.size || compressed_size != entry.compressed_size ||
              u32(bytes, at + 14) != entry.crc)))
            fail(entry, "has another method, size or checksum than the directory says");
        entry.flags |= flags;
        spans.push_back({at, offset + entry.compressed_size, spans.size()});
        entry.offset = offset;
    }
    std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.begin < b.begin; });
    for (std::size_t i = 1; i < spans.size(); ++i)
        if (spans[i].begin < spans[i - 1].end)
            fail(entries_[spans[i].entry],
                 fmt::format("lies upon entry '{}'",
                             printable(entries_[spans[i - 1].entry].name, longest_shown_name)));
}

/// Normalises slashes, removes folders and refuses duplicate names.
void ZipReader::settle_names() {
    std::size_t backslashes = 0;
    std::size_t rooted = 0;
    for (ZipEntry& entry : entries_) {
        if (entry.name.find('\\') != std::string::npos) {
            std::replace(entry.name.begin(), entry.name.end(), '\\', '/');
            ++backslashes;
        }
        if (entry.name.starts_with('/')) {
            entry.name.erase(0, 1);
            ++rooted;
        }
    }
    if (backslashes != 0)
        counted_warnings_.push_back(
            fmt::format("{} names in the zip archive have '\\' between folders, taken for '/'", backslashes));
    if (rooted != 0)
        counted_warnings_.push_back(
            fmt::format("{} names in the zip archive begin with '/', which was left out", rooted));
    const std::vector<std::size_t> order = order_of_names(entries_);
    for (std::size_t i = 1; i < order.size(); ++i)
        if (entries_[order[i]].name == entries_[order[i - 1]].name)
            throw Error(ErrorKind::input,
                        fmt::format("{}: two entries of the zip archive are called '{}'", source_.name,
                                    printable(entries_[order[i]].name, longest_shown_name)));
    std::erase_if(entries_,
                  [](const ZipEntry& entry) { return entry.name.ends_with('/') && entry.size == 0; });
    by_name_ = order_of_names(entries_);
}

const ZipEntry* ZipReader::find(std::string_view name) const noexcept {
    const auto first_not = [&](bool (*order)(std::string_view, std::string_view)) -> const ZipEntry* {
        const auto found = std::lower_bound(
            by_name_.begin(), by_name_.end(), name,
            [&](std::size_t i, std::string_view wanted) { return order(entries_[i].name, wanted); });
        return found == by_name_.end() ? nullptr : &entries_[*found];
    };
    if (const ZipEntry* const same = first_not(comes_before); same != nullptr && same->name == name)
        return same;
    const ZipEntry* const similar = first_not(before_in_any_case);
    return similar != nullptr && !before_in_any_case(name, similar->name) ? similar : nullptr;
}

ByteSource ZipReader::read(const ZipEntry& entry, const std::function<void(std::uint64_t)>& count,
                           Executor* helpers) const {
    const std::string shown = printable(entry.name, longest_shown_name);
    const auto fail = [&](const std::string& what) {
        throw Error(ErrorKind::input, fmt::format("{}: zip entry '{}' {}", source_.name, shown, what));
    };
    if ((entry.flags & (flag_encrypted | flag_strongly_encrypted | flag_masked)) != 0)
        fail("is encrypted, which cannot be read; save the file without a password");
    if (entry.method != ZipMethod::stored && entry.method != ZipMethod::deflated)
        fail(fmt::format("is compressed by method {}, expected 0 (stored) or 8 (Deflate)",
                         static_cast<unsigned>(entry.method)));
    // Checked before memory is allocated, so that a small file cannot reserve much memory.
    if (entry.method == ZipMethod::deflated ? entry.size / most_inflation > entry.compressed_size
                                            : entry.size != entry.compressed_size)
        fail(fmt::format("claims to hold {} bytes in {}, which is impossible", entry.size,
                         entry.compressed_size));
    const ZipEntry* const listed = find(entry.name);
    assert(listed != nullptr);
    const bool first = !was_read_[static_cast<std::size_t>(listed - entries_.data())].exchange(true);
    const std::uint64_t before = first ? unpacked_.fetch_add(entry.size) : 0;
    if (entry.size > max_unpacked_ || before > max_unpacked_ - entry.size)
        throw Error(ErrorKind::limit,
                    fmt::format("{}: zip entry '{}' of {} bytes brings what is unpacked above {} bytes; "
                                "`max_memory` allows more",
                                source_.name, shown, entry.size, max_unpacked_));

    const std::span<const std::byte> compressed = source_.bytes.subspan(entry.offset, entry.compressed_size);
    ByteSource content{fmt::format("{}, part '{}'", source_.name, shown), {}, source_.owner};
    if (entry.method == ZipMethod::stored) {
        content.bytes = compressed;
    } else {
        if (count)
            count(entry.size);
        const auto room = std::make_shared<PageArray<std::byte>>(entry.size);
        if (helpers != nullptr && helpers->workers() > 1)
            make_pages_ready(*helpers, room->data(), room->size());
        const Inflated inflated =
            inflate(source_.text().substr(entry.offset, entry.compressed_size), room->span());
        release(source_, compressed);
        switch (inflated) {
        case Inflated::whole:
            break;
        case Inflated::too_short:
            fail(fmt::format("holds fewer than the {} bytes that it claims", entry.size));
            break;
        case Inflated::too_long:
            fail(fmt::format("holds more than the {} bytes that it claims", entry.size));
            break;
        case Inflated::broken:
            fail("is damaged: its compressed bytes are invalid");
        }
        content.bytes = room->span();
        content.owner = room;
    }
    const std::uint32_t crc =
        helpers == nullptr ? crc32_of(content.text()) : crc32_by_all(content.text(), *helpers);
    if (crc != entry.crc)
        fail(fmt::format("is damaged: its checksum is {:08x}, expected {:08x}", crc, entry.crc));
    return content;
}

std::string ZipReader::first_bytes(const ZipEntry& entry, std::size_t most) const {
    const std::string_view compressed = source_.text().substr(entry.offset, entry.compressed_size);
    if ((entry.flags & (flag_encrypted | flag_strongly_encrypted | flag_masked)) != 0)
        return {};
    if (entry.method == ZipMethod::stored)
        return std::string(compressed.substr(0, most));
    return entry.method == ZipMethod::deflated ? first_inflated(compressed, most) : std::string();
}

} // namespace lamella
