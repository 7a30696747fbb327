#include "pipeline/layer_source.hpp"

#include "lamella/core/error.hpp"
#include "lamella/read/mesh_input.hpp"

#include "core/executor.hpp"
#include "pipeline/job_memory.hpp"
#include "pipeline/plate_source.hpp"
#include "pipeline/slab_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace lamella {

std::string wish_for_whole_mesh(const FileJob& job, const Engine& with) {
    if (with.welds)
        return fmt::format("the engine {}", with.name);
    if (job.strict)
        return "--strict";
    if (job.inspect)
        return "--inspect";
    if (job.repair.weld_tolerance_mm)
        return "--weld-tolerance";
    if (job.repair.drop_duplicates)
        return "--drop-duplicates";
    if (job.repair.orient)
        return "--orient";
    if (job.adaptive)
        return "--adaptive";
    return {};
}

std::unique_ptr<LayerSource> open_layer_source(const FileJob& job, const Engine& with,
                                               const Execution& execution) {
    const JobMemory memory(job);
    const unsigned threads = thread_count(execution);
    std::vector<MeshInput> files;
    const MeshInput* other = nullptr;
    std::uint64_t bytes = 0;
    files.reserve(job.inputs.size());
    for (const PlateInput& input : job.inputs) {
        const MeshInput& file = files.emplace_back(input.path, memory.of_input(threads), execution.cancel);
        const bool placed = input.placement != Transform{} || input.unit_mm.value_or(1) != 1;
        if (file.can_stream())
            bytes += memory.of_whole(file, placed, threads);
        else
            other = &file;
    }
    const std::string needs_all = wish_for_whole_mesh(job, with);
    const bool streamable = other == nullptr && needs_all.empty();
    if (bytes <= memory.limit || (!memory.asked && !streamable))
        return open_plate_source(job, std::move(files), memory, execution);

    const auto refuse = [&](const std::string& why) {
        throw Error(ErrorKind::limit,
                    fmt::format("{}: to be sliced whole takes up to {} MB of memory, above the {} MB of "
                                "--max-memory; {}",
                                job.inputs.front().path, bytes / 1'000'000 + 1, memory.limit / 1'000'000,
                                why));
    };
    if (!needs_all.empty())
        refuse(
            fmt::format("it would be sliced in pieces, but for {}, which needs the whole mesh", needs_all));
    if (other != nullptr)
        refuse(fmt::format("it would be sliced in pieces, but for {}, which has to be read whole: only STL "
                           "files that are not packed can be read in pieces",
                           other->path()));
    return open_slab_source(job, std::move(files), memory, execution);
}

} // namespace lamella
