#pragma once

// Writing of one slice file by several processes.

#include "lamella/slices/layer_writer.hpp"
#include "lamella/slicing/plan.hpp"

#include "container/byte_store.hpp"
#include "jobs/agreement.hpp"
#include "jobs/job_output.hpp"
#include "system/atomic_file.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lamella {

/// The writer of a process that slices a job together with others. If the layers of the file lie one after
/// the other (LayerFormat::chunks), each process writes its range of the file once all sizes are known. For
/// other formats and for standard output, all layers are sent to process 0, which writes them. A file has its
/// name only after all of it is written. All processes must construct and finish the writer together; both
/// throw the errors of Agreement::gather, too.
class SharedWriter final : public LayerWriter {
  public:
    /// `mine` is the range of planes of this process among those of `info`. It keeps up to `most_in_memory`
    /// bytes of its output in memory.
    SharedWriter(const OutputFiles& files, LayerFileInfo info, PlaneRange mine, Agreement& processes,
                 std::uint64_t most_in_memory);

    [[nodiscard]] Commit prepare(const Plane& plane) override;
    void finish() override;
    /// Returns the size of the whole file after `finish`.
    [[nodiscard]] std::uint64_t bytes() const noexcept override { return bytes_; }
    [[nodiscard]] Findings findings() const override { return losses_; }
    /// Returns that of process 0; null in other processes.
    [[nodiscard]] const ResinJob* resin_job() const noexcept override {
        return writer_ ? writer_->resin_job() : nullptr;
    }

  private:
    [[nodiscard]] Commit kept(std::string plane);
    void write_layers_of_others();
    void write_chunks();

    Agreement& processes_;
    std::string path_;
    std::uint64_t most_bytes_;
    bool strict_;
    bool in_chunks_;                 ///< all processes write the file
    std::optional<AtomicFile> file_; ///< of process 0, if all write
    std::string working_path_;
    LayerFileChunk chunk_;
    std::unique_ptr<LayerWriter>
        writer_; ///< of the file or of this process's range; null on others if process 0 writes all layers
    ByteStore waiting_;                  ///< the range's bytes, or layers for process 0
    std::vector<std::uint64_t> batches_; ///< sizes of the messages to process 0
    std::uint64_t bytes_ = 0;
    Findings losses_;
};

} // namespace lamella
