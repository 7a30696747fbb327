#pragma once

// How much of a file a caller is ready to take: checked before memory is asked for.

#include "lamella/core/error.hpp"
#include "lamella/read/mesh_file.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace lamella {

/// Adds up, from any thread, what a reader is about to make. The first that is too much is Error{limit},
/// which names the place up to which was counted, where that is given.
class ReadLimits {
  public:
    ReadLimits(std::string file_name, const MeshReadOptions& options)
        : file_name_(std::move(file_name)), max_triangles_(options.max_triangles),
          max_memory_(options.max_memory) {}

    void add_triangles(std::uint64_t count, std::string_view place = {}) {
        check_triangles(triangles_.fetch_add(count) + count, place);
    }
    /// Of a sum of triangles that are not counted one by one.
    void check_triangles(std::uint64_t count, std::string_view place = {}) const {
        if (count > max_triangles_ && max_triangles_ != 0)
            throw Error(ErrorKind::limit,
                        fmt::format("{}: holds more than the {} triangles of --max-triangles{}", file_name_,
                                    max_triangles_, up_to(place)));
    }
    void add_bytes(std::uint64_t count, std::string_view place = {}) {
        if (bytes_.fetch_add(count) + count > max_memory_ && max_memory_ != 0)
            throw Error(ErrorKind::limit, fmt::format("{}: takes more than the {} bytes of --max-memory{}",
                                                      file_name_, max_memory_, up_to(place)));
    }
    /// What was counted and is not kept.
    void give_back(std::uint64_t triangles, std::uint64_t bytes) noexcept {
        triangles_.fetch_sub(triangles);
        bytes_.fetch_sub(bytes);
    }

    [[nodiscard]] bool limited() const noexcept { return max_triangles_ != 0 || max_memory_ != 0; }
    /// How many more may come.
    [[nodiscard]] std::uint64_t triangles_left() const noexcept {
        return max_triangles_ == 0 ? std::numeric_limits<std::uint64_t>::max() : max_triangles_ - triangles_;
    }

  private:
    static std::string up_to(std::string_view place) {
        return place.empty() ? std::string() : fmt::format(" (counted up to {})", place);
    }

    std::string file_name_;
    std::uint64_t max_triangles_;
    std::uint64_t max_memory_;
    std::atomic<std::uint64_t> triangles_{0};
    std::atomic<std::uint64_t> bytes_{0};
};

} // namespace lamella
