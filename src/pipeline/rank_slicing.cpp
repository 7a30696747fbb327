#include "lamella/core/error.hpp"
#include "lamella/pipeline/ranks.hpp"
#include "lamella/read/mesh_input.hpp"
#include "lamella/slicing/slabs.hpp"

#include "core/executor.hpp"
#include "pipeline/agreement.hpp"
#include "pipeline/job_memory.hpp"
#include "pipeline/layer_messages.hpp"
#include "pipeline/packed.hpp"
#include "pipeline/plate_source.hpp"
#include "pipeline/rank_results.hpp"
#include "pipeline/rank_source.hpp"
#include "pipeline/shared_file.hpp"
#include "pipeline/slicing_steps.hpp"
#include "pipeline/stopwatch.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace lamella {
namespace {

/// Where the layers of this rank come from.
struct Source {
    std::unique_ptr<LayerSource> whole; ///< either
    std::unique_ptr<RankSource> shared; ///< or

    [[nodiscard]] LayerSource& get() const { return shared ? *shared : *whole; }
};

Source open_source(const FileJob& job, const Engine& with, Communicator& ranks, const Execution& execution) {
    for (const PlateInput& input : job.inputs)
        if (input.path == "-")
            throw Error(ErrorKind::usage,
                        "standard input reaches one of the ranks only; give the name of a file");
    std::vector<MeshInput> files;
    bool can_share = wish_for_whole_mesh(job, with).empty();
    in_agreement(ranks, [&] {
        for (const PlateInput& input : job.inputs) {
            const MeshInput& file = files.emplace_back(input.path, MeshInput::unlimited, execution.cancel);
            can_share = can_share && file.can_stream() && file.records().has_value();
        }
    });
    Source source;
    if (can_share)
        source.shared = std::make_unique<RankSource>(job, std::move(files), ranks, execution);
    else
        in_agreement(ranks, [&] {
            source.whole = open_plate_source(job, std::move(files), JobMemory(job), execution);
        });
    return source;
}

/// One slab for each rank, of equal work; empty ones at the end where there are fewer planes than ranks.
std::vector<PlaneRange> slabs_for(const PlaneCounts& counts, std::size_t ranks) {
    const SlabSurvey survey(counts);
    const auto planes = survey.planes();
    std::vector<PlaneRange> slabs =
        divide_evenly(survey, static_cast<std::uint32_t>(std::min<std::size_t>(ranks, planes)));
    slabs.resize(ranks, {planes, planes});
    return slabs;
}

/// What becomes of the layers.
class Output {
  public:
    /// Creates what is written, so that nobody slices for hours what cannot be written.
    Output(const FileJob& job, const LayerFormat& format, LayerFileInfo info, PlaneRange mine,
           Communicator& ranks)
        : job_(job), ranks_(ranks), info_(std::move(info)), mine_(mine) {
        if (format.pieces && is_regular(job.output)) {
            file_.emplace(job.output, ranks);
            piece_ = {mine.begin, mine.size(), [this](std::string_view bytes) {
                          bytes_.add(bytes);
                      }};
            info_.piece = &piece_;
        }
        in_agreement(ranks, [&] {
            if (file_) // the limit is that of all pieces
                writer_ = open_layer_writer(job.output, format, info_, unlimited(job.write));
            else if (ranks.rank() == 0)
                writer_ = open_layer_writer(job.output, format, info_, job.write);
        });
    }

    [[nodiscard]] LayerWriter& writer() { return writer_ ? *writer_ : static_cast<LayerWriter&>(messages_); }

    /// All layers of all ranks are on their way.
    void finish(FileResult& result) {
        if (file_) {
            in_agreement(ranks_, [&] {
                if (mine_.size() > 0)
                    writer_->finish();
            });
            result.bytes = file_->write(bytes_, job_.write.most_bytes);
            return;
        }
        in_agreement(ranks_, [&] {
            if (!writer_) {
                messages_.send(ranks_);
                return;
            }
            write_messages(ranks_, *writer_);
            writer_->finish();
            result.bytes = writer_->bytes();
            result.warnings = writer_->warnings();
        });
        ranks_.sum(std::span(&result.bytes, 1)); // the others have 0
    }

