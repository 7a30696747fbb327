#include "meshes/ply_binary.hpp"

#include "lamella/core/error.hpp"

#include "container/coordinate_text.hpp"
#include "core/executor.hpp"
#include "core/pages.hpp"
#include "meshes/face_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace lamella {

static_assert(std::endian::native == std::endian::little, "little-endian rows are read as they are");

namespace {

using Corners = std::array<std::uint32_t, 3>;

constexpr std::uint64_t chunk_rows = 16'384;

/// Returns a value at any address, in either byte order.
template <class T, bool swapped>
T value_at(const std::byte* at) {
    std::array<std::byte, sizeof(T)> bytes;
    std::memcpy(bytes.data(), at, sizeof(T));
    if constexpr (swapped)
        std::reverse(bytes.begin(), bytes.end());
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
}

template <class Result, bool swapped>
Result number_at(const std::byte* at, PlyType type) {
    switch (type) {
    case PlyType::int8:
        return static_cast<Result>(value_at<std::int8_t, swapped>(at));
    case PlyType::uint8:
        return static_cast<Result>(value_at<std::uint8_t, swapped>(at));
    case PlyType::int16:
        return static_cast<Result>(value_at<std::int16_t, swapped>(at));
    case PlyType::uint16:
        return static_cast<Result>(value_at<std::uint16_t, swapped>(at));
    case PlyType::int32:
        return static_cast<Result>(value_at<std::int32_t, swapped>(at));
    case PlyType::uint32:
        return static_cast<Result>(value_at<std::uint32_t, swapped>(at));
    case PlyType::int64:
        return static_cast<Result>(value_at<std::int64_t, swapped>(at));
    case PlyType::uint64:
        return static_cast<Result>(value_at<std::uint64_t, swapped>(at));
    case PlyType::float32:
        return static_cast<Result>(value_at<float, swapped>(at));
    case PlyType::float64:
        return static_cast<Result>(value_at<double, swapped>(at));
    }
    return {};
}

bool is_real(PlyType type) {
    return type == PlyType::float32 || type == PlyType::float64;
}

/// Returns the length of a list or the index of a vertex. An impossible value becomes the largest number.
template <bool swapped>
std::uint64_t whole_number_at(const std::byte* at, PlyType type) {
    constexpr std::uint64_t impossible = std::numeric_limits<std::uint64_t>::max();
    if (type == PlyType::uint64)
        return value_at<std::uint64_t, swapped>(at);
    if (is_real(type)) {
        // Some programs write indices as real numbers, which are not exact from 2^53 on.
        const double value = number_at<double, swapped>(at, type);
        return value >= 0 && value < 0x1p53 && value == std::floor(value) ? static_cast<std::uint64_t>(value)
                                                                          : impossible;
    }
    const std::int64_t value = number_at<std::int64_t, swapped>(at, type);
    return value >= 0 ? static_cast<std::uint64_t>(value) : impossible;
}

std::uint32_t as_vertex(std::uint64_t number) {
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(number, FaceChunk::no_vertex));
}

/// Consecutive values of fixed size, or a list.
struct Step {
    std::size_t bytes = 0;
    std::optional<PlyType> list_length = {};
    PlyType item = PlyType::uint8;
};

std::vector<Step> steps_of(const PlyElement& element, std::size_t first, std::size_t last) {
    std::vector<Step> steps;
    for (std::size_t i = first; i < last; ++i) {
        const PlyProperty& property = element.properties[i];
        if (property.list_length)
            steps.push_back({0, property.list_length, property.type});
        else if (!steps.empty() && !steps.back().list_length)
            steps.back().bytes += ply_bytes(property.type);
        else
            steps.push_back({ply_bytes(property.type)});
    }
    return steps;
}

/// Returns the position after these values; null if the file ends before that.
template <bool swapped>
const std::byte* walk(const std::vector<Step>& steps, const std::byte* at, const std::byte* end) {
    for (const Step& step : steps) {
        auto left = static_cast<std::uint64_t>(end - at);
        std::uint64_t bytes = step.bytes;
        if (step.list_length) {
            const std::size_t length_bytes = ply_bytes(*step.list_length);
            if (left < length_bytes)
                return nullptr;
            const std::uint64_t length = whole_number_at<swapped>(at, *step.list_length);
            at += length_bytes;
            left -= length_bytes;
            if (length > left / ply_bytes(step.item))
                return nullptr;
            bytes = length * ply_bytes(step.item);
        }
        if (bytes > left)
            return nullptr;
        at += bytes;
    }
    return at;
}

