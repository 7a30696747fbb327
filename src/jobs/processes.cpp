#include "lamella/jobs/processes.hpp"

#include "lamella/core/error.hpp"
#include "lamella/jobs/slice_file.hpp"

#include "jobs/agreement.hpp"
#include "jobs/file_slicer.hpp"
#include "jobs/job_output.hpp"
#include "jobs/packed.hpp"
#include "jobs/shared_reading.hpp"
#include "jobs/shared_writer.hpp"

#include <algorithm>
#include <memory>
#include <string>

namespace lamella {
namespace {

/// Throws for a job that only a single process can do.
void check_shared_job(const FileJob& job) {
    if (job.shard)
        throw Error(ErrorKind::usage,
                    "processes share out all layers among themselves, not those of a shard");
    if (job.check)
        throw Error(ErrorKind::usage,
                    "no process has all layers for the check of the print; write a slice file, and let "
                    "lamella check read it");
    if (!job.report.path.empty())
        throw Error(ErrorKind::usage,
                    "no process has all layers for a page of the run; write a slice file, and "
                    "let lamella view make a page of it");
    if (std::any_of(job.inputs.begin(), job.inputs.end(),
                    [](const PlateInput& input) { return input.path == "-"; }))
        throw Error(ErrorKind::usage,
                    "standard input reaches one of the processes only; give the name of a file");
}

FileResult slice_together(const FileJob& job, Agreement& processes, const Execution& execution) {
    check_shared_job(job);
    SharedReading reading(processes);
    const Shard mine{static_cast<std::uint32_t>(processes.process() + 1),
                     static_cast<std::uint32_t>(processes.size())};
    FileSlicer slicer(job, execution, &reading, mine);
    const OutputFiles files = slicer.files();
    std::unique_ptr<LayerWriter> writer;
    if (files.format != nullptr)
        writer = std::make_unique<SharedWriter>(files, slicer.info(), slicer.mine(), processes,
                                                slicer.memory().of_output());
    JobOutput output(files, slicer.info(), std::move(writer));
    slicer.slice(output);
    Packer figures;
    slicer.move_to(figures);
    for (const std::string& message : processes.gather(figures.take())) {
        Unpacker from(message);
        slicer.add(from);
    }
    FileResult result = slicer.finish(output);
    const std::string own = Packer().put(result.processes.front()).take();
    result.processes.clear();
    for (const std::string& message : processes.gather(own))
        result.processes.push_back(Unpacker(message).get<ProcessFigures>());
    return result;
}

} // namespace

FileResult slice_file(const FileJob& job, const Execution& execution, Communicator& processes) {
    if (processes.size() == 1)
        return slice_file(job, execution);
    Agreement agreement(processes);
    return agreement.run([&] { return slice_together(job, agreement, execution); });
}

} // namespace lamella
