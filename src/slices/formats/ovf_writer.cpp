// The file consists of the work planes, each with a table of the offsets of its vectors, then the job, which
// holds the shared data, and a table of the offsets of the work planes. The file begins with the offset of
// the job, which is written last.

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"

#include "container/byte_buffer.hpp"
#include "container/protobuf.hpp"
#include "container/quoted.hpp"
#include "slices/engine/exposure_keys.hpp"
#include "slices/engine/float_contour.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/engine/ordered_writer.hpp"
#include "slices/engine/written_heights.hpp"
#include "slices/formats/ovf_format.hpp"
#include "system/atomic_file.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace lamella {

namespace {

constexpr std::size_t position_size = sizeof(std::int64_t);

/// Returns the name of the parameters. For inner contours it includes their number, which the format cannot
/// hold elsewhere.
std::string name_of_parameters(const Exposure& exposure) {
    return exposure.contour > 1 ? fmt::format("{} {}", exposure.parameters.name, exposure.contour)
                                : exposure.parameters.name;
}

ProtobufMessage marking_params(const Exposure& exposure) {
    const ParameterSet& parameters = exposure.parameters;
    ProtobufMessage message;
    const auto put = [&](std::uint32_t field, std::string_view name, double value) {
        constexpr double most = std::numeric_limits<float>::max();
        if (std::abs(value) > most)
            throw Error(ErrorKind::usage,
                        fmt::format("{} of parameters \"{}\" is {:g}; numbers of ovf reach to {:.2g}", name,
                                    excerpt(parameters.name), value, most));
        message.real(field, value);
    };
    put(ovf::marking::power_w, "power_w", parameters.power_w);
    put(ovf::marking::speed_mm_s, "speed_mm_s", parameters.speed_mm_s);
    put(ovf::marking::focus_mm, "focus_mm", parameters.focus_mm);
    put(ovf::marking::jump_speed_mm_s, "jump_speed_mm_s", parameters.jump_speed_mm_s);
    put(ovf::marking::jump_delay_us, "jump_delay_us", parameters.jump_delay_us);
    put(ovf::marking::mark_delay_us, "mark_delay_us", parameters.mark_delay_us);
    message.text(ovf::marking::name, printable_label(name_of_parameters(exposure)));
    return message;
}

ProtobufMessage lpbf_meta_data(const Exposure& exposure) {
    namespace lpbf = ovf::block::lpbf;
    ProtobufMessage message;
    if (exposure.kind == VectorKind::contour)
        message.integer(lpbf::part_area, exposure.contour > 1 ? lpbf::transition_contour : lpbf::contour);
    if (exposure.region == ScanRegion::downskin)
        message.integer(lpbf::skin_type, lpbf::down_skin);
    if (exposure.region == ScanRegion::upskin)
        message.integer(lpbf::skin_type, lpbf::up_skin);
    if (exposure.region == ScanRegion::support)
        message.integer(lpbf::structure_type, lpbf::of_support);
    return message;
}

/// Returns for each part of the file the bytes that follow the vectors in its blocks. Keys of the job count
/// from 1; 0 means no key.
std::vector<std::string> ends_of_blocks(const ExposureKeys& keys) {
    std::vector<std::string> ends;
    for (const auto& [part, exposure] : keys.keys) {
        ProtobufMessage meta_data;
        meta_data.integer(ovf::block::meta::part_key, static_cast<std::int64_t>(part + 1));
        ProtobufMessage block;
        if (exposure)
            block.integer(ovf::block::marking_params_key, static_cast<std::int64_t>(*exposure + 1));
        block.message(ovf::block::meta_data, meta_data);
        if (exposure)
            block.message(ovf::block::lpbf_meta_data, lpbf_meta_data(keys.exposures[*exposure]));
        ends.emplace_back(block.view());
    }
    return ends;
}

void put_keys(const ExposureKeys& keys, double layer_thickness, ProtobufMessage& job) {
    std::int64_t key = 1;
    for (const Exposure& exposure : keys.exposures)
        job.entry(ovf::job::marking_params, key++, marking_params(exposure));
    ProtobufMessage strategy;
    strategy.real(ovf::part::strategy_of_part::layer_thickness_mm, layer_thickness);
    key = 1;
    for (const std::string& label : keys.parts) {
        ProtobufMessage part;
        part.text(ovf::part::name, printable_label(label));
        part.message(ovf::part::strategy, strategy);
        job.entry(ovf::job::parts, key++, part);
    }
}

/// The blocks of vectors of a plane, and the offset of each block.
struct Blocks {
    std::shared_ptr<ByteBuffer> bytes;
    std::vector<std::uint64_t> begins;
};

/// Writes blocks of vectors, each preceded by its length.
class BlockWriter {
  public:
    BlockWriter(const FloatContours& floats, std::uint64_t layer, Blocks& blocks)
        : floats_(floats), layer_(layer), blocks_(blocks) {}

