#include "read/stl_binary.hpp"

#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "core/pages.hpp"
#include "mesh/folds.hpp"
#include "read/read_limits.hpp"
#include "read/remarks.hpp"
#include "system/memory_size.hpp"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

namespace lamella {

static_assert(std::endian::native == std::endian::little, "binary STL is viewed in place, as little-endian");

namespace {

/// Offset of the corners of the first triangle in a file.
constexpr std::size_t corners_at = stl_header_bytes + stl_normal_bytes;

/// About a megabyte: small enough to distribute to threads, large enough that overhead is negligible.
constexpr std::uint64_t chunk_triangles = 20'000;

/// Number of triangles of a chunk of a stream. It equals that of a chunk of a fold, so that sums over the
/// chunks have the same bits as sums over the whole mesh. pipeline/feed finds a chunk again by its number.
constexpr std::uint64_t batch_triangles = fold_chunk;

// A float is NaN or infinite if all bits of its exponent are set.
constexpr std::uint32_t exponent_bits = 0x7F800000;

using FourWords [[gnu::vector_size(16)]] = std::uint32_t;
using FourFloats [[gnu::vector_size(16)]] = float;

/// Result of one pass over records.
struct Survey {
    bool finite; ///< all corners are finite
    Box3 box;    ///< of the corners; valid if all are finite
};

/// Surveys n records; `corners` is the position of the corners of the first one. Three loads per record and
/// no branches make it as fast as memory.
Survey survey(const std::byte* corners, std::uint64_t n) {
    constexpr FourWords mask = {exponent_bits, exponent_bits, exponent_bits, exponent_bits};
    constexpr float infinity = std::numeric_limits<float>::infinity();
    FourWords bad = {};
    // For each corner x, y, z and an unused value in the last lane.
    std::array<FourFloats, 3> low;
    std::array<FourFloats, 3> high;
    low.fill(FourFloats{infinity, infinity, infinity, infinity});
    high.fill(-low[0]);
    for (std::uint64_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            // The third load begins one value earlier, because the file may end after its corner.
            FourFloats corner;
            std::memcpy(&corner, corners + i * stl_record_bytes + (k == 2 ? 20 : 12 * k), sizeof corner);
            if (k == 2)
                corner = __builtin_shufflevector(corner, corner, 1, 2, 3, 0);
            FourWords words;
            std::memcpy(&words, &corner, sizeof words);
            bad |= FourWords((words & mask) == mask);
            low[k] = corner < low[k] ? corner : low[k];
            high[k] = corner > high[k] ? corner : high[k];
        }
    }
    Survey result{(bad[0] | bad[1] | bad[2] | bad[3]) == 0, {}};
    for (std::size_t k = 0; k < 3 && n != 0; ++k) {
        // Adding zero turns -0 into +0.
        result.box.add(Point3{low[k][0] + 0.0, low[k][1] + 0.0, low[k][2] + 0.0});
        result.box.add(Point3{high[k][0] + 0.0, high[k][1] + 0.0, high[k][2] + 0.0});
    }
    return result;
}

bool is_finite(const std::byte* corners) {
    std::array<std::uint32_t, 9> words{};
    std::memcpy(words.data(), corners, sizeof words);
    return std::none_of(words.begin(), words.end(),
                        [](std::uint32_t word) { return (word & exponent_bits) == exponent_bits; });
}

/// Number of records of each chunk with a corner that is not finite, and index of the first one in the file.
struct NonFinite {
    std::vector<std::uint32_t> per_chunk;
    std::uint64_t total = 0;
    std::uint64_t first = 0;
    Box3 box; ///< of all corners; valid if all are finite
};

/// The records of all triangles in memory, from the corners of the first one on.
struct Records {
    std::shared_ptr<const void> owner;
    const std::byte* corners;
    NonFinite nonfinite;
};

/// Copies the records of a file that is read in windows to memory and surveys each chunk as it arrives,
/// unless they would take too much memory. Otherwise surveys them in place.
Records read_records(const ByteSource& source, std::uint64_t n, const MeshReadOptions& options,
                     const Execution& execution, Executor& executor, ProgressMeter& progress) {
    const std::size_t size = n * stl_record_bytes - stl_normal_bytes;
    const std::uint64_t most = memory_of_file(options.max_memory);
    std::shared_ptr<PageArray<std::byte>> memory;
    ByteSource viewed = source;
    if (source.file && size <= most)
        memory = std::make_shared<PageArray<std::byte>>(size);
    else
        viewed = whole(source, execution, most);
    const std::byte* const corners = memory ? memory->data() : viewed.bytes.data() + corners_at;
    NonFinite found;
    found.per_chunk.resize((n + chunk_triangles - 1) / chunk_triangles);
    std::vector<Box3> boxes(executor.workers());
    executor.for_chunks(n, chunk_triangles, [&](std::uint64_t begin, std::uint64_t end, unsigned worker) {
        const std::size_t location = begin * stl_record_bytes;
        if (memory)
            copy_out(source, corners_at + location,
                     memory->span().subspan(location, std::min<std::uint64_t>(end * stl_record_bytes, size) -
                                                          location));
        const Survey surveyed = survey(corners + location, end - begin);
        boxes[worker].add(surveyed.box);
        if (!surveyed.finite) {
            std::uint32_t count = 0;
            for (std::uint64_t i = begin; i < end; ++i)
                count += is_finite(corners + i * stl_record_bytes) ? 0 : 1;
            found.per_chunk[begin / chunk_triangles] = count;
        }
        progress.add((end - begin) * stl_record_bytes);
    });
    for (const Box3& box : boxes)
        found.box.add(box);
    for (const std::uint32_t count : found.per_chunk)
        found.total += count;
    if (found.total != 0)
        while (is_finite(corners + found.first * stl_record_bytes))
            ++found.first;
    if (memory)
        return {memory, corners, std::move(found)};
    return {viewed.owner, corners, std::move(found)};
}

/// Copies the triangles with finite corners, in order.
TriangleSoup copy_finite(const std::byte* corners, std::uint64_t n, const NonFinite& dropped,
                         Executor& executor) {
    std::vector<std::uint64_t> first_kept(dropped.per_chunk.size());
    std::uint64_t kept = 0;
    for (std::size_t chunk = 0; chunk < first_kept.size(); ++chunk) {
        first_kept[chunk] = kept;
        kept += std::min(chunk_triangles, n - chunk * chunk_triangles) - dropped.per_chunk[chunk];
    }
    const auto memory = std::make_shared<PageArray<Triangle3f>>(kept);
    executor.for_chunks(n, chunk_triangles, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
        Triangle3f* to = memory->data() + first_kept[begin / chunk_triangles];
        for (std::uint64_t i = begin; i < end; ++i)
            if (is_finite(corners + i * stl_record_bytes))
                std::memcpy(to++, corners + i * stl_record_bytes, sizeof *to);
    });
    const auto* first = reinterpret_cast<const std::byte*>(memory->data());
    return {TriangleSoup::KnownFinite{}, memory, first, sizeof(Triangle3f), static_cast<std::size_t>(kept)};
}

