#include "jobs/feed.hpp"

#include "lamella/core/error.hpp"

#include "core/byte_amount.hpp"
#include "core/counted.hpp"
#include "core/executor.hpp"
#include "core/pages.hpp"
#include "core/progress.hpp"
#include "core/stopwatch.hpp"
#include "jobs/plate_builder.hpp"
#include "jobs/plate_names.hpp"
#include "jobs/stream_sums.hpp"
#include "mesh/folds.hpp"
#include "meshes/stl_binary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <variant>

namespace lamella {
namespace {

constexpr std::uint64_t record_bytes = 50; // of a record of a binary STL file

/// Returns the first option that needs the whole mesh in memory, as messages name it; "" if there is none.
std::string first_option_needing_whole_mesh(const FileJob& job, const Engine& engine) {
    if (engine.welds)
        return fmt::format("the engine {}", engine.name);
    if (job.strict)
        return "`strict`";
    if (job.inspect)
        return "`inspect`";
    if (job.repair.weld_tolerance_mm)
        return "`weld_tolerance_mm`";
    if (job.repair.drop_duplicates)
        return "`drop_duplicates`";
    if (job.repair.orient)
        return "`orient`";
    if (std::holds_alternative<AdaptiveLayers>(job.layering.cut))
        return "`adaptive`";
    return {};
}

/// Returns ranges of records that contain all chunks with a triangle cut by one of the planes. Ranges at a
/// short distance are joined; the chunks between them are then read, too.
std::vector<RecordRange> records_on(PlaneRange planes, std::span<const PlaneRange> cuts,
                                    std::uint64_t records) {
    constexpr std::uint64_t close = 16 * fold_chunk;
    std::vector<RecordRange> ranges;
    for (std::size_t batch = 0; batch < cuts.size(); ++batch) {
        if (cuts[batch].end <= planes.begin || planes.end <= cuts[batch].begin)
            continue;
        const std::uint64_t begin = batch * fold_chunk;
        const std::uint64_t end = std::min(records, begin + fold_chunk);
        if (ranges.empty() || ranges.back().end + close < begin)
            ranges.push_back({begin, end});
        else
            ranges.back().end = end;
    }
    return ranges;
}

std::optional<std::uint32_t> neighbours_of(const FileJob& job) {
    if (!job.scan)
        return std::nullopt;
    return job.scan->downskin.layers + job.scan->upskin.layers;
}

/// Returns the largest number of points on any `planes` consecutive planes.
std::uint64_t most_points(const RangeSurvey& survey, std::uint32_t planes) {
    std::uint64_t most = 0;
    std::uint64_t points = 0;
    for (std::uint32_t p = 0; p < survey.planes(); ++p) {
        points += survey.points(p);
        if (p >= planes)
            points -= survey.points(p - planes);
        most = std::max(most, points);
    }
    return most;
}

/// Throws if meshes that cannot be sliced in ranges exceed the memory limit. It is called after each file is
/// read; the file at `path` is the last of `files`.
void check_size(const std::string& path, std::span<const MeshFile> files, const JobMemory& memory,
                unsigned threads) {
    std::vector<const Mesh*> meshes;
    std::uint64_t triangles = 0;
    for (const MeshFile& file : files)
        for (const MeshObject& object : file.objects) {
            meshes.push_back(&object.mesh);
            triangles += object.mesh.size();
        }
    if (const std::uint64_t bytes = memory.of_meshes(meshes, threads); bytes > memory.limit)
        throw Error(
            ErrorKind::limit,
            fmt::format("{}: to slice {} triangles{} takes up to {} of memory, above the {} of "
                        "`max_memory`; only STL files that are not compressed are sliced in ranges: write "
                        "the mesh as one, or allow more",
                        path, triangles, files.size() > 1 ? ", those of the files before it among them," : "",
                        byte_amount(bytes), byte_amount(memory.limit)));
}

Error changed_while_read(const std::string& path) {
    return {ErrorKind::input, fmt::format("{}: was changed while it was read", path)};
}

} // namespace

// ------------------------------------------------------------------------------------------------- open

Feed::Feed(const FileJob& job, const Engine& engine, const Execution& execution, SharedReading* shared)
    : memory_(job),
      processes_(shared != nullptr ? shared->processes() : 1), reading_{.strict = job.strict,
                                                                        .include = job.include,
                                                                        .max_triangles = job.max_triangles,
                                                                        .max_memory = job.max_memory},
      measure_volume_(job.layer_statistics), neighbours_(neighbours_of(job)) {
    const unsigned threads = thread_count(execution);
    std::vector<MeshInput> inputs;
    std::uint64_t room = memory_.of_input(threads); // for copies of inputs in memory until they are parsed
    std::uint64_t bytes = 0;
    std::string not_streamed;
    bool divisible = true;
    for (const PlateInput& input : job.inputs) {
        const MeshInput& file = inputs.emplace_back(input.path, room, execution);
        room -= std::min(room, file.bytes_in_memory());
        if (file.can_stream())
            bytes += memory_.of_whole(file, threads);
        else
            not_streamed = file.path();
        divisible = divisible && file.can_stream() && file.records().has_value();
    }
    if (bytes != 0)
        bytes += memory_.besides_meshes(threads);
    const bool too_large = bytes > memory_.limit;

    const std::string needs_all = first_option_needing_whole_mesh(job, engine);
    const bool can_stream = not_streamed.empty() && needs_all.empty();
    in_ranges_ = can_stream && too_large;
    if (can_stream && divisible)
        shared_ = shared;
    if (in_ranges_ || shared_ != nullptr) {
        look_at(job, std::move(inputs), execution);
        return;
    }
    if (too_large && memory_.asked)
        throw Error(
            ErrorKind::limit,
            fmt::format("{}: to be sliced whole takes up to {} of memory, above the {} of "
                        "`max_memory`; it would be sliced in ranges, but for {}",
                        name_of(job.inputs), byte_amount(bytes), byte_amount(memory_.limit),
                        !needs_all.empty()
                            ? fmt::format("{}, which needs the whole mesh", needs_all)
                            : fmt::format("{}, which has to be read whole: only STL files that are not "
                                          "compressed can be read in parts",
                                          not_streamed)));
    read(job, std::move(inputs), execution);
}

Feed::Feed(const FileJob& job, Plate plate)
    : memory_(job), measure_volume_(job.layer_statistics), neighbours_(neighbours_of(job)),
      plate_(std::move(plate)) {}

void Feed::read(const FileJob& job, std::vector<MeshInput> inputs, const Execution& execution) {
    const unsigned threads = thread_count(execution);
    std::vector<MeshFile> meshes;
    for (MeshInput& file : inputs) {
        const MeshInput input = std::move(file); // a copy in memory is freed when the file has been parsed
        const bool stl = input.can_stream();
        meshes.push_back(input.read(reading_, execution));
        if (memory_.asked && !stl)
            check_size(input.path(), meshes, memory_, threads);
    }
    plate_ = load_plate(job.inputs, std::move(meshes), execution, job.max_memory);
}

/// The first pass. Finds the bounding boxes, and counts the unusable triangles (not all coordinates finite).
void Feed::look_at(const FileJob& job, std::vector<MeshInput> inputs, const Execution& execution) {
    for (MeshInput& input : inputs) {
        File& file = files_.emplace_back(File{std::move(input), std::nullopt, std::nullopt, {}, 0, {}, {}});
        file.records = file.input.records();
        if (shared_ != nullptr) {
            file.part = shared_->part_of(file.records.value());
            figures_.triangles_read += file.part->end - file.part->begin;
        }
        bytes_to_read_ += 3 * bytes_of(file, file.part);
    }
    PlateBuilder builder(job.max_memory);
    for (std::size_t i = 0; i < files_.size(); ++i) {
        File& file = files_[i];
        const double unit = job.inputs[i].unit_mm.value_or(1);
        const Transform placement = compose(job.inputs[i].placement, scaling(unit, unit, unit));
        Extent extent(placement);
        MeshFile read = stream(
            file, [&](const TriangleSoup& batch, std::uint64_t number) { extent.add(batch, number); },
            execution, file.part);
        FileSurvey found{extent.box(), read.nonfinite_triangles, read.first_nonfinite, extent.first_corner()};
        if (shared_ != nullptr) { // the process has checked only its own part
            found = shared_->whole(found);
            Remarks remarks(file.input.path(), reading_.strict);
            judge_nonfinite(found.unusable, found.first_unusable, read.stored_triangles, remarks);
            for (std::string& remark : remarks.take())
                read.warnings.push_back(std::move(remark));
        }
        file.first_corner = found.first_corner;
        file.triangles = read.stored_triangles - found.unusable;
        if (found.box.empty())
            throw Error(ErrorKind::input, file.input.path() + ": no triangle of the file is usable");
        builder.add(job.inputs[i], std::move(read), [&](const Mesh&, const Transform& where) {
            if (where != placement)
                throw Error(ErrorKind::internal, "a streamed mesh stands elsewhere than was thought");
            return found.box;
        });
    }
    plate_ = builder.finish();
    for (std::size_t shape = 0; shape < plate_.shapes.size(); ++shape)
        files_[plate_.shapes[shape].input].shapes.push_back(shape);
}

std::uint64_t Feed::bytes_of(const File& file, const std::optional<RecordRange>& part) {
    return part ? record_bytes * (part->end - part->begin) : file.input.bytes();
}

/// Streams a file. The passes are reported as one stage of progress.
MeshFile Feed::stream(const File& file, const TriangleSink& sink, const Execution& execution,
                      const std::optional<RecordRange>& part) {
    const Stopwatch reading;
    const Execution counted = with_progress(execution, [&](const Progress& progress) {
        return std::optional(
            Progress{Stage::read, std::min(bytes_read_ + progress.done, bytes_to_read_), bytes_to_read_});
    });
    MeshFile read = file.input.stream(sink, reading_, counted, part);
    bytes_read_ += bytes_of(file, part);
    figures_.read_seconds += reading.seconds();
    return read;
}

std::uint64_t Feed::triangles(std::size_t shape) const {
    return files_.empty() ? plate_.shapes[shape].mesh.size() : files_[plate_.shapes[shape].input].triangles;
}

const std::string& Feed::path_of(std::size_t shape) const {
    return plate_.files[plate_.shapes[shape].input].path;
}

const Transform& Feed::placement(std::size_t shape) const {
    return plate_.shapes[shape].mesh.soup()->placement();
}

// ------------------------------------------------------------------------------------------------ count

PlaneCounts Feed::count(const Plan& plan, const Execution& execution) {
    counts_.clear();
    if (files_.empty())
        for (const PlateShape& shape : plate_.shapes)
            counts_.push_back(count_planes(shape.mesh, plan, execution));
    else
        count_streams(plan, execution);
    return counts_of_parts(plan.layers.size());
}

PlaneCounts Feed::counts_of_parts(std::size_t planes) const {
    PlaneCounts all(planes);
    for (const PlatePart& part : plate_.parts)
        all.add(counts_[part.shape]);
    for (const PlateNegative& negative : plate_.negatives)
        all.add(counts_[negative.shape]);
    return all;
}

/// The second pass. Counts the triangles and points on each plane.
void Feed::count_streams(const Plan& plan, const Execution& execution) {
    const std::size_t shapes = plate_.shapes.size();
    begin_near_faces(plan);
    std::deque<PlaneCounter> counters; // a deque, since counters cannot move
    std::deque<VolumeSum> volumes;
    for (std::size_t shape = 0; shape < shapes; ++shape) {
        counters.emplace_back(plan);
        volumes.emplace_back(placement(shape), files_[plate_.shapes[shape].input].first_corner);
    }
    for (File& file : files_) {
        const std::uint64_t records = file.part ? 0 : file.records.value_or(0);
        file.cuts.assign((records + fold_chunk - 1) / fold_chunk, {});
        static_cast<void>(stream(
            file,
            [&](const TriangleSoup& batch, std::uint64_t number) {
                PlaneRange cut{static_cast<std::uint32_t>(plan.layers.size()), 0};
                for (const std::size_t shape : file.shapes) {
                    const TriangleSoup placed = batch.transformed(placement(shape));
                    const PlaneRange planes = counters[shape].add(placed);
                    if (planes.size() > 0)
                        cut = {std::min(cut.begin, planes.begin), std::max(cut.end, planes.end)};
                    if (near_[shape].any())
                        near_[shape].add(placed, 0, placed.size());
                    if (measure_volume_)
                        volumes[shape].add(placed, number);
                }
                if (number < file.cuts.size())
                    file.cuts[number] = cut;
            },
            execution, file.part));
    }
    std::vector<double> six_volumes(shapes, 0);
    for (std::size_t shape = 0; shape < shapes; ++shape) {
        counts_.push_back(counters[shape].total());
        std::vector<double> chunks = volumes[shape].chunks();
        if (shared_ != nullptr)
            shared_->add_others(counts_.back(), near_[shape], chunks);
        for (const double chunk : chunks)
            six_volumes[shape] += chunk;
    }
    volume_mm3_ = 0;
    for (const PlatePart& part : plate_.parts)
        volume_mm3_ += six_volumes[part.shape] / 6;
}

void Feed::begin_near_faces(const Plan& plan) {
    near_.clear();
    std::vector<Box3> boxes(plate_.shapes.size());
    for (const PlatePart& part : plate_.parts)
        boxes[part.shape] = part.box;
    for (const PlateNegative& negative : plate_.negatives)
        boxes[negative.shape] = negative.box;
    for (const Box3& box : boxes)
        near_.emplace_back(plan, box);
}

bool Feed::may_have_near_faces() const {
    return std::any_of(near_.begin(), near_.end(), [](const NearFaceFinder& finder) { return finder.any(); });
}

std::vector<Feed::NearPlane> Feed::near_faces() const {
    std::vector<std::uint64_t> copies(near_.size());
    for (const PlatePart& part : plate_.parts)
        ++copies[part.shape];
    for (const PlateNegative& negative : plate_.negatives)
        ++copies[negative.shape];
    std::map<std::pair<std::uint32_t, std::size_t>, NearPlane> planes;
    for (std::size_t shape = 0; shape < near_.size(); ++shape)
        for (const NearFaces& faces : near_[shape].found()) {
            if (!near_[shape].matters(faces))
                continue;
            const std::size_t file = plate_.shapes[shape].input;
            NearPlane& plane = planes[{faces.plane, file}];
            plane.plane = faces.plane;
            plane.file = file;
            plane.area_mm2 += static_cast<double>(copies[shape]) * near_[shape].area_mm2(faces);
            plane.farthest_mm = std::max(plane.farthest_mm, faces.farthest_mm);
        }
    std::vector<NearPlane> all;
    for (const auto& [number, plane] : planes)
        all.push_back(plane);
    return all;
}

// ------------------------------------------------------------------------------------------------ bring

std::vector<PlaneRange> Feed::bring(const Plan& plan, PlaneRange mine, const Execution& execution) {
    if (in_memory())
        return mine.size() > 0 ? std::vector{mine} : std::vector<PlaneRange>{};
    ranges_ = ranges_of(plan, mine, thread_count(execution));
    if (is_cheap_to_read_again())
        plan_ = plan;
    else
        store_.emplace(plan, ranges_, counts_);
    for (const PlaneCounts& shape : counts_)
        figures_.triangles_sliced += RangeSurvey(shape).triangles(mine);
    if (shared_ != nullptr)
        bring_shared(plan, mine, execution);
    else if (store_)
        bring_own(mine, *store_, execution);
    if (execution.progress)
        execution.progress({Stage::read, bytes_to_read_, bytes_to_read_});
    return ranges_;
}

/// Returns true if the records that all ranges need are together at most twice the records of all files.
/// Reading again then takes less time than storing all triangles once. Requires a call of `count`.
bool Feed::is_cheap_to_read_again() const {
    constexpr std::uint64_t times_the_files = 2;
    if (ranges_.size() <= 1)
        return false;
    std::uint64_t room = 0;
    std::uint64_t records = 0;
    for (const File& file : files_) {
        if (file.cuts.empty())
            return false;
        room += times_the_files * file.records.value();
        for (const PlaneRange& range : ranges_)
            for (const RecordRange& records_here : records_on(range, file.cuts, file.records.value()))
                records += records_here.end - records_here.begin;
    }
    return records <= room;
}

std::vector<PlaneRange> Feed::ranges_of(const Plan& plan, PlaneRange mine, unsigned threads) const {
    if (mine.size() == 0)
        return {};
    const RangeSurvey survey(part_of(counts_of_parts(plan.layers.size()), mine));
    RangeMemory needed{.threads = threads, .points_in_flight = memory_.points_in_flight()};
    if (plate_.parts.size() + plate_.negatives.size() > 1 || neighbours_) // all layers of a range are held
        needed.points_in_flight = ~std::uint64_t{0};
    std::uint64_t overhead =
        JobMemory::overhead(threads, plan.layers.size(), plate_.shapes.size(), measure_volume_) +
        memory_.of_messages(processes_) + most_points(survey, neighbours_.value_or(0)) * sizeof(Point2);
    for (const File& file : files_)
        overhead += file.input.bytes_in_memory();
    std::uint64_t largest = 0;
    std::uint32_t where = 0;
    for (std::uint32_t p = 0; p < survey.planes(); ++p)
        if (const std::uint64_t bytes = needed.bytes(survey.needs({p, p + 1})); bytes > largest) {
            largest = bytes;
            where = p;
        }
    if (overhead > memory_.limit)
        throw Error(
            ErrorKind::limit,
            fmt::format("{}: {} layers on {} take {} of memory, above the {} of `max_memory`; allow more, "
                        "choose higher layers, or use fewer `threads`",
                        name_of(plate_), plan.layers.size(), counted(threads, "thread"),
                        byte_amount(overhead), byte_amount(memory_.limit)));
    if (overhead + largest > memory_.limit)
        throw Error(ErrorKind::limit,
                    fmt::format("{}: the layer at z = {:.6g} mm alone is cut from {} triangles, which on {} "
                                "takes {} of memory, above the {} of `max_memory`; allow more, or use fewer "
                                "`threads`",
                                name_of(plate_), plan.layers[mine.begin + where].z, survey.points(where),
                                counted(threads, "thread"), byte_amount(overhead + largest),
                                byte_amount(memory_.limit)));
    std::vector<PlaneRange> ranges =
        divide_to_fit(survey, part_of(plan, mine), needed, memory_.limit - overhead);
    for (PlaneRange& range : ranges)
        range = {mine.begin + range.begin, mine.begin + range.end};
    return ranges;
}

/// The third pass of a process that reads all files. Reads the chunks that these planes cut, and ASCII files
/// as a whole.
void Feed::bring_own(PlaneRange planes, RangeStore& store, const Execution& execution) {
    for (const File& file : files_) {
        std::atomic<bool> fits{true};
        std::vector<std::optional<RecordRange>> parts{std::nullopt};
        if (!file.cuts.empty()) {
            const std::vector<RecordRange> cut = records_on(planes, file.cuts, file.records.value());
            parts.assign(cut.begin(), cut.end());
        }
        for (const std::optional<RecordRange>& part : parts)
            static_cast<void>(stream(
                file,
                [&](const TriangleSoup& batch, std::uint64_t) {
                    for (const std::size_t shape : file.shapes)
                        if (!store.add(shape, batch.transformed(placement(shape))))
                            fits = false;
                },
                execution, part));
        if (!fits)
            throw changed_while_read(file.input.path());
    }
    if (const std::optional<std::size_t> shape = store.incomplete())
        throw changed_while_read(path_of(*shape));
}

/// The third pass of processes that each read a part of the files.
void Feed::bring_shared(const Plan& plan, PlaneRange mine, const Execution& execution) {
    const RangeFinder finder = shared_->ranges_of_all(plan, mine);
    for (const File& file : files_) {
        std::vector<SharedReading::PlacedShape> shapes;
        for (const std::size_t shape : file.shapes)
            shapes.emplace_back(shape, placement(shape));
        shared_->exchange(
            file.records.value(), memory_.triangles_in_a_round(processes_), shapes, finder,
            [&](const RecordRange& records, const TriangleSink& sink) {
                static_cast<void>(stream(file, sink, execution, records));
            },
            [&](std::size_t shape, const TriangleSoup& triangles) { store(shape, triangles, execution); });
    }
    figures_.bytes_sent = shared_->bytes_sent();
    figures_.exchange_seconds = shared_->seconds();
    if (const std::optional<std::size_t> shape = store_->incomplete())
        throw changed_while_read(path_of(*shape));
}

void Feed::store(std::size_t shape, const TriangleSoup& triangles, const Execution& execution) {
    constexpr std::uint64_t at_once = std::uint64_t{1} << 13;
    Executor executor(execution);
    const TriangleSoup placed = triangles.transformed(placement(shape));
    executor.for_chunks(placed.size(), at_once, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
        if (!store_->add(shape, placed.part(begin, end)))
            throw changed_while_read(path_of(shape));
    });
    executor.check_cancelled();
}

Plate Feed::take(std::size_t range, const Execution& execution) {
    Plate plate = plate_;
    if (files_.empty())
        return plate;
    const auto take_from = [&](RangeStore& from, std::size_t number) {
        for (std::size_t shape = 0; shape < plate.shapes.size(); ++shape)
            plate.shapes[shape].mesh = from.take(number, shape, execution).transformed(placement(shape));
    };
    if (store_) {
        take_from(*store_, range);
        return plate;
    }
    RangeStore store(*plan_, std::span(&ranges_[range], 1), counts_);
    bring_own(ranges_[range], store, without_progress(execution)); // the end of reading was already reported
    take_from(store, 0);
    return plate;
}

} // namespace lamella
