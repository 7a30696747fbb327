#pragma once

// Reads the pieces of a slice file on all threads, and can parse single layers again later.
//
// A format finds the pieces and parses them. The order, the progress and parsing again are the same for all
// formats that use this header; those are all but the slices of 3MF, which one model may place several times.

#include "lamella/core/execution.hpp"
#include "lamella/slices/layer_file.hpp"

#include "container/read_limits.hpp"
#include "core/executor.hpp"
#include "slices/engine/layer_assembly.hpp"
#include "slices/engine/layer_pieces.hpp"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace lamella {

/// The limits and the progress of a reader.
struct Reading {
    ReadLimits& limits;
    const Executor& executor;
    ProgressMeter& progress; ///< counts bytes
    bool again = false;      ///< true if a sound layer is parsed again, so that lines need not be counted
};

/// The offset up to which a thread has read a piece of a file.
class ReadPosition {
  public:
    ReadPosition(const Reading& reading, std::size_t begin) : reading_(reading), reported_(begin) {}

    /// Reports progress from time to time. Throws Error{cancelled}.
    void reached(std::size_t offset) {
        constexpr std::size_t step = std::size_t{1} << 20;
        if (offset > reported_ + step) {
            reading_.executor.check_cancelled();
            end(offset);
        }
    }
    /// Reports all progress up to the end of the piece.
    void end(std::size_t offset) {
        reading_.progress.add(offset - reported_);
        reported_ = offset;
    }

  private:
    const Reading& reading_;
    std::size_t reported_;
};

/// Reads all pieces of a file. A `Format` describes one opened file. It has
///
///     struct Piece { std::vector<Raw> layers; std::size_t end; ... };  // Raw is a RawLayer
///     PieceBegins begins(Executor&);      // where pieces begin, at least one
///     std::size_t end() const;            // of the last piece
///     // Parses from `begin` to the first end of a layer at or after `limit`; on any thread.
///     Piece parse(std::size_t begin, std::size_t limit, const Reading&) const;
///     void append(Piece&&, ReadLimits&);  // in the order of the file
///
/// Throws as `read_pieces` does.
template <class Format>
void read_layers_of(Format& format, ReadLimits& limits, Executor& executor, ProgressMeter& progress) {
    const PieceBegins begins = format.begins(executor);
    read_pieces(
        begins, format.end(), executor,
        [&](std::size_t begin, std::size_t limit) {
            auto piece = format.parse(begin, limit, {limits, executor, progress});
            end_layers(piece.layers, limits);
            return piece;
        },
        [&](auto&& piece) { format.append(std::move(piece), limits); });
}

/// The same, with an executor and a progress meter of its own; `bytes` is the size of the file.
template <class Format>
void read_layers_of(Format& format, ReadLimits& limits, const Execution& execution, std::uint64_t bytes) {
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::read, bytes);
    read_layers_of(format, limits, executor, progress);
    progress.finish();
}

/// Returns a function that parses a layer again. `Format` also has
///
///     // Returns the only layer of the piece, with the numbers of the parts of the file.
///     RawLayer layer(Piece&&) const;
template <class Format>
[[nodiscard]] ParseLayer parsing_again(std::shared_ptr<const Format> format) {
    return [format = std::move(format)](std::size_t begin, ReadLimits& limits) {
        const Execution silent{.threads = 1};
        const Executor executor(silent);
        ProgressMeter progress(silent, Stage::read, 0);
        return format->layer(format->parse(begin, begin + 1, {limits, executor, progress, true}));
    };
}

} // namespace lamella