    /// Writes a contour; a ring repeats its first point at the end.
    void put_contour(std::span<const Point2> contour, bool closed, std::string_view of_block) {
        const std::size_t expected = contour.size() + (closed ? 1 : 0);
        char* const begin = room(expected, of_block);
        char* const points = put_header(begin, ovf::block::line_sequence, expected, of_block);
        const std::size_t listed = floats_.put(contour, closed, layer_, points).points;
        if (listed == 0)
            return;
        if (!closed)
            keep_open(points, listed);
        put_header_again(begin, ovf::block::line_sequence, points, listed, of_block);
        end(begin, ovf::block::line_sequence, listed, of_block);
    }

    void put_hatches(std::span<const Point2> hatches, std::string_view of_block) {
        if (hatches.empty())
            return;
        char* const begin = room(hatches.size(), of_block);
        char* const points = put_header(begin, ovf::block::hatches, hatches.size(), of_block);
        const std::size_t listed = floats_.put_lines(hatches, layer_, points);
        if (listed == 0)
            return;
        put_header_again(begin, ovf::block::hatches, points, listed, of_block);
        end(begin, ovf::block::hatches, listed, of_block);
    }

  private:
    /// Separates the ends of a chain by one unit in the last place if they are equal. Readers take a chain of
    /// more than three points with equal ends for a ring.
    static void keep_open(char* points, std::size_t count) {
        char* const last = points + (count - 1) * float_point_size;
        if (count <= 3 || std::memcmp(points, last, float_point_size) != 0)
            return;
        float x = 0;
        std::memcpy(&x, last, sizeof x);
        x = std::nextafter(x, x < 0 ? 0.0F : std::numeric_limits<float>::infinity());
        std::memcpy(last, &x, sizeof x);
    }

    char* room(std::size_t points, std::string_view of_block) {
        constexpr std::size_t most_header = 5 * most_varint;
        return blocks_.bytes->room(most_header + (points + 1) * float_point_size + of_block.size());
    }

    /// Writes the header of the points: the lengths of the block, of its vectors and of their list.
    static char* put_header(char* out, std::uint32_t kind, std::size_t points, std::string_view of_block) {
        constexpr auto bytes = ProtobufType::bytes;
        char text[most_varint];
        const auto size = [&](std::uint64_t value) {
            return static_cast<std::uint64_t>(put_varint(text, value) - text);
        };
        const std::uint64_t list = points * float_point_size;
        const std::uint64_t vectors = size(protobuf_tag(ovf::block::points, bytes)) + size(list) + list;
        const std::uint64_t block =
            size(protobuf_tag(kind, bytes)) + size(vectors) + vectors + of_block.size();
        out = put_varint(out, block);
        out = put_varint(put_varint(out, protobuf_tag(kind, bytes)), vectors);
        return put_varint(put_varint(out, protobuf_tag(ovf::block::points, bytes)), list);
    }

    /// Rewrites the header for fewer points than announced, and moves the points to the new end of the
    /// header.
    static void put_header_again(char* begin, std::uint32_t kind, const char* points, std::size_t count,
                                 std::string_view of_block) {
        char* const moved = begin + header_size(kind, count, of_block);
        if (moved != points)
            std::memmove(moved, points, count * float_point_size);
        put_header(begin, kind, count, of_block);
    }

    static std::size_t header_size(std::uint32_t kind, std::size_t points, std::string_view of_block) {
        char text[5 * most_varint];
        return static_cast<std::size_t>(put_header(text, kind, points, of_block) - text);
    }

    void end(char* begin, std::uint32_t kind, std::size_t points, std::string_view of_block) {
        blocks_.begins.push_back(blocks_.bytes->view().size());
        char* const behind = begin + header_size(kind, points, of_block) + points * float_point_size;
        blocks_.bytes->end_at(put_text(behind, of_block));
    }

