// A table at the end contains the offsets of the job and of its work planes. A table in each work plane
// contains the offsets of its blocks of vectors. Blocks with the same part, parameters, region and kind
// become the layers of one part of the result.

#include "lamella/core/error.hpp"

#include "container/ovf_format.hpp"
#include "container/protobuf_reader.hpp"
#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "read/layer_assembly.hpp"
#include "read/layer_pieces.hpp"
#include "read/layer_readers.hpp"
#include "read/read_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <compare>
#include <cstring>
#include <exception>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// Properties that all blocks of one part of the result share.
struct BlockKind {
    std::int64_t part = 0;
    std::int64_t parameters = 0;
    std::int64_t structure = 0;
    std::int64_t skin = 0;
    std::int64_t area = 0;

    friend auto operator<=>(const BlockKind&, const BlockKind&) = default;
};

/// Offsets of messages.
struct Table {
    std::uint64_t shell = 0;
    std::vector<std::uint64_t> positions;
};

constexpr std::size_t most_text = 4096;

double finite_real(const ProtobufReader& field) {
    const float value = field.real();
    if (!std::isfinite(value))
        field.fail("a number that is not finite", "it must be one");
    return static_cast<double>(value);
}

/// Properties of the job that apply to all blocks: parameters and parts.
class JobShell {
  public:
    JobShell(const std::string& name, ReadLimits& limits) : name_(name), limits_(limits) {}

    void read(std::string_view bytes, std::uint64_t offset) {
        ProtobufReader job = ProtobufReader::delimited(bytes, offset, name_);
        while (job.next()) {
            if (job.field() == ovf::job::marking_params)
                read_entry(job, [&](std::int64_t key, const ProtobufReader& value) {
                    parameters_[key] = read_parameters(value);
                });
            else if (job.field() == ovf::job::parts)
                read_entry(job, [&](std::int64_t key, const ProtobufReader& value) {
                    labels_[key] = read_part(value);
                });
            else if (job.field() == ovf::job::work_plane_count)
                planes_ = job.integer();
        }
    }

    // Returns the number of planes; 0 if the job does not specify it.
    [[nodiscard]] std::int64_t planes() const noexcept { return planes_; }
    [[nodiscard]] double layer_thickness() const noexcept { return layer_thickness_; }
    /// Returns the key of the part for blocks that specify no part.
    [[nodiscard]] std::int64_t first_part() const { return labels_.empty() ? 0 : labels_.begin()->first; }
    [[nodiscard]] std::string label(std::int64_t part) const {
        const auto label = labels_.find(part);
        return label == labels_.end() ? std::string() : label->second;
    }
    /// Returns whether there are parameters with this key.
    [[nodiscard]] bool has_parameters(std::int64_t key) const { return parameters_.count(key) != 0; }
    /// Returns the exposure of blocks of this kind; nullopt if they have no parameters.
    [[nodiscard]] std::optional<Exposure> exposure(const BlockKind& kind) const {
        const auto parameters = parameters_.find(kind.parameters);
        if (parameters == parameters_.end())
            return std::nullopt;
        namespace lpbf = ovf::block::lpbf;
        Exposure exposure; // its part is set later
        exposure.parameters = parameters->second;
        exposure.region = kind.structure == lpbf::of_support ? ScanRegion::support
                          : kind.skin == lpbf::down_skin     ? ScanRegion::downskin
                          : kind.skin == lpbf::up_skin       ? ScanRegion::upskin
                                                             : ScanRegion::core;
        exposure.kind = kind.area == lpbf::volume ? VectorKind::hatch : VectorKind::contour;
        std::string& name = exposure.parameters.name;
        name = printable(name, most_text);
        if (kind.area == lpbf::contour)
            exposure.contour = 1;
        else if (kind.area == lpbf::transition_contour)
            exposure.contour = take_number(name);
        return exposure;
    }

