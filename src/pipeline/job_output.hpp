#pragma once

// Output of the layers of a job.

#include "lamella/contour/layer.hpp"
#include "lamella/pipeline/file_result.hpp"
#include "lamella/pipeline/processes.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/write/layer_page.hpp"
#include "lamella/write/layer_writer.hpp"

#include "container/byte_store.hpp"
#include "system/atomic_file.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lamella {

/// The files that a job writes.
struct OutputFiles {
    std::string path = {};
    const LayerFormat* format = nullptr; ///< null if there is no slice file
    LayerWriteOptions write = {};
    std::string page_path = {}; ///< "" if there is no page
    PageOptions page = {};

    /// Returns the rounding of coordinates in the slice file; none if it does not store contours.
    [[nodiscard]] Rounding rounding() const noexcept;
};

/// The slice file of a job, and the page beside it. A single process writes while it slices. If there are
/// several processes, and the layers of the file lie one after the other (LayerFormat::chunks), each process
/// writes its range of the file once all sizes are known. For other formats and for standard output, all
/// layers are sent to process 0, which writes them. A file has its name only after all of it is written. All
/// processes must call these functions together.
class JobOutput {
  public:
    /// Creates the files, so that an unwritable path fails before hours of slicing. `mine` is the range of
    /// planes of this process among those of `info`. Each process keeps up to `most_in_memory` bytes of its
    /// output in memory.
    JobOutput(const OutputFiles& files, LayerFileInfo info, PlaneRange mine,
              Communicator& processes = alone(), std::uint64_t most_in_memory = 0);

    /// Works as LayerWriter::prepare, for all outputs.
    [[nodiscard]] Commit prepare(std::span<const Layer> parts);
    [[nodiscard]] Commit prepare(const ScanVectors& vectors);

    /// Ends the slice file, if there is one, after the layers of all processes are written. Sets `format`,
    /// `bytes` and `warnings` of the result.
    void finish_file(FileResult& result);
    /// Ends the page with these notes, and returns the warnings of the page.
    [[nodiscard]] std::vector<std::string> finish_page(const PageNotes& notes);
    [[nodiscard]] bool has_page() const noexcept { return page_ != nullptr; }

  private:
    /// Calls `message` if another process writes the plane.
    template <class Plane, class Message>
    [[nodiscard]] Commit prepared(const Plane& plane, const Message& message);
    void gather_losses();
    [[nodiscard]] std::vector<std::string> warnings_of_file();
    void send_layers();
    void write_layers_of_others();
    [[nodiscard]] std::uint64_t write_shared();

    Communicator& processes_;
    std::string path_;
    std::uint64_t most_bytes_;
    bool strict_;
    const LayerFormat* format_ = nullptr;
    std::unique_ptr<LayerWriter>
        writer_; ///< writer of the file or of this process's range; null if another process writes
    std::unique_ptr<LayerPageWriter> page_;

    // For several processes:
    bool shared_ = false;            ///< all processes write the file
    std::optional<AtomicFile> file_; ///< created by process 0
    std::string working_path_;
    LayerFileChunk chunk_;
    ByteStore waiting_;                   ///< the range's bytes, or layers as messages to process 0
    std::vector<std::uint64_t> messages_; ///< lengths of the messages
};

} // namespace lamella