    const FloatContours& floats_;
    std::uint64_t layer_;
    Blocks& blocks_;
};

ParameterSet without_spot(ParameterSet set) {
    set.spot_mm = 0;
    return set;
}

class OvfWriter final : public OrderedWriter {
  public:
    OvfWriter(const std::string& path, const LayerFileInfo& info)
        : OrderedWriter(info, {.hatches = true,
                               .gaps = false,
                               .parameters = true,
                               .written_label = printable_label,
                               .kept = without_spot,
                               .not_kept = "spot sizes"}),
          box_(info.box), keys_(info.parts), ends_of_blocks_(ends_of_blocks(keys_)),
          file_(path, Overwriting::yes, info.memory) {
        file_.append(ovf::magic);
        file_.append(bytes_of(std::int64_t{0}));
    }

    std::uint64_t bytes() const noexcept override { return file_.bytes(); }

  private:
    Write formatted(const Plane& plane) override {
        auto blocks = std::make_shared<Blocks>(Blocks{buffer(), {}});
        for (std::size_t part = 0; part < plane.polylines.size(); ++part) {
            const Layer& layer = plane.polylines[part];
            BlockWriter writer(floats_, layer.index, *blocks);
            for (std::size_t i = 0; i < layer.contours(); ++i)
                writer.put_contour(layer.contour(i), layer.closed(i), ends_of_blocks_[part]);
            writer.put_hatches(plane.hatches[part].span(), ends_of_blocks_[part]);
        }
        return [this, blocks](const PlanePosition& offset, Completions& after) {
            if (offset.position == 0) {
                heights_.add(static_cast<float>(offset.bottom), offset.bottom, "bottom", offset.index);
                layer_thickness_ = offset.top - offset.bottom;
            }
            heights_.add(static_cast<float>(offset.top), offset.top, "top", offset.index);
            append_plane(*blocks, offset.top, after);
        };
    }

    void end_file() override {
        ProtobufMessage bounds;
        bounds.real(ovf::box::x_min, box_.min.x);
        bounds.real(ovf::box::y_min, box_.min.y);
        bounds.real(ovf::box::x_max, box_.max.x);
        bounds.real(ovf::box::y_max, box_.max.y);
        ProtobufMessage meta_data;
        meta_data.message(ovf::job::meta::bounds, bounds);
        ProtobufMessage job;
        job.message(ovf::job::meta_data, meta_data);
        put_keys(keys_, layer_thickness_, job);
        job.integer(ovf::job::work_plane_count, static_cast<std::int64_t>(planes_.size()));

        ProtobufMessage table;
        table.integer(ovf::table::shell, static_cast<std::int64_t>(file_.bytes()));
        table.integers(ovf::table::positions, planes_);
        file_.append(job.delimited());
        const std::uint64_t table_offset = file_.bytes();
        file_.append(table.delimited());
        file_.overwrite(ovf::magic.size(), bytes_of(table_offset));
        file_.commit();
    }

    /// Writes a plane, preceded by the offset of its table.
    void append_plane(const Blocks& blocks, double top, Completions& after) {
        const std::uint64_t begin = file_.bytes();
        ProtobufMessage shell;
        shell.real(ovf::work_plane::z, top);
        shell.integer(ovf::work_plane::block_count, static_cast<std::int64_t>(blocks.begins.size()));
        shell.integer(ovf::work_plane::number, static_cast<std::int64_t>(planes_.size()));
        const std::string shell_bytes = shell.delimited();
        planes_.push_back(begin);

        const std::uint64_t shell_offset = begin + position_size + blocks.bytes->view().size();
        const std::uint64_t table_offset = shell_offset + shell_bytes.size();
        std::vector<std::uint64_t> offsets = blocks.begins;
        for (std::uint64_t& offset : offsets)
            offset += begin + position_size;
        ProtobufMessage table;
        table.integer(ovf::table::shell, static_cast<std::int64_t>(shell_offset));
        table.integers(ovf::table::positions, offsets);

        file_.append(bytes_of(table_offset));
        file_.append(blocks.bytes->view(), blocks.bytes, after);
        assert(file_.bytes() == shell_offset);
        file_.append(shell_bytes);
        assert(file_.bytes() == table_offset);
        file_.append(table.delimited());
    }

    Box3 box_;
    ExposureKeys keys_;
    std::vector<std::string> ends_of_blocks_; ///< one for each part
    AtomicFile file_;
    FloatContours floats_{1, &rounding_loss()};
    std::vector<std::uint64_t> planes_; ///< offsets of the planes
    WrittenHeights heights_{"single precision", 1, rounding_loss()};
    double layer_thickness_ = 0;
};

} // namespace

std::unique_ptr<LayerWriter> open_ovf(const std::string& path, const LayerFileInfo& info,
                                      const LayerWriteOptions& /*options*/) {
    return std::make_unique<OvfWriter>(path, info);
}

} // namespace lamella