  private:
    /// Takes the number of an inner contour, which follows the name of its parameters.
    static std::uint32_t take_number(std::string& name) {
        constexpr std::uint32_t second = 2;
        const std::size_t blank = name.rfind(' ');
        if (blank == std::string::npos)
            return second;
        std::uint32_t number = 0;
        const char* const end = name.data() + name.size();
        const auto [behind, error] = std::from_chars(name.data() + blank + 1, end, number);
        if (error != std::errc() || behind != end || number < second)
            return second;
        name.resize(blank);
        return number;
    }

    /// Reads an entry of a map. An absent key is 0, an absent value an empty message.
    template <class Take>
    void read_entry(const ProtobufReader& map, const Take& take) {
        std::int64_t key = 0;
        std::optional<ProtobufReader> value;
        ProtobufReader entry = map.message();
        while (entry.next()) {
            if (entry.field() == ovf::map_entry::key)
                key = entry.integer();
            else if (entry.field() == ovf::map_entry::value)
                value = entry.message();
        }
        limits_.add_bytes_at(node_bytes + sizeof(ParameterSet) + map.bytes().size(), at_byte(map.position()));
        take(key, value.value_or(ProtobufReader({}, map.position(), name_)));
    }

    static ParameterSet read_parameters(ProtobufReader fields) {
        struct Number {
            std::uint32_t field;
            double ParameterSet::*member;
        };
        static constexpr Number numbers[] = {{ovf::marking::power_w, &ParameterSet::power_w},
                                             {ovf::marking::speed_mm_s, &ParameterSet::speed_mm_s},
                                             {ovf::marking::focus_mm, &ParameterSet::focus_mm},
                                             {ovf::marking::jump_speed_mm_s, &ParameterSet::jump_speed_mm_s},
                                             {ovf::marking::jump_delay_us, &ParameterSet::jump_delay_us},
                                             {ovf::marking::mark_delay_us, &ParameterSet::mark_delay_us}};
        ParameterSet set = unknown_parameters();
        while (fields.next()) {
            if (fields.field() == ovf::marking::name)
                set.name = fields.bytes();
            for (const Number& number : numbers)
                if (fields.field() == number.field)
                    set.*number.member = finite_real(fields);
        }
        if (const std::string_view name = negative_parameter(set); !name.empty())
            fields.fail(fmt::format("parameters with a {} below 0", name), "it must be 0 or more");
        return set;
    }

    /// Returns the label of the part.
    std::string read_part(ProtobufReader fields) {
        std::string label;
        while (fields.next()) {
            if (fields.field() == ovf::part::name)
                label = fields.bytes();
            else if (fields.field() == ovf::part::strategy)
                read_strategy(fields.message());
        }
        return label;
    }

    void read_strategy(ProtobufReader fields) {
        while (fields.next())
            if (fields.field() == ovf::part::strategy_of_part::layer_thickness_mm)
                layer_thickness_ = finite_real(fields);
    }

    const std::string& name_;
    ReadLimits& limits_;
    std::map<std::int64_t, ParameterSet> parameters_;
    std::map<std::int64_t, std::string> labels_;
    std::int64_t planes_ = 0;
    double layer_thickness_ = 0;
};

/// The messages of a file, by their offsets.
class OvfMessages {
  public:
    OvfMessages(std::string_view bytes, const std::string& name, ReadLimits& limits)
        : bytes_(bytes), name_(name), limits_(limits) {}

    [[noreturn]] void fail(std::uint64_t offset, const std::string& found,
                           const std::string& expected) const {
        throw Error(ErrorKind::input,
                    fmt::format("{}, byte {}: found {}; {}", name_, offset, found, expected));
    }

    /// Returns the 64-bit offset that is stored at `offset`.
    [[nodiscard]] std::uint64_t position_at(std::uint64_t offset) const {
        std::int64_t position = 0;
        if (offset > bytes_.size() || bytes_.size() - offset < sizeof position)
            fail(offset, "the end of the file", "expected the offset of a table here");
        std::memcpy(&position, bytes_.data() + offset, sizeof position);
        if (position < 0 || static_cast<std::uint64_t>(position) >= bytes_.size())
            fail(offset, fmt::format("a table at byte {}", position),
                 fmt::format("the file has {}", bytes_.size()));
        return static_cast<std::uint64_t>(position);
    }

