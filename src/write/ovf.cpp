// The file is a work plane after the other, each with a table of where its vectors lie, then the job, which
// has what all of them share, and a table of where work planes lie. The file's first bytes tell where that
// is; they are written last.

#include "write/ovf.hpp"

#include "lamella/core/error.hpp"

#include "container/ovf_format.hpp"
#include "container/protobuf.hpp"
#include "container/text_place.hpp"
#include "core/atomic_file.hpp"
#include "write/byte_buffer.hpp"
#include "write/float_contour.hpp"
#include "write/left_out.hpp"
#include "write/sequential_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

namespace lamella {

namespace {

constexpr std::size_t position_size = sizeof(std::int64_t);

std::string_view position_bytes(const std::uint64_t& position) {
    return {reinterpret_cast<const char*>(&position), position_size};
}

/// The name of the parameters: contours further inwards have their number in it, for which there is no other
/// place.
std::string name_of_parameters(const Exposure& exposure) {
    return exposure.contour > 1 ? fmt::format("{} {}", exposure.parameters.name, exposure.contour)
                                : exposure.parameters.name;
}

ProtobufMessage marking_params(const Exposure& exposure) {
    const ParameterSet& parameters = exposure.parameters;
    ProtobufMessage message;
    message.real(ovf::marking::power_w, parameters.power_w);
    message.real(ovf::marking::speed_mm_s, parameters.speed_mm_s);
    message.real(ovf::marking::focus_mm, parameters.focus_mm);
    message.real(ovf::marking::jump_speed_mm_s, parameters.jump_speed_mm_s);
    message.real(ovf::marking::jump_delay_us, parameters.jump_delay_us);
    message.real(ovf::marking::mark_delay_us, parameters.mark_delay_us);
    constexpr std::size_t most_bytes = 4096;
    message.text(ovf::marking::name, printable(name_of_parameters(exposure), most_bytes));
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

/// What all parts of the file are in the job: parts by their labels, and parameters of exposures that are
/// alike but for the part. Keys count from 1 in the order of execution; 0 is none.
class Keys {
  public:
    explicit Keys(const std::vector<PartInfo>& parts) {
        for (const PartInfo& part : parts) {
            const std::string& label = part.exposure ? part.exposure->part : part.label;
            const std::size_t part_key = key_of(
                parts_, [&](const std::string& known) { return known == label; }, [&] { return label; });
            std::size_t key = 0;
            if (part.exposure)
                key = key_of(
                    exposures_, [&](const Exposure& known) { return is_alike(known, *part.exposure); },
                    [&] { return *part.exposure; });
            ProtobufMessage of_part;
            of_part.integer(ovf::block::meta::part_key, static_cast<std::int64_t>(part_key));
            ProtobufMessage of_block;
            of_block.integer(ovf::block::marking_params_key, static_cast<std::int64_t>(key));
            of_block.message(ovf::block::meta_data, of_part);
            if (part.exposure)
                of_block.message(ovf::block::lpbf_meta_data, lpbf_meta_data(*part.exposure));
            of_blocks_.emplace_back(of_block.view());
        }
    }

    /// What stands behind the vectors in each block of a part of the file.
    [[nodiscard]] std::string_view of_blocks(std::size_t part) const { return of_blocks_[part]; }

    void put(ProtobufMessage& job, double layer_thickness) const {
        for (std::size_t i = 0; i < exposures_.size(); ++i)
            job.entry(ovf::job::marking_params, static_cast<std::int64_t>(i + 1),
                      marking_params(exposures_[i]));
        ProtobufMessage strategy;
        strategy.real(ovf::part::strategy_of_part::layer_thickness_mm, layer_thickness);
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            constexpr std::size_t most_bytes = 4096;
            ProtobufMessage part;
            part.text(ovf::part::name, printable(parts_[i], most_bytes));
            part.message(ovf::part::strategy, strategy);
            job.entry(ovf::job::parts, static_cast<std::int64_t>(i + 1), part);
        }
    }

  private:
    template <class T, class Is, class Make>
    static std::size_t key_of(std::vector<T>& known, const Is& is, const Make& make) {
        const auto found = std::find_if(known.begin(), known.end(), is);
        if (found != known.end())
            return static_cast<std::size_t>(found - known.begin()) + 1;
        known.push_back(make());
        return known.size();
    }

    static bool is_alike(const Exposure& a, const Exposure& b) {
        return a.region == b.region && a.kind == b.kind && a.contour == b.contour &&
               a.parameters == b.parameters;
    }

    std::vector<std::string> parts_;
    std::vector<Exposure> exposures_;
    std::vector<std::string> of_blocks_;
};

/// The vectors of a plane, and where each block of them begins.
struct Blocks {
    std::shared_ptr<ByteBuffer> bytes;
    std::vector<std::uint64_t> begins;
};

/// Blocks of vectors with their lengths in front.
class BlockWriter {
  public:
    BlockWriter(const FloatContours& floats, std::uint64_t layer, Blocks& blocks)
        : floats_(floats), layer_(layer), blocks_(blocks) {}

