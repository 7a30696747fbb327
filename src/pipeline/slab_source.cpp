#include "pipeline/slab_source.hpp"

#include "lamella/core/error.hpp"

#include "core/executor.hpp"
#include "pipeline/plate_builder.hpp"
#include "pipeline/slab_store.hpp"
#include "pipeline/stopwatch.hpp"
#include "pipeline/stream_sums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <utility>

// Three passes over the files: what they hold and where it lies (its box); how many triangles each plane
// cuts; and the triangles themselves, sorted into slabs. To read a file again is faster than to write its
// triangles down, and takes no room.

namespace lamella {
namespace {

/// Passes over files, whose bytes progress counts as one.
class Passes {
  public:
    Passes(std::vector<MeshInput> files, const MeshReadOptions& options, std::uint64_t passes)
        : files_(std::move(files)), options_(options) {
        for (const MeshInput& file : files_)
            total_ += passes * file.bytes();
    }

    [[nodiscard]] std::size_t files() const noexcept { return files_.size(); }
    [[nodiscard]] double seconds() const noexcept { return seconds_; }

    MeshFile stream(std::size_t file, const TriangleSink& sink, const Execution& execution) {
        const Stopwatch reading;
        Execution counted = execution;
        if (execution.progress)
            counted.progress = [&](const Progress& progress) {
                execution.progress({Stage::read, std::min(done_ + progress.done, total_), total_});
            };
        MeshFile read = files_[file].stream(sink, options_, counted);
        done_ += files_[file].bytes();
        seconds_ += reading.seconds();
        return read;
    }

    /// To be called when there are no more.
    void finish(const Execution& execution) const {
        if (execution.progress)
            execution.progress({Stage::read, total_, total_});
    }

  private:
    std::vector<MeshInput> files_;
    MeshReadOptions options_;
    std::uint64_t total_ = 0;
    std::uint64_t done_ = 0;
    double seconds_ = 0;
};

/// Sorts triangles by the slabs they touch, batch by batch.
class Scatter {
  public:
    /// Slab s of a shape is heap first + s * step.
    Scatter(const SlabFinder& finder, std::size_t slabs, SlabStore& store, std::size_t first,
            std::size_t step)
        : finder_(finder), slabs_(slabs), store_(store), first_(first), step_(step) {}

    /// From any thread. False when there are more triangles than were counted.
    [[nodiscard]] bool add(const TriangleSoup& batch) const {
        // A triangle may touch all slabs: so many copies are made at a time.
        constexpr std::uint64_t copies_at_once = std::uint64_t{1} << 15;
        std::vector<SlabFinder::Touched> touched;
        finder_.find(batch, touched);
        for (std::size_t from = 0; from < batch.size();) {
            std::size_t to = from;
            for (std::uint64_t copies = 0; to < batch.size() && copies < copies_at_once; ++to)
                copies += touched[to].end - touched[to].begin;
            if (!add(batch, touched, from, to))
                return false;
            from = to;
        }
        return true;
    }

  private:
    [[nodiscard]] bool add(const TriangleSoup& batch, const std::vector<SlabFinder::Touched>& touched,
                           std::size_t from, std::size_t to) const {
        std::vector<std::size_t> begin(slabs_ + 1, 0);
        for (std::size_t i = from; i < to; ++i)
            for (std::uint32_t s = touched[i].begin; s < touched[i].end; ++s)
                ++begin[s + std::size_t{1}];
        for (std::size_t s = 0; s < slabs_; ++s)
            begin[s + 1] += begin[s];
        std::vector<Triangle3f> sorted(begin[slabs_]);
        std::vector<std::size_t> next = begin;
        for (std::size_t i = from; i < to; ++i)
            for (std::uint32_t s = touched[i].begin; s < touched[i].end; ++s)
                sorted[next[s]++] = batch.stored(i);
        for (std::size_t s = 0; s < slabs_; ++s)
            if (begin[s] < begin[s + 1] &&
                !store_.add(first_ + s * step_, std::span(sorted).subspan(begin[s], begin[s + 1] - begin[s])))
                return false;
        return true;
    }