    [[nodiscard]] ProtobufReader at(std::uint64_t offset) const {
        return ProtobufReader::delimited(bytes_, offset, name_);
    }

    /// Takes the message at `offset` and returns its size. Throws Error{input} if a part of it was taken
    /// before. Otherwise a small file whose tables refer to the same message many times could take very long.
    std::uint64_t take(std::uint64_t offset) {
        std::uint64_t end = offset;
        static_cast<void>(ProtobufReader::delimited(bytes_, end, name_));
        const auto next = taken_.upper_bound(offset);
        const auto last = next == taken_.begin() ? taken_.end() : std::prev(next);
        if ((next != taken_.end() && next->first < end) || (last != taken_.end() && last->second > offset))
            fail(offset, "a second table, header or block", "work planes must share none");
        if (last != taken_.end() && last->second == offset) {
            last->second = end;
        } else {
            limits_.add_bytes_at(node_bytes, at_byte(offset));
            taken_.emplace_hint(next, offset, end);
        }
        return end - offset;
    }

    /// Takes a table.
    Table take_table(std::uint64_t offset) {
        Table table;
        take(offset);
        ProtobufReader fields = at(offset);
        while (fields.next()) {
            const auto position = [&](std::int64_t value) {
                if (value < 0 || static_cast<std::uint64_t>(value) >= bytes_.size())
                    fields.fail(fmt::format("a message at byte {}", value),
                                fmt::format("the file has {}", bytes_.size()));
                return static_cast<std::uint64_t>(value);
            };
            if (fields.field() == ovf::table::shell)
                table.shell = position(fields.integer());
            else if (fields.field() == ovf::table::positions)
                fields.integers([&](std::int64_t value) {
                    limits_.make_room(table.positions, 1, at_byte(fields.position()));
                    table.positions.push_back(position(value));
                });
        }
        return table;
    }

  private:
    std::string_view bytes_;
    const std::string& name_;
    ReadLimits& limits_;
    std::map<std::uint64_t, std::uint64_t> taken_; ///< begin and end of the messages taken
};

/// A work plane whose messages are known and not read yet.
struct WorkPlane {
    std::uint64_t begin = 0;
    Table table;
    std::uint64_t bytes = 0; ///< size of its shell and its blocks
};

/// The contents of consecutive work planes.
struct Planes {
    explicit Planes(ReadLimits& limits) : parts(limits) {}

    std::vector<RawLayer> layers;
    PartNumbers<BlockKind> parts;
    Findings found;
    std::uint64_t first_number = 0; ///< of the first plane
    std::uint64_t last_number = 0;
    std::size_t end = 0; ///< index of the plane that follows

    /// Compares the numbers of two consecutive planes. If planes have no numbers, all are 0.
    void compare_numbers(std::uint64_t before, std::uint64_t number, const std::string& location) {
        if (number != 0 && number != before + 1)
            found.note(FindingKind::other_plane_numbers, [&] { return location; });
    }
};

/// Reads work planes in ascending order.
class PlaneReader {
  public:
    PlaneReader(const OvfMessages& messages, const JobShell& job, Planes& planes, ReadLimits& limits)
        : messages_(messages), job_(job), planes_(planes), limits_(limits) {}

