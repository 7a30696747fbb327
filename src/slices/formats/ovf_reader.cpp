// A table at the end contains the offsets of the job and of its work planes. A table in each work plane
// contains the offsets of its blocks of vectors. Blocks with the same part, parameters, region and kind
// become the layers of one part of the result.

#include "lamella/core/error.hpp"

#include "container/protobuf_reader.hpp"
#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "core/let_go.hpp"
#include "slices/engine/layer_readers.hpp"
#include "slices/engine/slice_engine.hpp"
#include "slices/formats/ovf_format.hpp"

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
    OvfMessages(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

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
    /// Returns the offset behind the message at `offset`.
    [[nodiscard]] std::uint64_t end_of(std::uint64_t offset) const {
        static_cast<void>(ProtobufReader::delimited(bytes_, offset, name_));
        return offset;
    }

    [[nodiscard]] Table table(std::uint64_t offset, ReadLimits& limits) const {
        Table table;
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
                    limits.make_room(table.positions, 1, at_byte(fields.position()));
                    table.positions.push_back(position(value));
                });
        }
        return table;
    }

  private:
    std::string_view bytes_;
    const std::string& name_;
};

/// The messages that were taken, each of which may be taken once.
class TakenMessages {
  public:
    /// Takes the message at `offset` and returns its size. Throws Error{input} if a part of it was taken
    /// before. Otherwise a small file whose tables refer to the same message many times could take very long.
    std::uint64_t take(std::uint64_t offset, const OvfMessages& messages, ReadLimits& limits) {
        const std::uint64_t end = messages.end_of(offset);
        const auto next = ends_.upper_bound(offset);
        const auto last = next == ends_.begin() ? ends_.end() : std::prev(next);
        if ((next != ends_.end() && next->first < end) || (last != ends_.end() && last->second > offset))
            messages.fail(offset, "a second table, header or block", "work planes must share none");
        if (last != ends_.end() && last->second == offset) {
            last->second = end;
        } else {
            limits.add_bytes_at(node_bytes, at_byte(offset));
            ends_.emplace_hint(next, offset, end);
        }
        return end - offset;
    }

  private:
    std::map<std::uint64_t, std::uint64_t> ends_; ///< by the offsets of their beginnings
};

/// A work plane whose messages are known and not read yet.
struct WorkPlane {
    Table table;
    std::uint64_t bytes = 0; ///< size of its shell and its blocks
};

/// The contents of consecutive work planes.
struct OvfPlanes : KeyedLayers<BlockKind> {
    using KeyedLayers::KeyedLayers;

    std::uint64_t first_number = 0; ///< of the first plane
    std::uint64_t last_number = 0;

    /// Compares the numbers of two consecutive planes. If planes have no numbers, all are 0.
    void compare_numbers(std::uint64_t before, std::uint64_t number, const std::string& location) {
        if (number != 0 && number != before + 1)
            found.note(FindingKind::other_plane_numbers, [&] { return location; });
    }

    void append(OvfPlanes&& piece, ReadLimits& limits) {
        compare_numbers(last_number, piece.first_number, piece.layers.front().location);
        last_number = piece.last_number;
        KeyedLayers::append(std::move(piece), limits);
    }
};

/// Reads work planes in ascending order.
class PlaneReader {
  public:
    PlaneReader(const OvfMessages& messages, const JobShell& job, OvfPlanes& planes, ReadLimits& limits)
        : messages_(messages), job_(job), planes_(planes), limits_(limits) {}

    /// Reads plane `i` of the job, whose offset is `begin`.
    void read(std::size_t i, std::uint64_t begin, const Table& table) {
        limits_.make_room(planes_.layers, 1, at_byte(begin));
        RawLayer& raw = planes_.layers.emplace_back();
        raw.location = fmt::format("byte {}", begin);
        raw.begin = i;
        std::int64_t blocks = 0; // number of blocks that the plane claims
        std::uint64_t number = 0;
        ProtobufReader shell = messages_.at(table.shell);
        while (shell.next()) {
            if (shell.field() == ovf::work_plane::z)
                raw.z = finite_real(shell);
            else if (shell.field() == ovf::work_plane::block_count)
                blocks = shell.integer();
            else if (shell.field() == ovf::work_plane::number)
                number = static_cast<std::uint64_t>(shell.integer());
            else if (shell.field() == ovf::work_plane::repeats && shell.integer() != 0)
                planes_.found.note(FindingKind::repeated_planes, at_byte(begin));
            else if (shell.type() == ProtobufType::bits_32 &&
                     (shell.field() <= ovf::work_plane::y || (shell.field() >= ovf::work_plane::x_turn &&
                                                              shell.field() <= ovf::work_plane::z_turn)) &&
                     shell.real() != 0)
                planes_.found.note(FindingKind::moved_planes, at_byte(begin));
        }
        if (blocks != 0 && blocks != static_cast<std::int64_t>(table.positions.size()))
            planes_.found.note(FindingKind::other_block_counts, at_byte(begin));
        if (planes_.layers.size() == 1)
            planes_.first_number = number;
        else
            planes_.compare_numbers(planes_.last_number, number, raw.location);
        planes_.last_number = number;
        for (const std::uint64_t block : table.positions)
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
    OvfPlanes& planes_;
    ReadLimits& limits_;
};

class OvfFile {
  public:
    using Piece = OvfPlanes;

