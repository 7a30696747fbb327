#include "pipeline/rank_source.hpp"

#include "lamella/core/error.hpp"

#include "core/pages.hpp"
#include "mesh/folds.hpp"
#include "pipeline/agreement.hpp"
#include "pipeline/packed.hpp"
#include "pipeline/plate_builder.hpp"
#include "pipeline/stream_sums.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

// The three passes of slab_source, each over a share of every file, with a word between ranks after each: the
// boxes, the counts of planes, and the triangles themselves.

namespace lamella {
namespace {

/// Rank r's share of n triangles: whole pieces of a fold, so that sums have the bits that one process finds.
RecordRange share_of(std::uint64_t n, std::size_t rank, std::size_t ranks) {
    const std::uint64_t pieces = (n + fold_piece - 1) / fold_piece;
    const auto bound = [&](std::size_t r) {
        return std::min(n, pieces * r / ranks * fold_piece);
    };
    return {bound(rank), bound(rank + 1)};
}

/// What a rank saw of a file.
struct Seen {
    Box3 box;
    std::uint64_t unusable = 0;
    std::uint64_t any = 0; ///< whether there is a first corner
    Point3f first_corner;
};

/// By shapes: body(shape) for those that come from the file.
template <class Body>
void for_shapes_of(const Plate& plate, std::size_t file, const Body& body) {
    for (std::size_t shape = 0; shape < plate.shapes.size(); ++shape)
        if (plate.shapes[shape].input == file)
            body(shape);
}

} // namespace

RankSource::RankSource(const FileJob& job, std::vector<MeshInput> files, Communicator& ranks,
                       const Execution& execution)
    : ranks_(ranks), measure_volume_(job.layer_statistics), reading_{.strict = job.strict,
                                                                     .max_triangles = job.max_triangles,
                                                                     .max_memory = job.max_memory} {
    for (MeshInput& input : files) {
        const RecordRange share = share_of(input.records().value(), ranks.rank(), ranks.size());
        files_.push_back({std::move(input), share, 0, {}});
        figures_.triangles_read += share.end - share.begin;
    }
    look_at(job, execution);
}

const Transform& RankSource::placement(std::size_t shape) const {
    return plate_.shapes[shape].mesh.soup()->placement();
}

void RankSource::look_at(const FileJob& job, const Execution& execution) {
    PlateBuilder builder;
    for (std::size_t i = 0; i < files_.size(); ++i) {
        File& file = files_[i];
        const double unit = job.inputs[i].unit_mm.value_or(1);
        const Transform placement = compose(job.inputs[i].placement, scaling(unit, unit, unit));
        MeshFile read;
        Seen mine;
        in_agreement(ranks_, [&] {
            const Stopwatch reading;
            Extent extent(placement);
            read = file.input.stream(
                [&](const TriangleSoup& batch, std::uint64_t number) { extent.add(batch, number); }, reading_,
                execution, file.share);
            mine = {extent.box(), read.nonfinite_triangles, extent.box().empty() ? 0U : 1U,
                    extent.first_corner()};
            figures_.read_seconds += reading.seconds();
        });
        Box3 box;
        bool any = false;
        file.triangles = read.stored_triangles;
        for (const std::string& told : ranks_.gather(Packer().put(mine).take())) {
            const Seen seen = Unpacker(told).get<Seen>();
            file.triangles -= seen.unusable;
            box.add(seen.box);
            if (seen.any != 0 && !any)
                file.first_corner = seen.first_corner;
            any = any || seen.any != 0;
        }
        if (!any)
            throw Error(ErrorKind::input, file.input.path() + ": no triangle of the file is usable");
        builder.add(job.inputs[i], std::move(read), [&](const Mesh&, const Transform& where) {
            if (where != placement)
                throw Error(ErrorKind::internal, "a streamed mesh stands elsewhere than was thought");
            return box;
        });
    }
    plate_ = builder.finish();
}

std::uint64_t RankSource::triangles(std::size_t shape) const {
    return files_[plate_.shapes[shape].input].triangles;
}

Plan RankSource::adaptive_plan(const AdaptiveLayers&, const Execution&) {
    throw Error(ErrorKind::internal, "layers of varying height need the whole mesh");
}

void RankSource::prepare(const FileJob&, const Engine&, FileResult&, const Execution&) {}

template <class Body>
void RankSource::for_batches(const Execution& execution, const Body& body) {
    const Stopwatch reading;
    for (std::size_t i = 0; i < files_.size(); ++i)
        static_cast<void>(files_[i].input.stream(
            [&](const TriangleSoup& batch, std::uint64_t number) {
                for_shapes_of(plate_, i, [&](std::size_t shape) {
                    body(shape, batch.transformed(placement(shape)), number);
                });
            },
            reading_, execution, files_[i].share));
    figures_.read_seconds += reading.seconds();
}

PlaneCounts RankSource::counts(const Plan& plan, const Execution& execution) {
    const std::size_t shapes = plate_.shapes.size();
    std::vector<std::unique_ptr<PlaneCounter>> counters;
    std::vector<std::unique_ptr<VolumeSum>> volumes;
    for (std::size_t shape = 0; shape < shapes; ++shape) {
        counters.push_back(std::make_unique<PlaneCounter>(plan));
        volumes.push_back(
            std::make_unique<VolumeSum>(placement(shape), files_[plate_.shapes[shape].input].first_corner));
    }
    in_agreement(ranks_, [&] {
        for_batches(execution, [&](std::size_t shape, const TriangleSoup& batch, std::uint64_t number) {
            counters[shape]->add(batch);
            if (measure_volume_)
                volumes[shape]->add(batch, number);
        });
    });
    std::vector<double> volume_of(shapes, 0);
    for (std::size_t shape = 0; shape < shapes; ++shape) {
        counts_.push_back(counters[shape]->total());
        ranks_.sum(counts_.back().numbers());
        if (measure_volume_)
            for (const std::string& told :
                 ranks_.gather(Packer().put_all(std::span(volumes[shape]->pieces())).take()))
                for (const double piece : Unpacker(told).get_all<double>())
                    volume_of[shape] += piece;
    }
    PlaneCounts all(plan.layers.size());
    for (const PlatePart& part : plate_.parts) {
        all.add(counts_[part.shape]);
        mesh_volume_ += volume_of[part.shape] / 6;
    }
    return all;
}

void RankSource::share_out(const Plan& plan, std::span<const PlaneRange> slabs, const Execution& execution) {
    const SlabFinder finder(plan, slabs);
    std::vector<Outgoing> outgoing(plate_.shapes.size(), Outgoing(ranks_.size()));
    in_agreement(ranks_, [&] {
        std::vector<std::mutex> mutexes(ranks_.size());
        for_batches(execution, [&](std::size_t shape, const TriangleSoup& batch, std::uint64_t) {
            std::vector<SlabFinder::Touched> touched;
            finder.find(batch, touched);
            Outgoing sorted(slabs.size());
            for (std::size_t i = 0; i < batch.size(); ++i)
                for (std::uint32_t slab = touched[i].begin; slab < touched[i].end; ++slab)
                    sorted[slab].push_back(batch.stored(i));
            for (std::size_t slab = 0; slab < slabs.size(); ++slab) {
                const std::lock_guard lock(mutexes[slab]);
                std::vector<Triangle3f>& to = outgoing[shape][slab];
                to.insert(to.end(), sorted[slab].begin(), sorted[slab].end());
            }
        });
    });
    const Stopwatch exchanging;
    for (std::size_t shape = 0; shape < plate_.shapes.size(); ++shape) {
        const Transform where = placement(shape);
        plate_.shapes[shape].mesh = Mesh(exchanged(outgoing[shape]).transformed(where));
        figures_.triangles_sliced += plate_.shapes[shape].mesh.size();
        outgoing[shape].clear();
    }
    figures_.exchange_seconds = exchanging.seconds();
}

TriangleSoup RankSource::exchanged(const Outgoing& outgoing) {
    std::vector<std::uint64_t> sizes;
    std::vector<std::span<const std::byte>> out;
    for (const std::vector<Triangle3f>& triangles : outgoing) {
        sizes.push_back(triangles.size());
        out.push_back(std::as_bytes(std::span(triangles)));
        figures_.bytes_sent += out.back().size();
    }
    figures_.bytes_sent -= out[ranks_.rank()].size(); // that stays here
    const std::vector<std::uint64_t> coming = ranks_.exchange(sizes);
    std::uint64_t total = 0;
    for (const std::uint64_t count : coming)
        total += count;
    std::shared_ptr<const PageArray<Triangle3f>> memory;
    in_agreement(ranks_, [&] { memory = std::make_shared<const PageArray<Triangle3f>>(total); });
    std::vector<std::span<std::byte>> in;
    std::uint64_t at = 0;
    for (const std::uint64_t count : coming) {
        in.push_back(std::as_writable_bytes(memory->span().subspan(at, count)));
        at += count;
    }
    ranks_.exchange(out, in);
    return {memory, reinterpret_cast<const std::byte*>(memory->data()), sizeof(Triangle3f), total};
}

void RankSource::slice_to(const PlateSink& sink, const Plan& plan, const Execution& execution,
                          FileResult& result, const Engine& with) {
    slice_plate_to(sink, plate_, plan, execution, result.report, with);
}

} // namespace lamella