    void read(const WorkPlane& plane) {
        limits_.make_room(planes_.layers, 1, at_byte(plane.begin));
        RawLayer& raw = planes_.layers.emplace_back();
        raw.location = fmt::format("byte {}", plane.begin);
        raw.begin = plane.begin;
        std::int64_t blocks = 0; // number of blocks that the plane claims
        std::uint64_t number = 0;
        ProtobufReader shell = messages_.at(plane.table.shell);
        while (shell.next()) {
            if (shell.field() == ovf::work_plane::z)
                raw.z = finite_real(shell);
            else if (shell.field() == ovf::work_plane::block_count)
                blocks = shell.integer();
            else if (shell.field() == ovf::work_plane::number)
                number = static_cast<std::uint64_t>(shell.integer());
            else if (shell.field() == ovf::work_plane::repeats && shell.integer() != 0)
                planes_.found.note(FindingKind::repeated_planes, at_byte(plane.begin));
            else if (shell.type() == ProtobufType::bits_32 &&
                     (shell.field() <= ovf::work_plane::y || (shell.field() >= ovf::work_plane::x_turn &&
                                                              shell.field() <= ovf::work_plane::z_turn)) &&
                     shell.real() != 0)
                planes_.found.note(FindingKind::moved_planes, at_byte(plane.begin));
        }
        if (blocks != 0 && blocks != static_cast<std::int64_t>(plane.table.positions.size()))
            planes_.found.note(FindingKind::other_block_counts, at_byte(plane.begin));
        if (planes_.layers.size() == 1)
            planes_.first_number = number;
        else
            planes_.compare_numbers(planes_.last_number, number, raw.location);
        planes_.last_number = number;
        for (const std::uint64_t block : plane.table.positions)
            read_block(block, raw);
    }

  private:
    void read_block(std::uint64_t begin, RawLayer& raw) {
        ProtobufReader fields = messages_.at(begin);
        BlockKind kind;
        std::optional<ProtobufReader> lines;
        std::optional<ProtobufReader> hatches;
        bool says_kind = false;
        while (fields.next()) {
            if (fields.field() == ovf::block::line_sequence)
                lines = fields.message();
            else if (fields.field() == ovf::block::hatches)
                hatches = fields.message();
            else if (fields.field() <= ovf::block::last_of_vectors)
                planes_.found.note(FindingKind::other_vectors, at_byte(begin));
            else if (fields.field() == ovf::block::marking_params_key)
                kind.parameters = fields.integer();
            else if (fields.field() == ovf::block::laser_index && fields.integer() != 0)
                planes_.found.note(FindingKind::blocks_of_lasers, at_byte(begin));
            else if (fields.field() == ovf::block::repeats && fields.integer() != 0)
                planes_.found.note(FindingKind::repeated_blocks, at_byte(begin));
            else if (fields.field() == ovf::block::meta_data)
                read_meta_data(fields.message(), kind);
            else if (fields.field() == ovf::block::lpbf_meta_data) {
                says_kind = true;
                read_lpbf_meta_data(fields.message(), kind);
            }
        }
        const bool has_parameters = job_.has_parameters(kind.parameters);
        if (!has_parameters && kind.parameters != 0)
            messages_.fail(begin, fmt::format("a block with parameters of the key {}", kind.parameters),
                           "the job must have them");
        if (!has_parameters)
            kind = {.part = kind.part}; // all blocks without parameters belong to one part
        else if (!says_kind && lines)
            kind.area = ovf::block::lpbf::contour; // without metadata the type of vectors determines the
                                                   // region
        if (lines)
            add_line_sequence(*lines, begin, planes_.parts.number_of(kind, at_byte(begin)), raw);
        if (hatches)
            add_hatches(*hatches, begin, planes_.parts.number_of(kind, at_byte(begin)), raw);
    }

    static void read_meta_data(ProtobufReader fields, BlockKind& kind) {
        while (fields.next())
            if (fields.field() == ovf::block::meta::part_key)
                kind.part = fields.integer();
    }

    static void read_lpbf_meta_data(ProtobufReader fields, BlockKind& kind) {
        while (fields.next()) {
            if (fields.field() == ovf::block::lpbf::part_area)
                kind.area = fields.integer();
            else if (fields.field() == ovf::block::lpbf::skin_type)
                kind.skin = fields.integer();
            else if (fields.field() == ovf::block::lpbf::structure_type)
                kind.structure = fields.integer();
        }
    }