    /// A ring ends with its first point once more.
    void put_contour(std::span<const Point2> contour, bool closed, std::string_view of_block) {
        const std::size_t expected = contour.size() + (closed ? 1 : 0);
        char* const begin = room(expected, of_block);
        char* const points = put_head(begin, ovf::block::line_sequence, expected, of_block);
        const std::size_t listed = floats_.put(contour, closed, layer_, points).points;
        if (listed == 0)
            return;
        if (listed != expected) {
            char* const moved = begin + head_size(ovf::block::line_sequence, listed, of_block);
            std::memmove(moved, points, listed * float_point_size);
            put_head(begin, ovf::block::line_sequence, listed, of_block);
        }
        end(begin, ovf::block::line_sequence, listed, of_block);
    }

    void put_hatches(std::span<const Point2> hatches, std::string_view of_block) {
        if (hatches.empty())
            return;
        char* const begin = room(hatches.size(), of_block);
        floats_.put_points(hatches, layer_, put_head(begin, ovf::block::hatches, hatches.size(), of_block));
        end(begin, ovf::block::hatches, hatches.size(), of_block);
    }

  private:
    char* room(std::size_t points, std::string_view of_block) {
        constexpr std::size_t most_head = 5 * most_varint;
        return blocks_.bytes->room(most_head + (points + 1) * float_point_size + of_block.size());
    }

    /// What stands in front of the points: the lengths of the block, of its vectors and of their list.
    static char* put_head(char* out, std::uint32_t kind, std::size_t points, std::string_view of_block) {
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

    static std::size_t head_size(std::uint32_t kind, std::size_t points, std::string_view of_block) {
        char text[5 * most_varint];
        return static_cast<std::size_t>(put_head(text, kind, points, of_block) - text);
    }

    void end(char* begin, std::uint32_t kind, std::size_t points, std::string_view of_block) {
        blocks_.begins.push_back(blocks_.bytes->view().size());
        char* const behind = begin + head_size(kind, points, of_block) + points * float_point_size;
        blocks_.bytes->end_at(put_text(behind, of_block));
    }

    const FloatContours& floats_;
    std::uint64_t layer_;
    Blocks& blocks_;
};

class OvfWriter final : public LayerWriter {
  public:
    OvfWriter(const std::string& path, const LayerFileInfo& info)
        : box_(info.box), parts_(info.parts), keys_(info.parts), file_(path, Overwriting::yes), order_(info),
          left_out_({.open_chains = true, .hatches = true}), floats_(1, &left_out_.rounding()) {
        file_.append(ovf::magic);
        file_.append(position_bytes(0));
    }

