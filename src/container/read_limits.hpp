#pragma once

// Limits on the size of a file's contents, which are checked before memory is allocated.

#include "lamella/contour/plane_source.hpp"
#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "container/zip_reader.hpp"
#include "system/byte_source.hpp"
#include "system/memory_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

/// Approximate bytes of a node of a set or map in addition to its value.
inline constexpr std::uint64_t node_bytes = 80;

/// These functions return functions that describe a position if there is an error.
[[nodiscard]] inline auto at_byte(std::uint64_t byte) {
    return [byte] {
        return fmt::format("byte {}", byte);
    };
}
[[nodiscard]] inline auto at_line(std::uint64_t line) {
    return [line] {
        return fmt::format("line {}", line);
    };
}

/// Returns the limit of what a compressed file unpacks to; 0: the usual one.
template <class Options>
[[nodiscard]] std::uint64_t most_unpacked(const Options& options) {
    return options.max_memory == 0 ? 0 : memory_left(options.max_memory, options.held);
}

/// Returns whether the layers of a slice file of this size may not fit a limit. Besides the layers, each of
/// several threads holds a piece of the file as text and as numbers.
[[nodiscard]] constexpr bool is_tight_for_layers(std::uint64_t max_memory, std::uint64_t bytes) noexcept {
    constexpr std::uint64_t ample = 8; // times the size of the file
    return max_memory / ample < bytes;
}

/// Counts, from any thread, the triangles and bytes that a reader is about to create. Throws Error{limit} if
/// a limit is exceeded, with the position in the file if it is given.
class ReadLimits {
  public:
    /// The bytes of the file that are in memory are counted at once.
    template <class Options> // MeshReadOptions or LayerReadOptions
    ReadLimits(const ByteSource& source, const Options& options)
        : ReadLimits(source, most_triangles(options), options.max_memory, options.held) {
        kept_ = options.kept;
    }
    /// A copy counts on by itself.
    ReadLimits(const ReadLimits& other)
        : file_name_(other.file_name_), max_triangles_(other.max_triangles_), asked_(other.asked_),
          limit_(other.limit_), max_memory_(other.max_memory_), held_(other.held_), kept_(other.kept_),
          triangles_(other.triangles_.load()), bytes_(other.bytes_.load()) {}

    /// Returns whether the reader keeps planes in memory. If not, it parses them again later.
    [[nodiscard]] bool in_memory() const noexcept { return kept_ == KeptPlanes::all; }
    /// For formats whose layers cannot be parsed one by one.
    void keep_in_memory() noexcept { kept_ = KeptPlanes::all; }
    /// For formats of images, whose planes take little time to make again and much memory.
    void parse_again() noexcept { kept_ = KeptPlanes::none; }
    /// For text formats; `bytes` is the size of the text.
    void keep_text_in_memory(std::uint64_t bytes) noexcept {
        if (kept_ == KeptPlanes::if_faster && !is_tight_for_layers(max_memory_, bytes))
            keep_in_memory();
    }

    void add_triangles(std::uint64_t count, std::string_view location = {}) {
        check_triangles(triangles_.fetch_add(count) + count, location);
    }
    /// Checks a sum of triangles that are not counted one by one.
    void check_triangles(std::uint64_t count, std::string_view location = {}) const {
        if (count > max_triangles_ && max_triangles_ != 0)
            throw Error(ErrorKind::limit,
                        fmt::format("{}: holds more than the {} triangles of `max_triangles`{}", file_name_,
                                    max_triangles_, up_to(location)));
    }
    void add_bytes(std::uint64_t count, std::string_view location = {}) {
        add_bytes_at(count, [&] { return location; });
    }
    /// `location` is called only for the error.
    template <class Location>
    void add_bytes_at(std::uint64_t count, const Location& location) {
        const std::uint64_t before = bytes_.fetch_add(count);
        if (before > max_memory_ || count > max_memory_ - before)
            refuse_bytes(location());
    }
    /// Reserves space for `more` items, after counting its memory. The capacity grows as by push_back. While
    /// the items are moved, their old memory counts, too.
    template <class T, class Location>
    void make_room(std::vector<T>& items, std::uint64_t more, const Location& location) {
        const std::uint64_t room = items.capacity();
        if (room - items.size() >= more)
            return;
        const std::uint64_t wanted = std::max(items.size() + more, 2 * room);
        add_bytes_at(wanted * sizeof(T), location);
        items.reserve(wanted);
        give_back(0, room * sizeof(T));
    }
    /// Subtracts triangles and bytes that were counted and are not kept.
    void give_back(std::uint64_t triangles, std::uint64_t bytes) noexcept {
        triangles_.fetch_sub(triangles);
        bytes_.fetch_sub(bytes);
    }

