#include "meshes/stl_binary.hpp"

#include "lamella/core/error.hpp"

#include "container/read_limits.hpp"
#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "core/pages.hpp"
#include "mesh/folds.hpp"
#include "meshes/remarks.hpp"
#include "system/memory_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

static_assert(std::endian::native == std::endian::little, "binary STL is viewed in place, as little-endian");

namespace {

/// Offset of the corners of the first triangle in a file.
constexpr std::size_t corners_at = stl_header_bytes + stl_normal_bytes;

/// About a megabyte: small enough to distribute to threads, large enough that overhead is negligible.
constexpr std::uint64_t chunk_triangles = 20'000;

/// Number of triangles of a chunk of a stream. It equals that of a chunk of a fold, so that sums over the
/// chunks have the same bits as sums over the whole mesh. jobs/feed finds a chunk again by its number.
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

/// Reads the corners of records batch by batch, on all threads, each through a buffer of its own if the file
/// is not in memory. Calls body(corners, begin, end, worker); `begin` and `end` are counted from the first of
/// the records, and `corners` are those of record `begin`. `corners` is valid only during the call.
template <class Body>
void for_batches(const ByteSource& source, RecordRange records, Executor& executor, const Body& body) {
    const std::uint64_t count = records.end - records.begin;
    // A thread reads some chunks in succession: edges at the border of two chunks are found sooner then.
    const std::uint64_t successive =
        std::clamp<std::uint64_t>(count / batch_triangles / (8 * executor.workers()), 1, 8) * batch_triangles;
    std::vector<PageArray<std::byte>> buffers(source.file ? executor.workers() : 0);
    executor.for_chunks(count, successive, [&](std::uint64_t first, std::uint64_t last, unsigned worker) {
        for (std::uint64_t begin = first; begin < last && !executor.stopping(); begin += batch_triangles) {
            const std::uint64_t end = std::min(last, begin + batch_triangles);
            const std::uint64_t offset = corners_at + (records.begin + begin) * stl_record_bytes;
            if (!source.file) {
                body(source.bytes.data() + offset, begin, end, worker);
                continue;
            }
            PageArray<std::byte>& buffer = buffers[worker];
            if (buffer.size() == 0)
                buffer = PageArray<std::byte>(std::min(count, batch_triangles) * stl_record_bytes);
            copy_out(source, offset,
                     buffer.span().first((end - begin) * stl_record_bytes - stl_normal_bytes));
            body(buffer.data(), begin, end, worker);
        }
    });
    executor.check_cancelled();
}

/// Lowers a number that several threads lower.
void lower(std::atomic<std::uint64_t>& least, std::uint64_t number) {
    for (std::uint64_t before = least; number < before && !least.compare_exchange_weak(before, number);) {
    }
}

/// The box of the boxes of all workers.
Box3 united(const std::vector<Box3>& boxes) {
    Box3 box;
    for (const Box3& one : boxes)
        box.add(one);
    return box;
}

/// Surveys the records of a file in memory, in place. Returns nothing if a corner is not finite.
std::optional<TriangleSoup> view_records(const ByteSource& source, std::uint64_t n, Executor& executor,
                                         ProgressMeter& progress) {
    const std::byte* const corners = source.bytes.data() + corners_at;
    std::atomic<bool> finite{true};
    std::vector<Box3> boxes(executor.workers());
    executor.for_chunks(n, chunk_triangles, [&](std::uint64_t begin, std::uint64_t end, unsigned worker) {
        const Survey surveyed = survey(corners + begin * stl_record_bytes, end - begin);
        boxes[worker].add(surveyed.box);
        if (!surveyed.finite)
            finite = false;
        progress.add((end - begin) * stl_record_bytes);
    });
    if (!finite)
        return std::nullopt;
    return TriangleSoup(TriangleSoup::KnownFinite{}, source.owner, corners, stl_record_bytes, n,
                        united(boxes));
}

/// Triangles with finite corners, and the index in the file of the first of the others, if there are any.
struct FiniteTriangles {
    TriangleSoup soup;
    std::uint64_t first_nonfinite = 0;
};

/// Copies the corners of the triangles to memory: 36 bytes of each record, after the normal and before the
/// attribute. Each thread reads the file through a buffer that stays in its cache.
FiniteTriangles copy_records(const ByteSource& source, std::uint64_t n, Executor& executor,
                             ProgressMeter& progress) {
    const auto memory = std::make_shared<PageArray<Triangle3f>>(n);
    std::vector<std::uint64_t> kept((n + batch_triangles - 1) / batch_triangles);
    std::atomic<std::uint64_t> first_nonfinite{n};
    std::vector<Box3> boxes(executor.workers());
    for_batches(source, {0, n}, executor,
                [&](const std::byte* corners, std::uint64_t begin, std::uint64_t end, unsigned worker) {
                    const Survey surveyed = survey(corners, end - begin);
                    boxes[worker].add(surveyed.box);
                    Triangle3f* const first = memory->data() + begin;
                    Triangle3f* to = first;
                    for (std::uint64_t i = begin; i < end; ++i, corners += stl_record_bytes) {
                        if (surveyed.finite || is_finite(corners))
                            std::memcpy(to++, corners, sizeof *to);
                        else
                            lower(first_nonfinite, i);
                    }
                    kept[begin / batch_triangles] = static_cast<std::uint64_t>(to - first);
                    progress.add((end - begin) * stl_record_bytes);
                });
    Triangle3f* last = memory->data();
    for (std::size_t batch = 0; batch < kept.size(); ++batch) {
        Triangle3f* const from = memory->data() + batch * batch_triangles;
        last = from == last ? from + kept[batch] : std::copy_n(from, kept[batch], last);
    }
    const auto count = static_cast<std::size_t>(last - memory->data());
    return {TriangleSoup(TriangleSoup::KnownFinite{}, memory,
                         reinterpret_cast<const std::byte*>(memory->data()), sizeof(Triangle3f), count,
                         count == n ? std::optional(united(boxes)) : std::nullopt),
            first_nonfinite};
}

/// Reads the triangles of a file. A file that is in memory is viewed in place if all corners are finite. A
/// file that is read in windows is copied, unless its triangles would take too much memory.
FiniteTriangles read_records(const ByteSource& source, std::uint64_t n, const MeshReadOptions& options,
                             const Execution& execution, Executor& executor, ProgressMeter& progress) {
    const std::uint64_t most = memory_of_file(options.max_memory);
    const std::uint64_t bytes = n * sizeof(Triangle3f);
    if (source.file && bytes <= most)
        return copy_records(source, n, executor, progress);
    const ByteSource viewed = whole(source, execution, most);
    if (std::optional<TriangleSoup> soup = view_records(viewed, n, executor, progress))
        return {*std::move(soup)};
    ReadLimits(source, options).add_bytes(bytes);
    return copy_records(viewed, n, executor, progress);
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
    FiniteTriangles finite = read_records(source, stored, options, execution, executor, progress);
    const std::uint64_t nonfinite = stored - finite.soup.size();
    judge_nonfinite(nonfinite, finite.first_nonfinite, stored, remarks);
    MeshFile file = describe(source, stored, nonfinite, finite.first_nonfinite, remarks);
    file.objects.front().mesh = Mesh(std::move(finite.soup));
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
    for_batches(source, records, executor,
                [&](const std::byte* corners, std::uint64_t begin, std::uint64_t end, unsigned) {
                    const Survey surveyed = survey(corners, end - begin);
                    if (surveyed.finite) {
                        sink(TriangleSoup(TriangleSoup::KnownFinite{}, nullptr, corners, stl_record_bytes,
                                          end - begin, surveyed.box),
                             begin / batch_triangles);
                    } else {
                        std::vector<Triangle3f> finite;
                        for (std::uint64_t i = begin; i < end; ++i, corners += stl_record_bytes) {
                            if (is_finite(corners)) {
                                std::memcpy(&finite.emplace_back(), corners, sizeof(Triangle3f));
                                continue;
                            }
                            nonfinite.fetch_add(1);
                            lower(first_nonfinite, records.begin + i);
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

} // namespace lamella
