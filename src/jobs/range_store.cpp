#include "jobs/range_store.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace lamella {

RangeStore::RangeStore(const Plan& plan, std::span<const PlaneRange> ranges,
                       std::span<const PlaneCounts> counts)
    : finder_(plan, ranges), ranges_(ranges.size()), shapes_(counts.size()),
      extents_(ranges.size() * counts.size()) {
    std::vector<RangeSurvey> surveys;
    for (const PlaneCounts& shape : counts)
        surveys.emplace_back(shape);
    // Several files are used because threads that write to one file at the same time block one another in the
    // operating system. Their number is limited because a process can open only a limited number of files,
    // and there may be hundreds of ranges.
    constexpr std::size_t most_files = 16;
    std::vector<std::uint64_t> totals(std::min(ranges_, most_files), 0);
    for (std::size_t range = 0; range < ranges_; ++range)
        for (std::size_t shape = 0; shape < shapes_; ++shape) {
            Extent& its = extent(range, shape);
            std::uint64_t& total = totals[range % totals.size()];
            its.begin = its.next = total;
            its.end = total += surveys[shape].triangles(ranges[range]);
        }
    if (ranges_ <= 1) {
        memory_ = std::make_shared<const PageArray<Triangle3f>>(totals.empty() ? 0 : totals[0]);
        return;
    }
    const std::uint64_t of_all = std::accumulate(totals.begin(), totals.end(), std::uint64_t{0});
    for (const std::uint64_t total : totals)
        files_.emplace_back(total * sizeof(Triangle3f), of_all * sizeof(Triangle3f));
    for (std::size_t range = 0; range < ranges_; ++range)
        for (std::size_t shape = 0; shape < shapes_; ++shape)
            extent(range, shape).file = &files_[range % files_.size()];
}

bool RangeStore::add(std::size_t shape, const TriangleSoup& batch) {
    // A triangle may be cut by planes of all ranges. So the number of copies made at once is limited.
    constexpr std::uint64_t copies_at_once = std::uint64_t{1} << 15;
    std::vector<RangeFinder::Touched> touched;
    finder_.find(batch, touched);
    for (std::size_t from = 0; from < batch.size();) {
        std::size_t to = from;
        for (std::uint64_t copies = 0; to < batch.size() && copies < copies_at_once; ++to)
            copies += touched[to].end - touched[to].begin;
        if (!add_some(shape, batch, touched, from, to))
            return false;
        from = to;
    }
    return true;
}

/// Adds the triangles [from, to), sorted by range.
bool RangeStore::add_some(std::size_t shape, const TriangleSoup& batch,
                          std::span<const RangeFinder::Touched> touched, std::size_t from, std::size_t to) {
    std::vector<std::size_t> begin(ranges_ + 1, 0);
    for (std::size_t i = from; i < to; ++i)
        for (std::uint32_t s = touched[i].begin; s < touched[i].end; ++s)
            ++begin[s + std::size_t{1}];
    for (std::size_t s = 0; s < ranges_; ++s)
        begin[s + 1] += begin[s];
    std::vector<Triangle3f> sorted(begin[ranges_]);
    std::vector<std::size_t> next = begin;
    for (std::size_t i = from; i < to; ++i)
        for (std::uint32_t s = touched[i].begin; s < touched[i].end; ++s)
            sorted[next[s]++] = batch.stored(i);
    for (std::size_t s = 0; s < ranges_; ++s) {
        assert(next[s] == begin[s + 1]);
        if (begin[s] < begin[s + 1] &&
            !put(extent(s, shape), std::span(sorted).subspan(begin[s], begin[s + 1] - begin[s])))
            return false;
    }
    return true;
}

bool RangeStore::put(Extent& extent, std::span<const Triangle3f> triangles) {
    const std::uint64_t at = extent.next.fetch_add(triangles.size(), std::memory_order_relaxed);
    if (at + triangles.size() > extent.end)
        return false;
    if (memory_)
        std::copy(triangles.begin(), triangles.end(), memory_->data() + at);
    else
        extent.file->write(at * sizeof(Triangle3f), std::as_bytes(triangles));
    return true;
}

std::optional<std::size_t> RangeStore::incomplete() const noexcept {
    const auto found =
        std::find_if(extents_.begin(), extents_.end(), [](const Extent& one) { return one.next != one.end; });
    if (found == extents_.end())
        return std::nullopt;
    return static_cast<std::size_t>(found - extents_.begin()) % shapes_;
}

TriangleSoup RangeStore::take(std::size_t range, std::size_t shape, const Execution& execution) {
    const Extent& from = extent(range, shape);
    const std::uint64_t count = from.end - from.begin;
    const auto triangles = static_cast<std::size_t>(count);
    if (memory_)
        return {TriangleSoup::KnownFinite{}, memory_,
                reinterpret_cast<const std::byte*>(memory_->data() + from.begin), sizeof(Triangle3f),
                triangles};
    const auto memory = std::make_shared<const PageArray<Triangle3f>>(count);
    constexpr std::uint64_t at_once = std::uint64_t{1} << 15;
    Executor executor(execution);
    executor.for_chunks(count, at_once, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
        from.file->read((from.begin + begin) * sizeof(Triangle3f),
                        std::as_writable_bytes(memory->span().subspan(begin, end - begin)));
    });
    executor.check_cancelled();
    from.file->forget(from.begin * sizeof(Triangle3f), count * sizeof(Triangle3f));
    return {TriangleSoup::KnownFinite{}, memory, reinterpret_cast<const std::byte*>(memory->data()),
            sizeof(Triangle3f), triangles};
}

} // namespace lamella