/// Returns the text of the header, up to the first byte that is not text, without blanks at its beginning and
/// end.
std::string header_text(std::span<const std::byte> bytes) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), 80);
    const auto is_control = [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    };
    text = text.substr(0, std::find_if(text.begin(), text.end(), is_control) - text.begin());
    const std::size_t first = text.find_first_not_of(' ');
    if (first == std::string_view::npos)
        return {};
    return printable(text.substr(first, text.find_last_not_of(' ') + 1 - first), 80);
}

} // namespace

std::uint32_t stl_declared_count(std::span<const std::byte> bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof count);
    return count;
}

StlExtent stl_extent(std::uint64_t file_bytes, std::uint32_t declared) {
    const std::uint64_t stored = (file_bytes - stl_header_bytes) / stl_record_bytes;
    const bool unknown = declared == 0 || declared == std::numeric_limits<std::uint32_t>::max();
    StlExtent extent{unknown ? stored : std::min<std::uint64_t>(declared, stored), {}};
    const std::uint64_t end = stl_header_bytes + stl_record_bytes * extent.triangles;
    const std::uint64_t rest = file_bytes - end;
    if (unknown && stored != declared)
        extent.remark = fmt::format(
            "byte 80: the count is {}; took the {} triangles that the file has room for", declared, stored);
    else if (stored < declared)
        extent.remark = fmt::format("byte 80: the count is {}, but the file ends after {} whole triangles; "
                                    "took those (the file is cut off, or the count is wrong)",
                                    declared, stored);
    if (rest != 0 && !extent.remark.empty())
        extent.remark += fmt::format(", and left out {} bytes from byte {} on", rest, end);
    else if (rest != 0)
        extent.remark = fmt::format("byte {}: left out {} bytes that follow the {} triangles of the count",
                                    end, rest, declared);
    return extent;
}

