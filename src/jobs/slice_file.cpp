#include "lamella/jobs/slice_file.hpp"

#include "jobs/file_slicer.hpp"
#include "jobs/job_output.hpp"

#include <utility>

namespace lamella {
namespace {

FileResult slice(FileSlicer& slicer) {
    JobOutput output(slicer.files(), slicer.info());
    slicer.slice(output);
    return slicer.finish(output);
}

} // namespace

FileResult slice_file(const FileJob& job, const Execution& execution) {
    FileSlicer slicer(job, execution);
    return slice(slicer);
}

FileResult slice_file(const FileJob& job, Plate plate, const Execution& execution) {
    FileSlicer slicer(job, std::move(plate), execution);
    return slice(slicer);
}

} // namespace lamella