  private:
    static bool is_regular(const std::string& path) {
        std::error_code ignored;
        const auto status = std::filesystem::status(path, ignored);
        return path != "-" && (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status));
    }

    static LayerWriteOptions unlimited(LayerWriteOptions options) {
        options.most_bytes = 0;
        return options;
    }

    const FileJob& job_;
    Communicator& ranks_;
    LayerFileInfo info_;
    PlaneRange mine_;
    std::optional<SharedFile> file_; ///< where all ranks write
    LayerFilePiece piece_;
    PieceBytes bytes_;
    std::unique_ptr<LayerWriter> writer_;
    LayerMessages messages_; ///< where only rank 0 does, and this is another one
};

} // namespace

FileResult slice_file(const FileJob& job, Communicator& ranks, const Execution& execution,
                      std::vector<RankFigures>* figures) {
    const Stopwatch total;
    FileResult result;
    if (job.shard)
        throw Error(ErrorKind::usage, "ranks share out all layers among themselves, not those of a shard");
    if (!job.report.path.empty())
        throw Error(ErrorKind::usage,
                    "no process has all layers for a page of the run; write a slice file, and "
                    "let lamella view make a page of it");
    const Engine& with = job.engine.empty() ? engines().front() : engine(job.engine);
    const LayerFormat* format = job.output.empty() ? nullptr : &layer_format(job.format, job.output);
    Plan listed;
    if (!job.z.empty())
        listed = plan_listed(job.z, job.layers.slice_at);
    result.engine = with.name;
    result.threads = thread_count(execution);

    const Stopwatch reading;
    const Source opened = open_source(job, with, ranks, execution);
    LayerSource& source = opened.get();
    result.seconds.read = reading.seconds();
    Plan plan;
    in_agreement(ranks, [&] {
        describe_parts(job, source, result);
        plan = plan_of(job, source, std::move(listed), execution);
        source.prepare(job, with, result, execution);
    });
    result.planned_layers = plan.layers.size();
    result.shard = {0, static_cast<std::uint32_t>(plan.layers.size())};
    result.bottom = plan.layers.front().bottom;
    result.top = plan.layers.back().top;
    const std::vector<PlaneRange> slabs = slabs_for(source.counts(plan, execution), ranks.size());
    const PlaneRange mine = slabs[ranks.rank()];
    if (opened.shared) {
        opened.shared->share_out(plan, slabs, execution);
        result.mesh_volume_mm3 = opened.shared->mesh_volume();
        result.seconds.read = opened.shared->figures().read_seconds;
    }

    std::optional<Output> output;
    if (format != nullptr) {
        output.emplace(job, *format, file_info(source.plate(), plan), mine, ranks);
        result.format = format->name;
    }
    if (job.steps.any())
        result.changes.emplace();
    double slice_seconds = 0; // without waiting for others
    in_agreement(ranks, [&] {
        const Stopwatch slicing;
        std::vector<LayerWriter*> writers;
        if (output)
            writers.push_back(&output->writer());
        if (mine.size() > 0)
            slice_layers(job, source, part_of(plan, mine), writers, result, with, execution);
        slice_seconds = slicing.seconds();
    });
    RankFigures did = opened.shared ? opened.shared->figures() : RankFigures{};
    did.planes = mine.size();
    did.slice_seconds = slice_seconds;
    for (const PartResult& part : result.parts)
        did.points += part.points;
    put_together(result, ranks);
    result.report.layers = plan.layers.size();
    check_closed(job, result);
    if (output) {
        const Stopwatch writing;
        output->finish(result);
        did.write_seconds = writing.seconds();
        result.seconds.write += did.write_seconds;
    }
    if (figures != nullptr)
        for (const std::string& told : ranks.gather(Packer().put(did).take()))
            figures->push_back(Unpacker(told).get<RankFigures>());
    result.seconds.weld += result.report.weld_seconds;
    result.seconds.link = result.report.link_seconds;
    result.seconds.slice = result.report.slice_seconds;
    result.seconds.total = total.seconds();
    return result;
}

} // namespace lamella