    /// Adds points from pairs of x and y; `numbers` is the number of floats in an item.
    void add_points(ProtobufReader fields, std::uint64_t begin, std::size_t numbers,
                    std::vector<Point2>& to) {
        std::string_view list;
        while (fields.next()) {
            if (fields.field() != ovf::block::points)
                continue;
            if (!list.empty())
                fields.fail("a second list of points", "there must be one");
            list = fields.bytes();
        }
        const std::size_t item = numbers * sizeof(float);
        if (list.size() % item != 0)
            messages_.fail(begin, fmt::format("vectors of {} bytes", list.size()),
                           fmt::format("each point or line has {}", item));
        limits_.make_room(to, list.size() / (2 * sizeof(float)), at_byte(begin));
        for (std::size_t at = 0; at < list.size(); at += 2 * sizeof(float)) {
            float p[2];
            std::memcpy(p, list.data() + at, sizeof p);
            if (!std::isfinite(p[0]) || !std::isfinite(p[1]))
                messages_.fail(begin, "a point that is not finite", "coordinates must be numbers");
            to.push_back({static_cast<double>(p[0]) + 0.0, static_cast<double>(p[1]) + 0.0});
        }
    }

    void add_line_sequence(const ProtobufReader& lines, std::uint64_t begin, std::uint32_t part,
                           RawLayer& raw) {
        add_points(lines, begin, 2, raw.points);
        const bool closed = raw.points.size() - raw.contour_begin() > 3 && raw.returns();
        raw.end_contour(closed, part, limits_, at_byte(begin), planes_.found);
    }

    void add_hatches(const ProtobufReader& hatches, std::uint64_t begin, std::uint32_t part, RawLayer& raw) {
        add_points(hatches, begin, 4, raw.hatches);
        raw.end_hatches(part, limits_, at_byte(begin));
    }

    const OvfMessages& messages_;
    const JobShell& job_;
    Planes& planes_;
    ReadLimits& limits_;
};

class OvfReader {
  public:
    OvfReader(std::string_view bytes, const std::string& name, LayerFile& file, ReadLimits& limits,
              const Execution& execution)
        : bytes_(bytes), name_(name), file_(file), limits_(limits), executor_(execution),
          progress_(execution, Stage::read, bytes.size()), messages_(bytes, name, limits), job_(name, limits),
          all_(limits) {}

    void read() {
        const Table planes = messages_.take_table(messages_.position_at(ovf::magic.size()));
        job_.read(bytes_, planes.shell);
        read_planes(planes.positions);
        if (all_.layers.empty())
            throw Error(ErrorKind::input,
                        fmt::format("{}: found no work plane; there must be one at least", name_));
        if (job_.planes() != 0 && job_.planes() != static_cast<std::int64_t>(all_.layers.size()))
            file_.warnings.push_back(fmt::format("the job announces {} work planes; the file has {}",
                                                 job_.planes(), all_.layers.size()));
        number_parts();
        make_layers();
        append_to(names_, file_.warnings);
        append_to(all_.found, file_.warnings);
        progress_.finish();
    }

  private:
    /// Reads the work planes at these offsets: finds their messages first, and then reads those on all
    /// threads.
    void read_planes(const std::vector<std::uint64_t>& offsets) {
        std::vector<WorkPlane> planes;
        limits_.make_room(planes, offsets.size(), at_byte(ovf::magic.size()));
        PieceBegins begins;
        std::exception_ptr error; // of the plane after those found
        std::uint64_t bytes = 0;  // of the last piece
        try {
            for (const std::uint64_t begin : offsets) {
                executor_.check_cancelled();
                WorkPlane plane{begin, messages_.take_table(messages_.position_at(begin)), 0};
                plane.bytes += messages_.take(plane.table.shell);
                for (const std::uint64_t block : plane.table.positions)
                    plane.bytes += messages_.take(block);
                if (begins.empty() || bytes >= layer_piece_bytes) {
                    begins.push_back(planes.size());
                    bytes = 0;
                }
                bytes += plane.bytes;
                planes.push_back(std::move(plane));
            }
        } catch (const Error& found) {
            if (found.kind() != ErrorKind::input)
                throw;
            error = std::current_exception();
        }
        if (!planes.empty())
            read_pieces(
                begins, planes.size(), executor_,
                [&](std::size_t begin, std::size_t end) {
                    return read_piece(std::span(planes).subspan(begin, end - begin), end);
                },
                [&](Planes&& piece) { take(std::move(piece)); });
        if (error)
            std::rethrow_exception(error);
        limits_.give_back(0, planes.capacity() * sizeof(WorkPlane));
    }