[[noreturn]] void fail_cut_off(const ByteSource& source, const PlyElement& element, std::uint64_t row) {
    throw Error(
        ErrorKind::input,
        fmt::format("{}: byte {}: the file ends within row {} of {} of the element '{}' (it is cut off, or "
                    "damaged by a transfer in text mode, or its header is wrong)",
                    source.name, source.bytes.size(), row + 1, element.rows, element.name));
}

/// Rows of faces or strips: each has a list of corners, and perhaps other values.
template <bool swapped>
class CornerRows {
  public:
    CornerRows(const ByteSource& source, const PlyElement& element, std::size_t corners)
        : source_(source), element_(element), before_(steps_of(element, 0, corners)),
          after_(steps_of(element, corners + 1, element.properties.size())),
          length_type_(*element.properties[corners].list_length),
          item_type_(element.properties[corners].type), list_{{0, length_type_, item_type_}} {}

    /// The list of corners in a row.
    struct List {
        const std::byte* begin;
        const std::byte* end;
        std::uint64_t length;
        const std::byte* row_end; ///< null if the file ends before
    };
    [[nodiscard]] List at(const std::byte* row) const {
        const std::byte* const end = source_.bytes.data() + source_.bytes.size();
        const std::byte* const list = walk<swapped>(before_, row, end);
        const std::byte* const list_end = list == nullptr ? nullptr : walk<swapped>(list_, list, end);
        if (list_end == nullptr)
            return {};
        return {list + ply_bytes(length_type_), list_end, whole_number_at<swapped>(list, length_type_),
                walk<swapped>(after_, list_end, end)};
    }
    /// Returns the list of row `number`. Throws Error{input} if the row is truncated.
    [[nodiscard]] List at(const std::byte* row, std::uint64_t number) const {
        const List list = at(row);
        if (list.row_end == nullptr)
            fail_cut_off(source_, element_, number);
        return list;
    }
    [[nodiscard]] std::uint64_t corner(const std::byte* item) const {
        return whole_number_at<swapped>(item, item_type_);
    }
    [[nodiscard]] std::uint64_t length(const std::byte* list) const {
        return whole_number_at<swapped>(list, length_type_);
    }
    [[nodiscard]] std::size_t length_bytes() const { return ply_bytes(length_type_); }
    [[nodiscard]] std::size_t item_bytes() const { return ply_bytes(item_type_); }
    [[nodiscard]] bool has_items_of_32_bits() const {
        return item_type_ == PlyType::int32 || item_type_ == PlyType::uint32;
    }
    /// Returns the bytes of a row before and after its list, if these are the same in all rows.
    [[nodiscard]] std::optional<std::pair<std::size_t, std::size_t>> bytes_around_list() const {
        const auto fixed = [](const std::vector<Step>& steps) {
            return steps.empty() || (steps.size() == 1 && !steps[0].list_length);
        };
        if (!fixed(before_) || !fixed(after_))
            return std::nullopt;
        return std::pair{before_.empty() ? 0 : before_[0].bytes, after_.empty() ? 0 : after_[0].bytes};
    }
    [[nodiscard]] const ByteSource& source() const { return source_; }
    [[nodiscard]] const PlyElement& element() const { return element_; }

  private:
    const ByteSource& source_;
    const PlyElement& element_;
    std::vector<Step> before_; ///< steps of a row before the list
    std::vector<Step> after_;
    PlyType length_type_;
    PlyType item_type_;
    std::vector<Step> list_;
};

/// Faces with any number of corners.
template <bool swapped>
class FaceRows {
  public:
    /// `at` is the beginning of the rows.
    FaceRows(const CornerRows<swapped>& rows, const std::byte* at, Executor& executor)
        : rows_(rows), executor_(executor) {
        if (!plan_even_rows(at))
            plan_rows(at);
    }

