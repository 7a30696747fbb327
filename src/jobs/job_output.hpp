#pragma once

// Output of the layers of a job.

#include "lamella/contour/layer.hpp"
#include "lamella/jobs/file_result.hpp"
#include "lamella/slices/layer_page.hpp"
#include "lamella/slices/layer_writer.hpp"

#include <memory>
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

/// The slice file of a job, and the page beside it, which are written while it is sliced.
class JobOutput {
  public:
    /// Creates the files, so that an unwritable path fails before hours of slicing. `writer` replaces the
    /// writer of the slice file, if there is one.
    JobOutput(const OutputFiles& files, const LayerFileInfo& info,
              std::unique_ptr<LayerWriter> writer = nullptr);

    /// Works as LayerWriter::prepare, for all outputs.
    [[nodiscard]] Commit prepare(const Plane& plane);

    /// Ends the slice file, if there is one. Sets `format`, `bytes`, `losses` and `resin` of the result.
    void finish_file(FileResult& result);
    /// Ends the page with these notes, and returns its losses.
    [[nodiscard]] Findings finish_page(const PageNotes& notes);
    [[nodiscard]] bool has_page() const noexcept { return page_ != nullptr; }

  private:
    const LayerFormat* format_;
    std::unique_ptr<LayerWriter> writer_; ///< null if there is no slice file
    std::unique_ptr<LayerPageWriter> page_;
};

} // namespace lamella