    /// Returns the bytes that were counted and not given back.
    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }
    /// Returns the number of bytes that the limit still allows.
    [[nodiscard]] std::uint64_t bytes_left() const noexcept { return memory_left(max_memory_, bytes_); }
    /// Returns the number of triangles that the limit still allows.
    [[nodiscard]] std::uint64_t triangles_left() const noexcept {
        return max_triangles_ == 0 ? std::numeric_limits<std::uint64_t>::max() : max_triangles_ - triangles_;
    }

  private:
    template <class Options>
    static std::uint64_t most_triangles(const Options& options) noexcept {
        if constexpr (requires { options.max_triangles; })
            return options.max_triangles;
        else
            return 0;
    }

    ReadLimits(const ByteSource& source, std::uint64_t max_triangles, std::uint64_t max_memory,
               std::uint64_t held)
        : file_name_(source.name), max_triangles_(max_triangles), asked_(max_memory != 0),
          limit_(memory_limit(max_memory)), max_memory_(memory_left(limit_, held)), held_(held) {
        add_bytes(source.bytes_in_memory());
    }

    [[noreturn]] void refuse_bytes(std::string_view location) const {
        const std::string others =
            held_ == 0 ? std::string()
                       : fmt::format(" together with the files read before, which take {}", held_);
        throw Error(ErrorKind::limit,
                    asked_ ? fmt::format("{}: takes more than the {} bytes of `max_memory`{}{}", file_name_,
                                         limit_, others, up_to(location))
                           : fmt::format("{}: takes more than {} bytes, three quarters of the memory there "
                                         "is{}{}; `max_memory` allows more",
                                         file_name_, limit_, others, up_to(location)));
    }
    static std::string up_to(std::string_view location) {
        return location.empty() ? std::string() : fmt::format(" (counted up to {})", location);
    }

    std::string file_name_;
    std::uint64_t max_triangles_;
    bool asked_;
    std::uint64_t limit_;
    std::uint64_t max_memory_; ///< what the limit leaves this file
    std::uint64_t held_;
    KeptPlanes kept_ = KeptPlanes::all;
    std::atomic<std::uint64_t> triangles_{0};
    std::atomic<std::uint64_t> bytes_{0};
};

/// Unpacks an entry of an archive. Its bytes count before they are unpacked, and until the last copy of the
/// result is gone; the limits must live as long. For `helpers`, see ZipReader::read.
[[nodiscard]] inline ByteSource unpacked_entry(const ZipReader& zip, const ZipEntry& entry,
                                               ReadLimits& limits, Executor* helpers = nullptr) {
    std::uint64_t taken = 0;
    const auto count = [&](std::uint64_t bytes) {
        limits.add_bytes_at(bytes, [&] { return fmt::format("zip entry '{}'", printable(entry.name, 100)); });
        taken = bytes;
    };
    ByteSource source = zip.read(entry, count, helpers);
    if (taken != 0)
        source.owner = std::shared_ptr<const void>(
            source.bytes.data(),
            [owner = source.owner, taken, &limits](const void*) { limits.give_back(0, taken); });
    return source;
}

} // namespace lamella