    [[nodiscard]] std::uint64_t triangles() const { return runs_.back().triangles; }
    [[nodiscard]] std::uint64_t polygons() const { return runs_.back().polygons; }
    [[nodiscard]] const std::byte* end() const { return runs_.back().at; }
    /// Returns the faces with fewer than three corners; their positions are offsets.
    [[nodiscard]] const Occurrences& thin() const { return thin_; }

    /// Writes all faces, in parallel, to arrays of sufficient size.
    void put(FaceMesh& faces, ProgressMeter& progress) {
        executor_.for_chunks(runs_.size() - 1, 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
            if (even_ && corners_ == 3 && rows_.has_items_of_32_bits())
                put_triangles(runs_[i], runs_[i + 1], faces);
            else
                put(runs_[i], runs_[i + 1], faces);
            progress.add(static_cast<std::uint64_t>(runs_[i + 1].at - runs_[i].at));
        });
    }

    /// Returns the beginning of the face that the triangle is part of.
    [[nodiscard]] const std::byte* position(std::uint64_t triangle) const {
        auto run = std::upper_bound(runs_.begin(), runs_.end(), triangle,
                                    [](auto value, const Run& one) { return value < one.triangles; });
        --run;
        const std::byte* at = run->at;
        std::uint64_t before = run->triangles;
        while (true) {
            const auto list = rows_.at(at);
            before += list.length < 3 ? 0 : list.length - 2;
            if (before > triangle)
                return at;
            at = list.row_end;
        }
    }

  private:
    /// The beginning of a chunk of faces, and the numbers of triangles and polygons before it.
    struct Run {
        const std::byte* at;
        std::uint64_t row;
        std::uint64_t triangles;
        std::uint64_t polygons;
    };

    /// Prepares for rows of equal size, as in most files, which contain only triangles. Returns false if they
    /// may differ. All rows are checked in parallel at their expected positions, which are right if every
    /// length equals that of the first row.
    bool plan_even_rows(const std::byte* first) {
        const auto around = rows_.bytes_around_list();
        if (!around)
            return false;
        const auto [header, tail] = *around;
        const ByteSource& source = rows_.source();
        const auto left = static_cast<std::uint64_t>(source.bytes.data() + source.bytes.size() - first);
        if (left < header + rows_.length_bytes())
            return false;
        corners_ = rows_.length(first + header);
        constexpr std::uint64_t many = 1'000;
        if (corners_ < 3 || corners_ > many)
            return false;
        row_bytes_ = header + rows_.length_bytes() + corners_ * rows_.item_bytes() + tail;
        const std::uint64_t rows = rows_.element().rows;
        if (rows > left / row_bytes_)
            return false;
        std::atomic<bool> even{true};
        const std::byte* const first_length = first + header;
        executor_.for_chunks(rows, chunk_rows, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
            const std::byte* at = first_length + begin * row_bytes_;
            for (std::uint64_t i = begin; i < end && even.load(std::memory_order_relaxed);
                 ++i, at += row_bytes_)
                if (rows_.length(at) != corners_)
                    even = false;
        });
        if (!even)
            return false;
        even_ = true;
        index_offset_ = header + rows_.length_bytes();
        for (std::uint64_t row = 0;; row = std::min(row + chunk_rows, rows)) {
            runs_.push_back(
                {first + row * row_bytes_, row, row * (corners_ - 2), corners_ > 3 ? row : std::uint64_t{0}});
            if (row == rows)
                return true;
        }
    }

    /// Finds the rows one after the other.
    void plan_rows(const std::byte* at) {
        std::uint64_t triangles = 0;
        std::uint64_t polygons = 0;
        const std::uint64_t rows = rows_.element().rows;
        for (std::uint64_t row = 0; row < rows; ++row) {
            if (row % chunk_rows == 0) {
                executor_.check_cancelled();
                runs_.push_back({at, row, triangles, polygons});
            }
            const auto list = rows_.at(at, row);
            if (list.length < 3) {
                thin_.note(static_cast<std::size_t>(at - rows_.source().bytes.data()));
            } else {
                triangles += list.length - 2;
                polygons += list.length > 3 ? 1 : 0;
            }
            at = list.row_end;
        }
        runs_.push_back({at, rows, triangles, polygons});
    }

    /// Copies twelve bytes from each row, for rows of equal size with triangles and 32-bit indices. Negative
    /// numbers become large numbers, which are not indices of vertices.
    void put_triangles(const Run& run, const Run& next, FaceMesh& faces) const {
        const std::byte* at = run.at + index_offset_;
        Corners* out = faces.mesh.triangles.data() + run.triangles;
        for (std::uint64_t row = run.row; row < next.row; ++row, at += row_bytes_)
            *out++ = {value_at<std::uint32_t, swapped>(at), value_at<std::uint32_t, swapped>(at + 4),
                      value_at<std::uint32_t, swapped>(at + 8)};
    }

    void put(const Run& run, const Run& next, FaceMesh& faces) const {
        const std::byte* at = run.at;
        Corners* out = faces.mesh.triangles.data() + run.triangles;
        FaceFan* polygon = faces.polygons.data() + run.polygons;
        for (std::uint64_t row = run.row; row < next.row; ++row) {
            const auto list = rows_.at(at);
            const auto corner = [&](std::uint64_t k) {
                return as_vertex(rows_.corner(list.begin + k * rows_.item_bytes()));
            };
            if (list.length > 3)
                *polygon++ = {static_cast<std::uint64_t>(out - faces.mesh.triangles.data()),
                              static_cast<std::uint32_t>(list.length - 2)};
            for (std::uint64_t k = 2; k < list.length; ++k)
                *out++ = {corner(0), corner(k - 1), corner(k)};
            at = list.row_end;
        }
    }

    const CornerRows<swapped>& rows_;
    Executor& executor_;
    std::vector<Run> runs_; ///< and a last entry for the end
    bool even_ = false;     ///< all rows have the form described below
    std::uint64_t corners_ = 0;
    std::uint64_t row_bytes_ = 0;
    std::size_t index_offset_ = 0;
    Occurrences thin_;
};