namespace {

/// Most records at the end of a file that are searched for zeros, which takes some 20 ms.
constexpr std::uint64_t most_zeros = 1'000'000;

/// Returns how many of the records before `end` are nothing but zeros, up to `most_zeros`.
std::uint64_t zeros_before(const ByteSource& source, std::uint64_t end) {
    constexpr std::uint64_t at_once = 1000;
    std::vector<std::byte> bytes;
    std::uint64_t zeros = 0;
    while (zeros < std::min(end, most_zeros)) {
        const std::uint64_t count = std::min({end - zeros, most_zeros - zeros, at_once});
        bytes.resize(count * stl_record_bytes);
        copy_out(source, stl_header_bytes + (end - zeros - count) * stl_record_bytes, bytes);
        const auto last =
            std::find_if(bytes.rbegin(), bytes.rend(), [](std::byte b) { return b != std::byte{0}; });
        zeros += static_cast<std::uint64_t>(last - bytes.rbegin()) / stl_record_bytes;
        if (last != bytes.rend())
            break;
    }
    return zeros;
}

/// Warns of zeros at the end, which a file has whose transfer or writing was not completed. Throws if the
/// first triangles are zeros, too.
void judge_zeros(const ByteSource& source, std::uint64_t stored, Remarks& remarks) {
    const std::uint64_t zeros = zeros_before(source, stored);
    if (zeros == 0)
        return;
    constexpr std::string_view cause = "the file was not written or transferred completely; get it again";
    constexpr std::uint64_t first = 1000;
    if (zeros == stored || (zeros == most_zeros && zeros_before(source, first) == first))
        throw Error(ErrorKind::input, fmt::format("{}: holds nothing but zeros from byte {} on: {}",
                                                  source.name, stl_header_bytes, cause));
    remarks.add(fmt::format(
        "the last {}{} of {} triangles are nothing but zeros{}: {}", zeros,
        zeros == most_zeros ? " or more" : "", stored,
        zeros == most_zeros
            ? ""
            : fmt::format(" from byte {} on", stl_header_bytes + (stored - zeros) * stl_record_bytes),
        cause));
}

/// Returns the number of triangles, from the header and the size of the file.
std::uint64_t check_header(const ByteSource& source, const MeshReadOptions& options, Remarks& remarks) {
    const std::uint32_t declared = stl_declared_count(source.bytes);
    const auto [stored, remark] = stl_extent(source.size(), declared);
    if (stored == 0)
        throw Error(
            ErrorKind::input,
            fmt::format("{}: holds no triangle: a binary STL file whose count is {} and that ends after "
                        "{} bytes (its first triangle would end at byte {})",
                        source.name, declared, source.size(), stl_header_bytes + stl_record_bytes));
    ReadLimits(source, options).add_triangles(stored);
    if (!remark.empty())
        remarks.add(remark);
    judge_zeros(source, stored, remarks);
    return stored;
}

/// Describes the file without its triangles.
MeshFile describe(const ByteSource& source, std::uint64_t stored, std::uint64_t nonfinite,
                  std::uint64_t first_nonfinite, Remarks& remarks) {
    MeshFile file;
    file.format = "stl-binary";
    file.name = header_text(source.bytes);
    file.stored_triangles = stored;
    file.nonfinite_triangles = nonfinite;
    file.first_nonfinite = first_nonfinite;
    file.objects.push_back({file.name, Mesh()});
    file.instances.push_back({});
    file.warnings = remarks.take();
    return file;
}

/// Reads the records chunk by chunk, on all threads, each into a buffer of its own. Calls
/// body(buffer, begin, end); `begin` and `end` are counted from the first of the records.
template <class Body>
void for_batches(const ByteSource& source, RecordRange records, Executor& executor, const Body& body) {
    const std::uint64_t count = records.end - records.begin;
    // A thread reads some chunks in succession: edges at the border of two chunks are found sooner then.
    const std::uint64_t successive =
        std::clamp<std::uint64_t>(count / batch_triangles / (8 * executor.workers()), 1, 8) * batch_triangles;
    std::vector<std::shared_ptr<PageArray<std::byte>>> batches(executor.workers());
    executor.for_chunks(count, successive, [&](std::uint64_t first, std::uint64_t last, unsigned worker) {
        std::shared_ptr<PageArray<std::byte>>& batch = batches[worker];
        if (!batch)
            batch =
                std::make_shared<PageArray<std::byte>>(std::min(count, batch_triangles) * stl_record_bytes);
        for (std::uint64_t begin = first; begin < last && !executor.stopping(); begin += batch_triangles) {
            const std::uint64_t end = std::min(last, begin + batch_triangles);
            copy_out(source, corners_at + (records.begin + begin) * stl_record_bytes,
                     batch->span().first((end - begin) * stl_record_bytes - stl_normal_bytes));
            body(batch, begin, end);
        }
    });
    executor.check_cancelled();
}

} // namespace