    std::function<void()> prepare(std::span<const Layer> parts) override {
        order_.check_parts(parts.size());
        auto blocks = std::make_shared<Blocks>(Blocks{buffers_->take(), {}});
        for (std::size_t part = 0; part < parts.size(); ++part) {
            const Layer& layer = parts[part];
            BlockWriter writer(floats_, layer.index, *blocks);
            for (std::size_t i = 0; i < layer.contours(); ++i)
                writer.put_contour(layer.contour(i), layer.closed(i), keys_.of_blocks(part));
            writer.put_hatches(layer.hatches.span(), keys_.of_blocks(part));
        }
        const Layer& layer = parts.front();
        return [this, blocks, index = layer.index, z = layer.z, bottom = layer.bottom, top = layer.top] {
            order_.next(z);
            check_top(top, index);
            if (order_.count() == 1)
                layer_thickness_ = top - bottom;
            append_plane(*blocks, top);
        };
    }

    void finish() override {
        order_.end();
        ProtobufMessage bounds;
        bounds.real(ovf::box::x_min, box_.min.x);
        bounds.real(ovf::box::y_min, box_.min.y);
        bounds.real(ovf::box::x_max, box_.max.x);
        bounds.real(ovf::box::y_max, box_.max.y);
        ProtobufMessage meta_data;
        meta_data.message(ovf::job::meta::bounds, bounds);
        ProtobufMessage job;
        job.message(ovf::job::meta_data, meta_data);
        keys_.put(job, layer_thickness_);
        job.integer(ovf::job::work_plane_count, static_cast<std::int64_t>(planes_.size()));

        ProtobufMessage table;
        table.integer(ovf::table::shell, static_cast<std::int64_t>(file_.bytes()));
        table.integers(ovf::table::positions, planes_);
        file_.append(job.delimited());
        const std::uint64_t table_place = file_.bytes();
        file_.append(table.delimited());
        file_.overwrite(ovf::magic.size(), position_bytes(table_place));
        file_.commit();
    }

    std::uint64_t bytes() const noexcept override { return file_.bytes(); }

    std::vector<std::string> warnings() const override {
        std::vector<std::string> lines = left_out_.warnings();
        say_unexposed(parts_, lines);
        return lines;
    }

  private:
    void check_top(double top, std::uint64_t index) {
        const auto single = static_cast<float>(top);
        if (!(single > last_top_))
            throw Error(
                ErrorKind::usage,
                fmt::format("layer {} is so thin that its top, z = {} mm, is that of the layer before "
                            "in single precision",
                            index, top));
        last_top_ = single;
    }

    /// In front of a plane stands where its table lies.
    void append_plane(const Blocks& blocks, double top) {
        const std::uint64_t begin = file_.bytes();
        ProtobufMessage shell;
        shell.real(ovf::work_plane::z, top);
        shell.integer(ovf::work_plane::block_count, static_cast<std::int64_t>(blocks.begins.size()));
        shell.integer(ovf::work_plane::number, static_cast<std::int64_t>(planes_.size()));
        const std::string shell_bytes = shell.delimited();
        planes_.push_back(begin);

        const std::uint64_t shell_place = begin + position_size + blocks.bytes->view().size();
        const std::uint64_t table_place = shell_place + shell_bytes.size();
        std::vector<std::uint64_t> places = blocks.begins;
        for (std::uint64_t& place : places)
            place += begin + position_size;
        ProtobufMessage table;
        table.integer(ovf::table::shell, static_cast<std::int64_t>(shell_place));
        table.integers(ovf::table::positions, places);

        file_.append(position_bytes(table_place));
        file_.append(blocks.bytes->view());
        file_.append(shell_bytes);
        file_.append(table.delimited());
    }

    Box3 box_;
    std::vector<PartInfo> parts_;
    Keys keys_;
    AtomicFile file_;
    LayerOrder order_;
    LeftOut left_out_;
    FloatContours floats_;
    std::shared_ptr<BufferPool> buffers_ = std::make_shared<BufferPool>();
    std::vector<std::uint64_t> planes_; ///< where they begin
    float last_top_ = -std::numeric_limits<float>::infinity();
    double layer_thickness_ = 0;
};

} // namespace

std::unique_ptr<LayerWriter> open_ovf(const std::string& path, const LayerFileInfo& info,
                                      const LayerWriteOptions& /*options*/) {
    return std::make_unique<OvfWriter>(path, info);
}

} // namespace lamella
