#pragma once

// What becomes of the layers of a job.

#include "lamella/contour/layer.hpp"
#include "lamella/pipeline/processes.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/write/layer_writer.hpp"

#include "container/byte_store.hpp"
#include "core/atomic_file.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lamella {

/// The slice file of a job, and the page beside it. A process alone writes as it slices. Of several, each
/// writes its piece of a file whose layers lie one after the other (LayerFormat::pieces), once all know how
/// long their pieces are; layers for other formats, and for standard output, go to process 0, which writes.
/// Nothing has its name before all of it is written. For all processes together.
class JobOutput {
  public:
    /// Creates what is written, so that nobody slices for hours what cannot be written. `mine`: the planes of
    /// this process among those of `info`; it keeps up to `most_in_memory` bytes for the others in memory.
    JobOutput(const FileJob& job, LayerFileInfo info, PlaneRange mine, Communicator& processes,
              std::uint64_t most_in_memory);

    /// As LayerWriter::prepare, for all that is written.
    [[nodiscard]] std::function<void()> prepare(std::span<const Layer> parts);

    /// What was written, once all layers of all processes are on their way.
    struct Written {
        std::string format; ///< "" without a slice file
        std::uint64_t bytes = 0;
        std::vector<std::string> warnings;
    };
    [[nodiscard]] Written finish_file();
    /// The page's warnings; `notes` is what it tells of the run.
    [[nodiscard]] std::vector<std::string> finish_page(const PageNotes& notes);
    [[nodiscard]] bool has_page() const noexcept { return page_ != nullptr; }

  private:
    void send_layers();
    void write_layers_of_others();
    [[nodiscard]] std::uint64_t write_shared();

    Communicator& processes_;
    std::string path_;
    std::uint64_t most_bytes_;
    const LayerFormat* format_ = nullptr;
    std::unique_ptr<LayerWriter>
        writer_; ///< of the file or of this process's piece of it; null where another writes
    std::unique_ptr<LayerPageWriter> page_;

    // Of several processes:
    bool shared_ = false;            ///< all of them write the file
    std::optional<AtomicFile> file_; ///< which process 0 creates
    std::string working_path_;
    LayerFilePiece piece_;
    ByteStore waiting_;                   ///< the piece, or layers as messages to process 0
    std::vector<std::uint64_t> messages_; ///< their lengths
};

} // namespace lamella