void judge_nonfinite(std::uint64_t count, std::uint64_t first, std::uint64_t stored, Remarks& remarks) {
    if (count == 0)
        return;
    const std::string where = fmt::format("the first is triangle {} at byte {}", first + 1,
                                          stl_header_bytes + stl_record_bytes * first);
    if (count == stored)
        throw Error(ErrorKind::input,
                    fmt::format("{}: holds no usable triangle: each of the {} has a corner that is NaN or "
                                "infinite ({})",
                                remarks.file_name(), stored, where));
    remarks.add(fmt::format("left out {} of {} triangles, which have a corner that is NaN or infinite ({})",
                            count, stored, where));
}

MeshFile read_stl_binary(const ByteSource& source, const MeshReadOptions& options,
                         const Execution& execution) {
    Remarks remarks(source.name, options.strict);
    const std::uint64_t stored = check_header(source, options, remarks);
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::read, source.size());
    const auto [owner, corners, nonfinite] =
        read_records(source, stored, options, execution, executor, progress);
    judge_nonfinite(nonfinite.total, nonfinite.first, stored, remarks);
    if (nonfinite.total != 0) // the other triangles are copied
        ReadLimits(source, options).add_bytes((stored - nonfinite.total) * sizeof(Triangle3f));

    MeshFile file = describe(source, stored, nonfinite.total, nonfinite.first, remarks);
    file.objects.front().mesh = nonfinite.total == 0
                                    ? Mesh(TriangleSoup(TriangleSoup::KnownFinite{}, owner, corners,
                                                        stl_record_bytes, stored, nonfinite.box))
                                    : Mesh(copy_finite(corners, stored, nonfinite, executor));
    progress.finish();
    return file;
}

MeshFile stream_stl_binary(const ByteSource& source, const TriangleSink& sink, const MeshReadOptions& options,
                           const Execution& execution, const std::optional<RecordRange>& share) {
    Remarks remarks(source.name, options.strict);
    const std::uint64_t stored = check_header(source, options, remarks);
    const RecordRange records = share.value_or(RecordRange{0, stored});
    if (records.begin > records.end || records.end > stored)
        throw Error(ErrorKind::usage, fmt::format("{}: asked for triangles {} to {}, and there are {}",
                                                  source.name, records.begin, records.end, stored));
    const std::uint64_t count = records.end - records.begin;
    std::atomic<std::uint64_t> nonfinite{0};
    std::atomic<std::uint64_t> first_nonfinite{stored};
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::read, stl_record_bytes * count);
    for_batches(source, records, executor, [&](const auto& batch, std::uint64_t begin, std::uint64_t end) {
        const std::byte* const at = batch->data();
        const Survey surveyed = survey(at, end - begin);
        if (surveyed.finite) {
            sink(TriangleSoup(TriangleSoup::KnownFinite{}, batch, at, stl_record_bytes, end - begin,
                              surveyed.box),
                 begin / batch_triangles);
        } else {
            std::vector<Triangle3f> finite;
            for (std::uint64_t i = 0; i < end - begin; ++i) {
                if (is_finite(at + i * stl_record_bytes)) {
                    std::memcpy(&finite.emplace_back(), at + i * stl_record_bytes, sizeof(Triangle3f));
                    continue;
                }
                nonfinite.fetch_add(1);
                const std::uint64_t number = records.begin + begin + i;
                for (std::uint64_t before = first_nonfinite;
                     number < before && !first_nonfinite.compare_exchange_weak(before, number);) {
                }
            }
            if (!finite.empty())
                sink(TriangleSoup(std::move(finite)), begin / batch_triangles);
        }
        progress.add((end - begin) * stl_record_bytes);
    });
    if (!share)
        judge_nonfinite(nonfinite, first_nonfinite, stored, remarks);
    progress.finish();
    return describe(source, stored, nonfinite, first_nonfinite, remarks);
}

std::uint64_t stl_chunk_hash(const TriangleSoup& chunk) {
    return XXH3_64bits(chunk.data(), (chunk.size() - 1) * chunk.stride() + sizeof(Triangle3f));
}

void stream_stl_binary_again(const ByteSource& source, const TriangleSink& sink, const ChunkHashes& hashes,
                             const Execution& execution) {
    const StlExtent extent = stl_extent(source.size(), stl_declared_count(source.bytes));
    Executor executor(execution);
    for_batches(source, {0, extent.triangles}, executor,
                [&](const auto& batch, std::uint64_t begin, std::uint64_t end) {
                    const std::uint64_t number = begin / batch_triangles;
                    const TriangleSoup chunk(TriangleSoup::KnownFinite{}, batch, batch->data(),
                                             stl_record_bytes, end - begin);
                    if (stl_chunk_hash(chunk) != hashes.at(number))
                        throw Error(ErrorKind::input,
                                    fmt::format("{}: was changed while it was read", source.name));
                    sink(chunk, number);
                });
}

} // namespace lamella