    const SlabFinder& finder_;
    std::size_t slabs_;
    SlabStore& store_;
    std::size_t first_;
    std::size_t step_;
};

class SlabSource final : public LayerSource {
  public:
    SlabSource(const FileJob& job, std::vector<MeshInput> files, const JobMemory& memory,
               const Execution& execution)
        : memory_(memory), measure_volume_(job.layer_statistics),
          passes_(std::move(files),
                  {.strict = job.strict, .max_triangles = job.max_triangles, .max_memory = job.max_memory},
                  job.shard ? 4 : 3) {
        PlateBuilder builder;
        for (std::size_t i = 0; i < job.inputs.size(); ++i) {
            const PlateInput& input = job.inputs[i];
            const double unit = input.unit_mm.value_or(1);
            const Transform placement = compose(input.placement, scaling(unit, unit, unit));
            Extent extent(placement);
            MeshFile file = passes_.stream(
                i, [&](const TriangleSoup& batch, std::uint64_t number) { extent.add(batch, number); },
                execution);
            triangles_.push_back(file.stored_triangles - file.nonfinite_triangles);
            first_corners_.push_back(extent.first_corner());
            builder.add(input, std::move(file), [&](const Mesh&, const Transform& where) {
                if (where != placement)
                    throw Error(ErrorKind::internal, "a streamed mesh stands elsewhere than was thought");
                return extent.box();
            });
        }
        plate_ = builder.finish();
    }

    [[nodiscard]] std::uint64_t triangles(std::size_t shape) const override {
        return triangles_[plate_.shapes[shape].input];
    }

    [[nodiscard]] Plan adaptive_plan(const AdaptiveLayers&, const Execution&) override {
        throw Error(ErrorKind::internal, "layers of varying height need the whole mesh");
    }

    [[nodiscard]] PlaneCounts counts(const Plan& plan, const Execution& execution) override {
        count_shapes(plan, execution);
        PlaneCounts sum(plan.layers.size());
        for (const PlatePart& part : plate_.parts)
            sum.add(counts_[part.shape]);
        return sum;
    }

    /// Nothing: who wants more has the mesh in memory.
    void prepare(const FileJob&, const Engine&, FileResult&, const Execution&) override {}

    void slice_to(const PlateSink& sink, const Plan& plan, const Execution& execution, FileResult& result,
                  const Engine& with) override {
        const SlabSurvey survey(counts(plan, execution));
        const std::vector<PlaneRange> slabs = divide(survey, plan, thread_count(execution));
        SlabStore store = scatter(plan, slabs, execution);
        passes_.finish(execution);
        for (const PlatePart& part : plate_.parts)
            result.mesh_volume_mm3 += volumes_[part.shape];
        result.seconds.read = passes_.seconds();

        result.report = {};
        for (std::size_t s = 0; s < slabs.size(); ++s) {
            const Plate plate = take_slab(s, store, execution);
            SliceReport report;
            slice_plate_to(sink, plate, part_of(plan, slabs[s]), in_slab(slabs[s], plan, execution), report,
                           with, points_in_flight_);
            result.report.link_seconds += report.link_seconds;
            result.report.slice_seconds += report.slice_seconds;
        }
        result.report.layers = plan.layers.size();
        result.slabs = slabs.size();
    }

  private:
    [[nodiscard]] const Transform& placement(std::size_t shape) const {
        return plate_.shapes[shape].mesh.soup()->placement();
    }

    /// The second pass; one more where the layers of a shard are still to be found.
    void count_shapes(const Plan& plan, const Execution& execution) {
        counts_.clear();
        volumes_.clear();
        std::vector<std::unique_ptr<PlaneCounter>> counters;
        std::vector<std::unique_ptr<VolumeSum>> volumes;
        for (std::size_t shape = 0; shape < plate_.shapes.size(); ++shape) {
            counters.push_back(std::make_unique<PlaneCounter>(plan));
            volumes.push_back(
                std::make_unique<VolumeSum>(placement(shape), first_corners_[plate_.shapes[shape].input]));
        }
        for_batches(execution, [&](std::size_t shape, const TriangleSoup& batch, std::uint64_t number) {
            counters[shape]->add(batch);
            if (measure_volume_)
                volumes[shape]->add(batch, number);
        });
        for (std::size_t shape = 0; shape < plate_.shapes.size(); ++shape) {
            counts_.push_back(counters[shape]->total());
            volumes_.push_back(volumes[shape]->volume());
        }
    }

    /// A pass over all files: body(shape, batch, number) with the batch placed.
    template <class Body>
    void for_batches(const Execution& execution, const Body& body) {
        for (std::size_t file = 0; file < passes_.files(); ++file) {
            static_cast<void>(passes_.stream(
                file,
                [&](const TriangleSoup& batch, std::uint64_t number) {
                    for (std::size_t shape = 0; shape < plate_.shapes.size(); ++shape)
                        if (plate_.shapes[shape].input == file)
                            body(shape, batch.transformed(placement(shape)), number);
                },
                execution));
        }
    }