    /// Reads the job.
    OvfFile(std::string_view bytes, const std::string& name, ReadLimits& limits)
        : messages_(bytes, name), limits_(limits), job_(name, limits), all_(limits) {
        const std::uint64_t begin = messages_.position_at(ovf::magic.size());
        taken_.take(begin, messages_, limits);
        Table planes = messages_.table(begin, limits);
        job_.read(bytes, planes.shell);
        offsets_ = std::move(planes.positions);
        if (offsets_.empty())
            throw Error(ErrorKind::input,
                        fmt::format("{}: found no work plane; there must be one at least", name));
    }

    /// Finds the messages of planes, up to the first plane that is not sound.
    [[nodiscard]] PieceBegins begins(Executor& executor) {
        limits_.make_room(planes_, offsets_.size(), at_byte(ovf::magic.size()));
        PieceBegins begins{0};
        std::uint64_t bytes = 0; // of the last piece
        try {
            for (const std::uint64_t begin : offsets_) {
                executor.check_cancelled();
                WorkPlane plane = take_plane(begin);
                if (bytes >= layer_piece_bytes) {
                    begins.push_back(planes_.size());
                    bytes = 0;
                }
                bytes += plane.bytes;
                planes_.push_back(std::move(plane));
            }
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input)
                throw;
            unsound_ = std::current_exception();
        }
        return begins;
    }
    [[nodiscard]] std::size_t end() const { return offsets_.size(); }

    [[nodiscard]] OvfPlanes parse(std::size_t begin, std::size_t limit, const Reading& reading) const {
        OvfPlanes piece(reading.limits);
        piece.end = limit;
        PlaneReader reader(messages_, job_, piece, reading.limits);
        for (std::size_t i = begin; i < limit; ++i) {
            reading.executor.check_cancelled();
            if (reading.again) {
                const std::uint64_t table = messages_.position_at(offsets_[i]);
                reader.read(i, offsets_[i], messages_.table(table, reading.limits));
                continue;
            }
            if (i == planes_.size())
                std::rethrow_exception(unsound_);
            reader.read(i, offsets_[i], planes_[i].table);
            reading.progress.add(planes_[i].bytes);
        }
        return piece;
    }
    [[nodiscard]] RawLayer layer(OvfPlanes&& piece) const { return std::move(piece).only(kinds_); }
    void append(OvfPlanes&& piece, ReadLimits& limits) { all_.append(std::move(piece), limits); }

    /// Returns the layers. Numbers parts in the order of their keys, and the exposures of a part in the order
    /// of the keys of their parameters.
    [[nodiscard]] std::vector<RawLayer> take_layers(LayerFile& file, VectorParts& parts) {
        limits_.give_back(0, planes_.capacity() * sizeof(WorkPlane));
        let_go(planes_);
        taken_ = {};
        if (job_.planes() != 0 && job_.planes() != static_cast<std::int64_t>(all_.layers.size()))
            file.warnings.push_back(fmt::format("the job announces {} work planes; the file has {}",
                                                job_.planes(), all_.layers.size()));
        if (all_.parts.empty())
            all_.parts.number_of({.part = job_.first_part()}, [] { return std::string_view("the end"); });
        all_.parts.put(file, all_.layers, [&](const BlockKind& kind) {
            return parts.of(kind.part, job_.label(kind.part), job_.exposure(kind));
        });
        parts.labels.append_to(file.warnings);
        kinds_ = all_.parts.keys();
        return std::move(all_.layers);
    }

    /// Returns the bottom of the first layer. The heights are the tops of layers.
    [[nodiscard]] double bottom(const std::vector<RawLayer>& layers) const {
        const double first = layers.front().z;
        return first - (job_.layer_thickness() > 0 ? job_.layer_thickness()
                        : layers.size() > 1        ? layers[1].z - first
                                                   : std::max(first, 0.0));
    }
    [[nodiscard]] const Findings& found() const { return all_.found; }

  private:
    WorkPlane take_plane(std::uint64_t begin) {
        const auto take = [&](std::uint64_t offset) {
            return taken_.take(offset, messages_, limits_);
        };
        const std::uint64_t table = messages_.position_at(begin);
        take(table);
        WorkPlane plane{messages_.table(table, limits_)};
        plane.bytes = take(plane.table.shell);
        for (const std::uint64_t block : plane.table.positions)
            plane.bytes += take(block);
        return plane;
    }

    OvfMessages messages_;
    ReadLimits& limits_;
    JobShell job_;
    std::vector<std::uint64_t> offsets_; ///< of the planes
    TakenMessages taken_;
    std::vector<WorkPlane> planes_;
    std::exception_ptr unsound_; ///< the reason why the plane behind `planes_` cannot be read
    OvfPlanes all_;
    std::vector<BlockKind> kinds_; ///< of the parts of the file
};

} // namespace

bool is_ovf(std::string_view bytes) {
    return bytes.starts_with(ovf::magic);
}

LayerFile read_ovf(std::string_view bytes, const std::string& name, ReadLimits& limits,
                   const Execution& execution) {
    LayerFile file = layer_file(name, "ovf", 1);
    file.rounding.single_precision = true;
    const auto ovf = std::make_shared<OvfFile>(bytes, name, limits);
    read_layers_of(*ovf, limits, execution, bytes.size());
    VectorParts parts;
    std::vector<RawLayer> layers = ovf->take_layers(file, parts);
    sort_by_height(layers, file.warnings);
    check_part_planes(file, layers.size(), bytes.size());
    add_layers_by_tops(file, layers, ovf->bottom(layers), limits, execution, parsing_again<OvfFile>(ovf));
    append_to(parts.names, file.warnings);
    append_to(ovf->found(), file.warnings);
    return file;
}

} // namespace lamella