    Planes read_piece(std::span<const WorkPlane> planes, std::size_t end) {
        Planes piece(limits_);
        piece.end = end;
        PlaneReader reader(messages_, job_, piece, limits_);
        for (const WorkPlane& plane : planes) {
            executor_.check_cancelled();
            reader.read(plane);
            progress_.add(plane.bytes);
        }
        end_layers(piece.layers, limits_);
        return piece;
    }

    void take(Planes&& piece) {
        all_.compare_numbers(all_.last_number, piece.first_number, piece.layers.front().location);
        all_.last_number = piece.last_number;
        all_.found.add(piece.found);
        all_.parts.add(
            piece.parts, piece.layers, [](const BlockKind& kind) { return kind; },
            [&] { return std::string_view(piece.layers.front().location); });
        append_layers(all_.layers, std::move(piece.layers), limits_);
    }

    /// Numbers parts in the order of their keys, and the exposures of a part in the order of the keys of
    /// their parameters.
    void number_parts() {
        if (all_.parts.empty())
            all_.parts.number_of({.part = job_.first_part()}, at_byte(bytes_.size()));
        ReadLabels read_labels;
        std::map<std::int64_t, std::string> labels; // of parts with vectors
        all_.parts.put(file_, all_.layers, [&](const BlockKind& kind) {
            const auto [label, is_new] = labels.try_emplace(kind.part);
            if (is_new)
                label->second = names_.of(read_labels.of(job_.label(kind.part)));
            PartInfo part{.label = label->second, .box = {}, .exposure = job_.exposure(kind)};
            if (part.exposure) {
                part.exposure->part = label->second;
                part.label = part.exposure->label();
            }
            return part;
        });
        read_labels.append_to(file_.warnings);
    }

    /// Makes layers; the heights are their tops.
    void make_layers() {
        sort_by_height(all_.layers, file_.warnings);
        check_part_planes(file_, all_.layers.size(), bytes_.size());
        const double first = all_.layers.front().z;
        const double first_step = job_.layer_thickness() > 0 ? job_.layer_thickness()
                                  : all_.layers.size() > 1   ? all_.layers[1].z - first
                                                             : std::max(first, 0.0);
        add_layers_by_tops(file_, all_.layers, first - first_step, limits_, executor_,
                           [bytes = bytes_, &name = name_,
                            job = std::make_shared<const JobShell>(std::move(job_)),
                            kinds = all_.parts.keys()](std::size_t begin, ReadLimits& limits) {
                               OvfMessages messages(bytes, name, limits);
                               Planes planes(limits);
                               PlaneReader(messages, *job, planes, limits)
                                   .read({begin, messages.take_table(messages.position_at(begin)), 0});
                               planes.parts.put(planes.layers.front(), kinds);
                               return only_layer(std::move(planes.layers));
                           });
    }

    std::string_view bytes_;
    const std::string& name_;
    LayerFile& file_;
    ReadLimits& limits_;
    Executor executor_;
    ProgressMeter progress_;
    OvfMessages messages_;
    JobShell job_;
    Planes all_;
    DistinctNames names_;
};

} // namespace

bool is_ovf(std::string_view bytes) {
    return bytes.starts_with(ovf::magic);
}

LayerFile read_ovf(std::string_view bytes, const std::string& name, ReadLimits& limits,
                   const Execution& execution) {
    LayerFile file = layer_file(name, "ovf", 1);
    file.rounding.single_precision = true;
    OvfReader(bytes, name, file, limits, execution).read();
    return file;
}

} // namespace lamella