/// Calls visit(corners, row) for the triangles of all strips; the first strip begins at `at`, and `row` is
/// the beginning of the triangle's strip. Returns the end.
template <bool swapped, class Visit>
const std::byte* for_each_in_strips(const CornerRows<swapped>& rows, const std::byte* at,
                                    const Visit& visit) {
    constexpr std::uint64_t negative = std::numeric_limits<std::uint64_t>::max();
    constexpr std::uint64_t unsigned_minus_one = std::numeric_limits<std::uint32_t>::max();
    for (std::uint64_t row = 0; row < rows.element().rows; ++row) {
        const std::byte* const row_begin = at;
        const auto corners = rows.at(at, row);
        at = corners.row_end;
        TriangleStrip strip;
        for (const std::byte* item = corners.begin; item != corners.end; item += rows.item_bytes()) {
            const std::uint64_t number = rows.corner(item);
            if (number == negative || number == unsigned_minus_one)
                strip.restart();
            else if (const auto triangle = strip.add(as_vertex(number)))
                visit(*triangle, row_begin);
        }
    }
    return at;
}

template <bool swapped>
class BinaryReader {
  public:
    BinaryReader(const ByteSource& source, const PlyHeader& header, const PlyPositions& positions,
                 Remarks& remarks, ReadLimits& limits, const Execution& execution)
        : source_(source), header_(header), positions_(positions), remarks_(remarks), limits_(limits),
          executor_(execution), progress_(execution, Stage::read, source.bytes.size()),
          begin_(source.bytes.data()), at_(begin_ + header.end), end_(begin_ + source.bytes.size()),
          rows_(source, header.elements[positions.face], positions.corners) {}

    MeshFile run() {
        const std::size_t last = std::max(positions_.vertex, positions_.face);
        for (std::size_t i = 0; i <= last; ++i) {
            const PlyElement& element = header_.elements[i];
            if (i == positions_.vertex)
                read_vertices(element);
            else if (i == positions_.face)
                positions_.strips ? read_strips() : read_faces();
            else
                skip(element);
        }
        MeshFile file = make_mesh_file(
            std::move(faces_), source_.name, 0, [this](std::uint64_t triangle) { return position(triangle); },
            remarks_, executor_);
        report_rest(last + 1);
        progress_.finish();
        return file;
    }

