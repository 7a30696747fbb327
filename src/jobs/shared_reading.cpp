#include "jobs/shared_reading.hpp"

#include "core/stopwatch.hpp"
#include "jobs/packed.hpp"
#include "mesh/folds.hpp"

#include <algorithm>
#include <memory>
#include <mutex>
#include <string>

namespace lamella {
namespace {

RecordRange part_of_process(std::uint64_t records, std::size_t process, std::size_t processes) {
    const std::uint64_t chunks = (records + fold_chunk - 1) / fold_chunk;
    const auto bound = [&](std::size_t p) {
        return std::min(records, chunks * p / processes * fold_chunk);
    };
    return {bound(process), bound(process + 1)};
}

} // namespace

RecordRange SharedReading::part_of(std::uint64_t records) const noexcept {
    return part_of_process(records, processes_.process(), processes_.size());
}

FileSurvey SharedReading::whole(const FileSurvey& mine) {
    FileSurvey all;
    all.first_unusable = ~std::uint64_t{0};
    for (const std::string& message : processes_.gather(Packer()
                                                            .put(mine.box)
                                                            .put(mine.unusable)
                                                            .put(mine.first_unusable)
                                                            .put(mine.first_corner)
                                                            .take())) {
        Unpacker from(message);
        const FileSurvey one{from.get<Box3>(), from.get<std::uint64_t>(), from.get<std::uint64_t>(),
                             from.get<Point3f>()}; // in the order of put()
        if (one.unusable > 0)
            all.first_unusable = std::min(all.first_unusable, one.first_unusable);
        all.unusable += one.unusable;
        if (all.box.empty())
            all.first_corner = one.first_corner;
        all.box.add(one.box);
    }
    return all;
}

void SharedReading::add_others(PlaneCounts& counts, NearFaceFinder& near, std::vector<double>& volumes) {
    processes_.sum(counts.numbers());
    const std::vector<NearFaces> faces = near.found();
    const std::vector<std::string> messages = processes_.gather(
        Packer().put_all(std::span(faces)).put_all(std::span<const double>(volumes)).take());
    volumes.clear();
    for (std::size_t process = 0; process < messages.size(); ++process) {
        Unpacker from(messages[process]);
        const std::vector<NearFaces> found = from.get_all<NearFaces>();
        if (process != processes_.process())
            near.add(found);
        const std::vector<double> chunks = from.get_all<double>();
        volumes.insert(volumes.end(), chunks.begin(), chunks.end());
    }
}

RangeFinder SharedReading::ranges_of_all(const Plan& plan, PlaneRange mine) {
    std::vector<PlaneRange> ranges;
    for (const std::string& message : processes_.gather(Packer().put(mine).take()))
        ranges.push_back(Unpacker(message).get<PlaneRange>());
    return {plan, ranges};
}

void SharedReading::exchange(std::uint64_t records, std::uint64_t at_once,
                             std::span<const PlacedShape> shapes, const RangeFinder& finder,
                             const std::function<void(const RecordRange&, const TriangleSink&)>& read,
                             const std::function<void(std::size_t shape, const TriangleSoup&)>& store) {
    using Outgoing = std::vector<std::vector<Triangle3f>>; // by process
    const std::size_t processes = processes_.size();
    const RecordRange mine = part_of(records);
    std::uint64_t longest = 0;
    for (std::size_t p = 0; p < processes; ++p) {
        const RecordRange part = part_of_process(records, p, processes);
        longest = std::max(longest, part.end - part.begin);
    }
    for (std::uint64_t done = 0; done < longest; done += at_once) {
        const RecordRange now{std::min(mine.begin + done, mine.end),
                              std::min(mine.begin + done + at_once, mine.end)};
        std::vector<Outgoing> outgoing(shapes.size(), Outgoing(processes));
        std::mutex mutex;
        const TriangleSink sort = [&](const TriangleSoup& batch, std::uint64_t) {
            std::vector<RangeFinder::Touched> touched;
            for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
                finder.find(batch.transformed(shapes[shape].second), touched);
                Outgoing sorted(processes);
                for (std::size_t i = 0; i < batch.size(); ++i)
                    for (std::uint32_t p = touched[i].begin; p < touched[i].end; ++p)
                        sorted[p].push_back(batch.stored(i));
                const std::lock_guard lock(mutex);
                for (std::size_t p = 0; p < processes; ++p)
                    outgoing[shape][p].insert(outgoing[shape][p].end(), sorted[p].begin(), sorted[p].end());
            }
        };
        if (now.begin < now.end)
            read(now, sort);
        const Stopwatch exchanging;
        for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
            const TriangleSoup incoming = exchanged(outgoing[shape]);
            outgoing[shape].clear();
            store(shapes[shape].first, incoming);
        }
        seconds_ += exchanging.seconds();
    }
}

/// Sends triangles to the other processes. Returns the received triangles, and those that this process keeps.
TriangleSoup SharedReading::exchanged(std::span<const std::vector<Triangle3f>> outgoing) {
    std::vector<std::span<const Triangle3f>> out;
    for (std::size_t p = 0; p < outgoing.size(); ++p) {
        out.emplace_back(outgoing[p]);
        if (p != processes_.process())
            bytes_sent_ += out[p].size_bytes();
    }
    const auto memory = processes_.exchange<Triangle3f>(out);
    return {TriangleSoup::KnownFinite{}, memory, reinterpret_cast<const std::byte*>(memory->data()),
            sizeof(Triangle3f), memory->size()};
}

} // namespace lamella