    /// Sets points_in_flight_, too.
    std::vector<PlaneRange> divide(const SlabSurvey& survey, const Plan& plan, unsigned threads) {
        SlabMemory slab{
            .threads = threads,
            .placed = std::ranges::any_of(
                plate_.shapes, [](const PlateShape& shape) { return shape.mesh.soup()->has_placement(); }),
            .points_in_flight = memory_.points_in_flight(threads)};
        points_in_flight_ = slab.points_in_flight;
        if (plate_.parts.size() > 1) // then all layers of a slab are held
            slab.points_in_flight = ~std::uint64_t{0};
        const std::uint64_t overhead = JobMemory::overhead(threads, plan.layers.size());
        std::uint64_t largest = 0;
        std::uint32_t where = 0;
        for (std::uint32_t p = 0; p < survey.planes(); ++p)
            if (const std::uint64_t bytes = slab.bytes(survey.needs({p, p + 1})); bytes > largest) {
                largest = bytes;
                where = p;
            }
        if (overhead + largest > memory_.limit)
            throw Error(
                ErrorKind::limit,
                fmt::format("{}: the layer at z = {:.6g} mm alone is cut from {} triangles; with "
                            "--threads {} that takes {} MB of memory, above the {:.3g} MB of --max-memory; "
                            "allow more, or use fewer threads",
                            plate_.files.front().path, plan.layers[where].z, survey.points(where), threads,
                            (overhead + largest) / 1'000'000 + 1, static_cast<double>(memory_.limit) / 1e6));
        return divide_to_fit(survey, plan, slab, memory_.limit - overhead);
    }

    /// The third pass.
    SlabStore scatter(const Plan& plan, const std::vector<PlaneRange>& slabs, const Execution& execution) {
        const std::size_t shapes = plate_.shapes.size();
        std::vector<std::uint64_t> sizes(slabs.size() * shapes);
        for (std::size_t shape = 0; shape < shapes; ++shape) {
            const SlabSurvey survey(counts_[shape]);
            for (std::size_t s = 0; s < slabs.size(); ++s)
                sizes[s * shapes + shape] = survey.triangles(slabs[s]);
        }
        const SlabFinder finder(plan, slabs);
        SlabStore store(sizes, slabs.size() == 1);
        std::atomic<bool> fits{true};
        for_batches(execution, [&](std::size_t shape, const TriangleSoup& batch, std::uint64_t) {
            if (!Scatter(finder, slabs.size(), store, shape, shapes).add(batch))
                fits = false;
        });
        if (!fits || !store.full())
            throw Error(ErrorKind::input,
                        fmt::format("{}: was changed while it was read", plate_.files.front().path));
        return store;
    }

    /// The plate with those triangles that planes of the slab cut.
    [[nodiscard]] Plate take_slab(std::size_t slab, SlabStore& store, const Execution& execution) const {
        Executor executor(execution);
        Plate plate = plate_;
        for (std::size_t shape = 0; shape < plate.shapes.size(); ++shape)
            plate.shapes[shape].mesh =
                Mesh(store.take(slab * plate.shapes.size() + shape, executor).transformed(placement(shape)));
        return plate;
    }

    /// Progress in planes of the whole; only that: stages do not come back.
    static Execution in_slab(PlaneRange slab, const Plan& plan, const Execution& execution) {
        Execution run = execution;
        if (execution.progress)
            run.progress = [&execution, slab, planes = plan.layers.size()](const Progress& progress) {
                if (progress.stage == Stage::slice && progress.total != 0)
                    execution.progress(
                        {Stage::slice, slab.begin + progress.done * slab.size() / progress.total, planes});
            };
        return run;
    }

    JobMemory memory_;
    bool measure_volume_;
    Passes passes_;
    std::vector<std::uint64_t> triangles_; ///< by file
    std::vector<Point3f> first_corners_;   ///< by file
    std::vector<PlaneCounts> counts_;      ///< by shape
    std::vector<double> volumes_;          ///< by shape
    std::uint64_t points_in_flight_ = 0;
};

} // namespace

std::unique_ptr<LayerSource> open_slab_source(const FileJob& job, std::vector<MeshInput> files,
                                              const JobMemory& memory, const Execution& execution) {
    return std::make_unique<SlabSource>(job, std::move(files), memory, execution);
}

} // namespace lamella