  private:
    /// Reports bytes after the rows of all elements, which are lost because the counts in the file are wrong.
    /// The elements from `first` on are not needed, so they may be truncated.
    void report_rest(std::size_t first) {
        for (std::size_t i = first; i < header_.elements.size(); ++i) {
            const PlyElement& element = header_.elements[i];
            if (const auto row_bytes = element.row_bytes()) {
                if (*row_bytes != 0 && element.rows > left() / *row_bytes)
                    return;
                at_ += *row_bytes == 0 ? 0 : *row_bytes * element.rows;
                continue;
            }
            const std::vector<Step> steps = steps_of(element, 0, element.properties.size());
            for (std::uint64_t row = 0; row < element.rows; ++row) {
                if (row % chunk_rows == 0)
                    executor_.check_cancelled();
                const std::byte* const next = walk<swapped>(steps, at_, end_);
                if (next == nullptr)
                    return;
                at_ = next;
            }
        }
        const auto is_white = [](std::byte byte) {
            return is_blank(static_cast<char>(byte));
        };
        if (!std::all_of(at_, end_, is_white))
            remarks_.add(fmt::format("byte {}: left out {} bytes from here on, beyond the rows of the header",
                                     at_ - begin_, left()));
    }

    [[nodiscard]] std::uint64_t left() const { return static_cast<std::uint64_t>(end_ - at_); }

    /// Throws if the file is too short for all rows of an element without lists; such rows have equal sizes.
    void check_room(const PlyElement& element, std::size_t row_bytes) const {
        if (row_bytes != 0 && element.rows > left() / row_bytes)
            fail_cut_off(source_, element, left() / row_bytes);
    }

    void skip(const PlyElement& element) {
        if (const auto row_bytes = element.row_bytes()) {
            check_room(element, *row_bytes);
            at_ += *row_bytes * (*row_bytes == 0 ? 0 : element.rows);
            return;
        }
        const std::vector<Step> steps = steps_of(element, 0, element.properties.size());
        for (std::uint64_t row = 0; row < element.rows; ++row)
            step_over(element, steps, row);
    }

    void step_over(const PlyElement& element, const std::vector<Step>& steps, std::uint64_t row) {
        if (row % chunk_rows == 0)
            executor_.check_cancelled();
        const std::byte* const next = walk<swapped>(steps, at_, end_);
        if (next == nullptr)
            fail_cut_off(source_, element, row);
        at_ = next;
    }

    void read_vertices(const PlyElement& element) {
        constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
        if (element.rows > most)
            throw Error(ErrorKind::limit, fmt::format("{}: {} vertices are too many, at most {} can be held",
                                                      source_.name, element.rows, most));
        const auto row_bytes = element.row_bytes();
        if (!row_bytes) {
            read_uneven_vertices(element);
            return;
        }
        check_room(element, *row_bytes);
        limits_.add_bytes(element.rows * sizeof(Point3));
        std::array<std::size_t, 3> offsets{};
        std::array<PlyType, 3> types{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            types[axis] = element.properties[positions_.coordinates[axis]].type;
            for (std::size_t i = 0; i < positions_.coordinates[axis]; ++i)
                offsets[axis] += ply_bytes(element.properties[i].type);
        }
        std::vector<Point3>& vertices = faces_.mesh.vertices;
        resize_in_huge_pages(executor_, vertices, element.rows);
        const auto fill = [&](auto number) {
            executor_.for_chunks(element.rows, chunk_rows,
                                 [&](std::uint64_t begin, std::uint64_t end, unsigned) {
                                     const std::byte* row = at_ + begin * *row_bytes;
                                     for (std::uint64_t i = begin; i < end; ++i, row += *row_bytes)
                                         // Adding zero turns -0 into +0.
                                         vertices[i] = {number(row + offsets[0], types[0]) + 0.0,
                                                        number(row + offsets[1], types[1]) + 0.0,
                                                        number(row + offsets[2], types[2]) + 0.0};
                                     progress_.add((end - begin) * *row_bytes);
                                 });
        };
        if (types == std::array{PlyType::float32, PlyType::float32, PlyType::float32})
            fill([](const std::byte* at, PlyType) { return double{value_at<float, swapped>(at)}; });
        else
            fill([](const std::byte* at, PlyType type) { return number_at<double, swapped>(at, type); });
        at_ += element.rows * *row_bytes;
    }

