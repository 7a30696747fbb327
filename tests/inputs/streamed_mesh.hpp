#pragma once

// The triangles that a file streams.

#include "lamella/inputs/read_file.hpp"

#include "fixtures/stl_text.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace lamella::stl_test {

/// The triangles that a file streams, in the order of its batches.
struct Streamed {
    Triangles triangles;
    MeshFile file;
};

inline Streamed stream(const MeshInput& input, const MeshReadOptions& options = {}, unsigned threads = 1,
                       const std::optional<RecordRange>& share = {}) {
    std::mutex mutex;
    std::map<std::uint64_t, Triangles> batches;
    const TriangleSink sink = [&](const TriangleSoup& batch, std::uint64_t number) {
        Triangles triangles;
        for (std::size_t i = 0; i < batch.size(); ++i)
            triangles.push_back(batch.stored(i));
        const std::lock_guard lock(mutex);
        EXPECT_TRUE(batches.emplace(number, std::move(triangles)).second) << "batch " << number << " twice";
    };
    Streamed streamed;
    streamed.file = input.stream(sink, options, {.threads = threads}, share);
    for (const auto& [number, triangles] : batches)
        streamed.triangles.insert(streamed.triangles.end(), triangles.begin(), triangles.end());
    return streamed;
}

} // namespace lamella::stl_test
