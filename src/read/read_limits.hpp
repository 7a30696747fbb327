#pragma once

// How much of a file a caller is ready to take: checked before memory is asked for.

#include "lamella/core/error.hpp"
#include "lamella/read/mesh_file.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <utility>

namespace lamella {

/// Adds up, from any thread, what a reader is about to make. The first that is too much is Error{limit}.
class ReadLimits {
  public:
    ReadLimits(std::string file_name, const MeshReadOptions& options)
        : file_name_(std::move(file_name)), max_triangles_(options.max_triangles),
          max_memory_(options.max_memory) {}

    void add_triangles(std::uint64_t count) {
        if (triangles_.fetch_add(count) + count > max_triangles_ && max_triangles_ != 0)
            throw Error(ErrorKind::limit,
                        fmt::format("{}: holds more than the {} triangles of --max-triangles", file_name_,
                                    max_triangles_));
    }

    void add_bytes(std::uint64_t count) {
        if (bytes_.fetch_add(count) + count > max_memory_ && max_memory_ != 0)
            throw Error(ErrorKind::limit, fmt::format("{}: takes more than the {} bytes of --max-memory",
                                                      file_name_, max_memory_));
    }

  private:
    std::string file_name_;
    std::uint64_t max_triangles_;
    std::uint64_t max_memory_;
    std::atomic<std::uint64_t> triangles_{0};
    std::atomic<std::uint64_t> bytes_{0};
};

} // namespace lamella