    /// Reads rows that contain lists, one after the other.
    void read_uneven_vertices(const PlyElement& element) {
        const std::vector<Step> row_steps = steps_of(element, 0, element.properties.size());
        std::array<std::vector<Step>, 3> steps;
        for (std::size_t axis = 0; axis < 3; ++axis)
            steps[axis] = steps_of(element, 0, positions_.coordinates[axis]);
        for (std::uint64_t row = 0; row < element.rows; ++row) {
            const std::byte* const begin = at_;
            step_over(element, row_steps, row);
            std::array<double, 3> p{};
            for (std::size_t axis = 0; axis < 3; ++axis)
                p[axis] = number_at<double, swapped>(walk<swapped>(steps[axis], begin, at_),
                                                     element.properties[positions_.coordinates[axis]].type) +
                          0.0;
            limits_.add_bytes(sizeof(Point3));
            faces_.mesh.vertices.push_back({p[0], p[1], p[2]});
        }
    }

    void read_faces() {
        FaceRows<swapped>& faces = face_rows_.emplace(rows_, at_, executor_);
        constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
        if (faces.triangles() > most)
            throw Error(ErrorKind::limit, fmt::format("{}: {} triangles are too many, at most {} can be held",
                                                      source_.name, faces.triangles(), most));
        limits_.add_triangles(faces.triangles());
        limits_.add_bytes(faces.triangles() * sizeof(Corners) + faces.polygons() * sizeof(FaceFan));
        resize_in_huge_pages(executor_, faces_.mesh.triangles, faces.triangles());
        faces_.polygons.resize(faces.polygons());
        faces.put(faces_, progress_);
        at_ = faces.end();
        if (faces.thin().count != 0)
            report_thin_faces(remarks_, fmt::format("byte {}", faces.thin().first), faces.thin().count);
    }

    void read_strips() {
        strips_ = at_;
        std::uint64_t triangles = 0;
        at_ = for_each_in_strips(rows_, strips_, [&](const Corners&, const std::byte*) { ++triangles; });
        limits_.add_triangles(triangles);
        limits_.add_bytes(triangles * sizeof(Corners));
        faces_.mesh.triangles.reserve(triangles);
        for_each_in_strips(rows_, strips_, [&](const Corners& triangle, const std::byte*) {
            faces_.mesh.triangles.push_back(triangle);
        });
        progress_.add(static_cast<std::uint64_t>(at_ - strips_));
    }

    [[nodiscard]] std::string position(std::uint64_t triangle) const {
        const std::byte* found = strips_;
        std::uint64_t count = 0;
        if (face_rows_)
            found = face_rows_->position(triangle);
        else
            for_each_in_strips(rows_, strips_, [&](const Corners&, const std::byte* row) {
                if (count++ == triangle)
                    found = row;
            });
        return fmt::format("byte {}", found - begin_);
    }

    const ByteSource& source_;
    const PlyHeader& header_;
    const PlyPositions& positions_;
    Remarks& remarks_;
    ReadLimits& limits_;
    Executor executor_;
    ProgressMeter progress_;
    const std::byte* begin_;
    const std::byte* at_;
    const std::byte* end_;

    FaceMesh faces_;
    CornerRows<swapped> rows_;
    std::optional<FaceRows<swapped>> face_rows_;
    const std::byte* strips_ = nullptr; ///< beginning of their rows
};

} // namespace

MeshFile read_ply_binary(const ByteSource& source, const PlyHeader& header, const PlyPositions& positions,
                         Remarks& remarks, ReadLimits& limits, const Execution& execution) {
    if (header.form == PlyForm::big_endian)
        return BinaryReader<true>(source, header, positions, remarks, limits, execution).run();
    return BinaryReader<false>(source, header, positions, remarks, limits, execution).run();
}

} // namespace lamella
