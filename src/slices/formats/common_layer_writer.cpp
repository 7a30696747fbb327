#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"

#include "container/byte_buffer.hpp"
#include "container/decimal.hpp"
#include "container/quoted.hpp"
#include "slices/engine/common_layer_format.hpp"
#include "slices/engine/float_contour.hpp"
#include "slices/engine/grid.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/engine/left_out.hpp"
#include "slices/engine/sequential_writer.hpp"
#include "slices/engine/written_heights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

namespace lamella {

namespace {

static_assert(std::endian::native == std::endian::little, "the binary form is written as memory has it");

using Direction = CommonLayerDirection;

constexpr int first_part = 1;

constexpr Holds common_layer_holds{
    .hatches = true, .gaps = false, .written_label = common_layer_label, .labels_mark_vectors = true};

// Returns the header in the order that the strictest readers require. It has no date, so that equal layers
// give equal bytes.
std::string header(std::string_view coding, const LayerFileInfo& info, double units) {
    std::string text = "$$HEADERSTART\n";
    text += fmt::format("$${}\n", coding);
    text += fmt::format("$$UNITS/{}\n", exact_decimal_text(units));
    text += "$$VERSION/200\n";
    for (std::size_t i = 0; i < info.parts.size(); ++i)
        text += fmt::format("$$LABEL/{},\"{}\"\n", first_part + i,
                            label_in_file(info.parts[i], common_layer_holds));
    text += "$$DIMENSION/";
    const Box3& box = info.box;
    for (const double v : {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z})
        text += decimal_text(v, 6, 6) + ',';
    text.back() = '\n';
    // The additional layer is empty and marks the bottom of the first layer.
    text += fmt::format("$$LAYERS/{}\n$$HEADEREND", info.layers + 1);
    return text;
}

// Returns whether a ring turns left at its first point. In normal form this point is the ring's smallest, so
// a ring without self-intersections is an outer one if it turns left there.
bool starts_convex(std::span<const Point2> ring) {
    if (ring.size() < 2)
        return true;
    const Point2& p = ring.front();
    const Point2& before = ring.back();
    const Point2& after = ring[1];
    return (p.x - before.x) * (after.y - p.y) >= (p.y - before.y) * (after.x - p.x);
}

Direction direction_of(double ring_area) {
    return ring_area >= 0 ? Direction::counter_clockwise : Direction::clockwise;
}

// Order in which the contours of a part are written.
enum class Sequence {
    nesting, // outer rings, then holes, then open chains
    kept,    // in the given order, since contours are exposed one after the other
};

// Calls write(contour, closed). Only the first corner of a ring decides whether it is an outer ring, so its
// points are fetched from memory once.
template <class Write>
void for_each_contour(const Layer& layer, Sequence sequence, const Write& write) {
    std::vector<std::size_t> holes;
    for (std::size_t i = 0; i < layer.rings; ++i) {
        if (sequence == Sequence::kept || starts_convex(layer.contour(i)))
            write(layer.contour(i), true);
        else
            holes.push_back(i);
    }
    for (const std::size_t i : holes)
        write(layer.contour(i), true);
    for (std::size_t i = layer.rings; i < layer.contours(); ++i)
        write(layer.contour(i), false);
}

template <class Format>
void for_each_part(const Plane& plane, const Format& format) {
    for (std::size_t i = 0; i < plane.polylines.size(); ++i)
        format(plane.polylines[i], plane.hatches[i].span(), first_part + static_cast<int>(i));
}

// The content of one command, on a grid: a polyline or, without a direction, hatch lines. It is passed by
// value, so that compilers know that writing text does not change it.
struct Listed {
    int part;
    std::uint64_t layer;
    std::span<const GridPoint> points;
    std::optional<Direction> direction;

    // A ring repeats its first point at the end.
    [[nodiscard]] std::size_t size() const {
        return points.size() + (direction && *direction != Direction::open ? 1 : 0);
    }
    [[nodiscard]] const GridPoint& operator[](std::size_t i) const {
        return points[i < points.size() ? i : 0];
    }
    // Count that the command stores: points of a polyline, or hatch lines.
    [[nodiscard]] std::size_t count() const { return direction ? size() : size() / 2; }
};

// Heights are not rounded to the grid of coordinates, because a layer may be thinner than its step.
std::string position_text(double z, double units) {
    return decimal_text(z / units, 6, 1);
}

class CommonLayerWriter : public SequentialWriter {
  protected:
    // `precision` describes the precision of heights; `height_mm` is their unit in mm.
    CommonLayerWriter(const std::string& path, const LayerFileInfo& info, std::string_view header,
                      std::string precision, double height_mm)
        : SequentialWriter(path, info, header, common_layer_holds),
          heights_(std::move(precision), height_mm, rounding_loss()) {
        for (const PartInfo& part : info.parts)
            sequences_.push_back(part.exposure ? Sequence::kept : Sequence::nesting);
    }

    // Returns the height of a layer as it is written, `height_of(mm)`, after checks. For the first layer of a
    // file or range, its bottom is checked, too.
    template <class HeightOf>
    auto checked_height(const PlanePosition& offset, const HeightOf& height_of) {
        const auto height = height_of(offset.top);
        if (heights_.empty())
            heights_.add(static_cast<double>(height_of(offset.bottom)), offset.bottom, "bottom",
                         offset.index);
        heights_.add(static_cast<double>(height), offset.top, "top", offset.index);
        return height;
    }

    [[nodiscard]] Sequence sequence_of(int part) const {
        return sequences_[static_cast<std::size_t>(part - first_part)];
    }

    // Calls put(listed) for each contour of each part that does not vanish on the grid, and for the hatch
    // lines of each part.
    template <class Put>
    void for_each_on_grid(const WriterGrid& grid, const Plane& plane, const Put& put) const {
        std::vector<GridPoint> scratch;
        for_each_part(plane, [&](const Layer& layer, std::span<const Point2> hatches, int part) {
            for_each_contour(layer, sequence_of(part), [&](std::span<const Point2> contour, bool closed) {
                const double area = closed ? ring_area(contour) : 0;
                const auto points = grid.snap(contour, closed, area, layer.index, scratch);
                if (!points.empty())
                    put(Listed{part, layer.index, points, closed ? direction_of(area) : Direction::open});
            });
            if (!hatches.empty()) {
                const std::vector<GridPoint> ends = grid.snap_lines(hatches, layer.index);
                if (!ends.empty())
                    put(Listed{part, layer.index, ends, {}});
            }
        });
    }

  private:
    std::vector<Sequence> sequences_;
    WrittenHeights heights_;
};

class AsciiWriter final : public CommonLayerWriter {
  public:
    AsciiWriter(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options)
        : CommonLayerWriter(path, info,
                            header("ASCII", info, options.units_mm) + "\n$$GEOMETRYSTART\n$$LAYER/" +
                                position_text(info.bottom, options.units_mm) + '\n',
                            fmt::format("millionths of a unit of {} mm", options.units_mm),
                            1e-6 * options.units_mm),
          units_(options.units_mm), grid_(options.units_mm, &rounding_loss()) {}

  private:
    std::string layer_header(const PlanePosition& offset) override {
        static_cast<void>(
            checked_height(offset, [this](double mm) { return std::nearbyint(mm / units_ * 1e6); }));
        return fmt::format("$$LAYER/{}\n", position_text(offset.top, units_));
    }

    void format(const Plane& plane, ByteBuffer& out) const override {
        for_each_on_grid(grid_, plane, [&](const Listed& listed) { put_command(listed, out); });
    }

    std::string tail() override { return "$$GEOMETRYEND\n"; }

    static void put_command(Listed listed, ByteBuffer& out) {
        // Length of a comma or a line end, a sign, digits and ".0".
        constexpr std::size_t per_number = most_integer_digits + 4;
        constexpr std::string_view command = "$$POLYLINE/";
        char* at = out.room(command.size() + (listed.size() + 2) * 2 * per_number);
        at = put_text(at, listed.direction ? command : "$$HATCHES/");
        at = put_integer(at, static_cast<std::uint64_t>(listed.part));
        if (listed.direction)
            at = put_integer(put_text(at, ","), static_cast<std::uint64_t>(*listed.direction));
        at = put_integer(put_text(at, ","), std::uint64_t{listed.count()});
        for (std::size_t i = 0, n = listed.size(); i < n; ++i)
            at = put_point(at, listed[i]);
        out.end_at(put_text(at, "\n"));
    }

    // Writes numbers with a decimal point, which marks them as real.
    static char* put_point(char* at, const GridPoint& p) {
        *at = ',';
        at = put_integer(at + 1, p.x);
        at = put_integer(std::copy_n(".0,", 3, at), p.y);
        return std::copy_n(".0", 2, at);
    }

    double units_;
    WriterGrid grid_;
};

// Writes the header of a polyline or, without a direction, of hatch lines.
template <class Number>
char* put_header(char* out, CommonLayerCommand command, int part, std::optional<Direction> direction,
                 std::size_t count) {
    out = put_value(put_value(out, command), static_cast<Number>(part));
    if (direction)
        out = put_value(out, static_cast<Number>(*direction));
    return put_value(out, static_cast<Number>(count));
}

constexpr std::size_t long_header = 14;
constexpr std::size_t hatches_header = 10;

char* put_long_header(char* out, int part, std::optional<Direction> direction, std::size_t count,
                      std::uint64_t layer) {
    if (count > std::size_t{std::numeric_limits<std::int32_t>::max()})
        throw Error(ErrorKind::limit, fmt::format("layer {} has {}; the format ends at 2^31 - 1", layer,
                                                  direction ? fmt::format("a contour of {} points", count)
                                                            : fmt::format("{} hatch lines", count)));
    const auto command = direction ? CommonLayerCommand::polyline_long : CommonLayerCommand::hatches_long;
    return put_header<std::int32_t>(out, command, part, direction, count);
}

class LongWriter final : public CommonLayerWriter {
  public:
    LongWriter(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options)
        : CommonLayerWriter(path, info,
                            header("BINARY", info, options.units_mm) +
                                layer_start(height_of(info.bottom, options.units_mm)),
                            "single precision", options.units_mm),
          units_(options.units_mm), floats_(1 / options.units_mm, &rounding_loss()) {}

  private:
    static float height_of(double z, double units) { return static_cast<float>(z / units) + 0.0F; }

    static std::string layer_start(float height) {
        return bytes_of(CommonLayerCommand::layer_long) + bytes_of(height);
    }

    std::string layer_header(const PlanePosition& offset) override {
        return layer_start(checked_height(offset, [this](double mm) { return height_of(mm, units_); }));
    }

    void format(const Plane& plane, ByteBuffer& out) const override {
        for_each_part(plane, [&](const Layer& layer, std::span<const Point2> hatches, int part) {
            // Reserves the space for all points at once, since most layers lose none.
            static_cast<void>(out.room(layer.contours() * (long_header + float_point_size) +
                                       layer.points.size() * float_point_size));
            for_each_contour(layer, sequence_of(part), [&](std::span<const Point2> contour, bool closed) {
                put_polyline(part, contour, closed, layer.index, out);
            });
            put_hatches(part, hatches, layer.index, out);
        });
    }

    void put_hatches(int part, std::span<const Point2> hatches, std::uint64_t layer, ByteBuffer& out) const {
        if (hatches.empty())
            return;
        char* const header = out.room(hatches_header + hatches.size() * float_point_size);
        char* const points = header + hatches_header;
        const std::size_t listed = floats_.put_lines(hatches, layer, points);
        if (listed == 0)
            return;
        put_long_header(header, part, {}, listed / 2, layer);
        out.end_at(points + listed * float_point_size);
    }

    void put_polyline(int part, std::span<const Point2> contour, bool closed, std::uint64_t layer,
                      ByteBuffer& out) const {
        char* const header = out.room(long_header + (contour.size() + 1) * float_point_size);
        const FloatContour listed = floats_.put(contour, closed, layer, header + long_header);
        if (listed.points == 0)
            return;
        put_long_header(header, part, closed ? direction_of(listed.area_mm2) : Direction::open, listed.points,
                        layer);
        out.end_at(header + long_header + listed.points * float_point_size);
    }

    double units_;
    FloatContours floats_;
};

// 16-bit numbers are unsigned by the standard and signed in some readers and writers. Only numbers that mean
// the same in both are written.
constexpr std::int64_t most_short = 32767;

// A command whose number of points, hatches or part exceeds 16 bits is written in the long form. A file may
// contain both forms.
constexpr std::size_t most_counted = std::numeric_limits<std::uint16_t>::max();

class ShortWriter final : public CommonLayerWriter {
  public:
    ShortWriter(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options)
        : CommonLayerWriter(
              path, info, checked_header(info, options.units_mm),
              fmt::format("units of {} mm; use smaller ones or the long form", options.units_mm),
              options.units_mm),
          units_(options.units_mm), grid_(options.units_mm, &rounding_loss()) {}

  private:
    // Checks the coordinates, so that an error is reported before an hour of slicing.
    static std::string checked_header(const LayerFileInfo& info, double units) {
        const double farthest = std::max({info.box.max.x, info.box.max.y, info.box.max.z});
        const auto check = [&](const char* axis, double mm) {
            check_short("the part", axis, whole_units(mm, units), units, farthest);
        };
        check("x", info.box.min.x);
        check("x", info.box.max.x);
        check("y", info.box.min.y);
        check("y", info.box.max.y);
        check("z", info.bottom);
        check("z", info.box.max.z);
        return header("BINARY", info, units) + layer_start(whole_units(info.bottom, units));
    }

    /// Throws unless `value` fits. `farthest` is the largest coordinate that must fit, too, in mm; the error
    /// suggests units for both.
    static void check_short(const std::string& what, const char* axis, std::int64_t value, double units,
                            double farthest = 0) {
        if (value >= 0 && value <= most_short)
            return;
        const double mm = static_cast<double>(value) * units;
        if (value < 0)
            throw Error(
                ErrorKind::usage,
                fmt::format("{} reaches {} = {:.6g} mm, but the short form has no negative numbers; move "
                            "the part to positive coordinates or use the long form",
                            what, axis, mm));
        // Because of the factor, 0.002 does not count as larger than 2 * 0.001.
        const double needed = std::max(mm, farthest) / most_short * (1 - 1e-9);
        throw Error(
            ErrorKind::usage,
            fmt::format("{} reaches {} = {:.6g} mm, which is {} units of {} mm, but the short form ends at "
                        "{}; use units of {:g} mm or the long form",
                        what, axis, mm, value, units, most_short, round_step(needed)));
    }

    static std::int64_t whole_units(double mm, double units) {
        const double value = std::nearbyint(mm / units);
        constexpr double most = 1e15;
        return static_cast<std::int64_t>(std::clamp(value, -most, most));
    }

    static std::string layer_start(std::int64_t height) {
        return bytes_of(CommonLayerCommand::layer_short) + bytes_of(static_cast<std::uint16_t>(height));
    }

    std::string layer_header(const PlanePosition& offset) override {
        const std::int64_t height =
            checked_height(offset, [this](double mm) { return whole_units(mm, units_); });
        check_short(fmt::format("layer {}", offset.index), "z", height, units_);
        return layer_start(height);
    }

    void format(const Plane& plane, ByteBuffer& out) const override {
        for_each_on_grid(grid_, plane, [&](const Listed& listed) { put_command(listed, out); });
    }

    void check_short(std::span<const GridPoint> points, std::uint64_t layer) const {
        for (const GridPoint& p : points) {
            if (((p.x | p.y) & ~most_short) != 0) {
                const std::string what = fmt::format("layer {}", layer);
                check_short(what, "x", p.x, units_);
                check_short(what, "y", p.y, units_);
            }
        }
    }

    static char* put_short(char* at, const GridPoint& p) {
        return put_value(put_value(at, static_cast<std::uint16_t>(p.x)), static_cast<std::uint16_t>(p.y));
    }

    static char* put_long(char* at, const GridPoint& p) {
        return put_value(put_value(at, static_cast<float>(p.x)), static_cast<float>(p.y));
    }

    void put_command(Listed listed, ByteBuffer& out) const {
        const auto [part, layer, points, direction] = listed;
        check_short(points, layer);
        const std::size_t count = listed.count();
        char* at = out.room(long_header + listed.size() * float_point_size);
        const bool counted = count <= most_counted && static_cast<std::size_t>(part) <= most_counted;
        if (counted)
            at = put_header<std::uint16_t>(
                at, direction ? CommonLayerCommand::polyline_short : CommonLayerCommand::hatches_short, part,
                direction, count);
        else
            at = put_long_header(at, part, direction, count, layer);
        for (std::size_t i = 0, n = listed.size(); i < n; ++i)
            at = counted ? put_short(at, listed[i]) : put_long(at, listed[i]);
        out.end_at(at);
    }

    double units_;
    WriterGrid grid_;
};

} // namespace

std::unique_ptr<LayerWriter> open_common_layer_ascii(const std::string& path, const LayerFileInfo& info,
                                                     const LayerWriteOptions& options) {
    check_units(options.units_mm);
    return std::make_unique<AsciiWriter>(path, info, options);
}

std::unique_ptr<LayerWriter> open_common_layer_binary(const std::string& path, const LayerFileInfo& info,
                                                      const LayerWriteOptions& options) {
    check_units(options.units_mm);
    if (options.short_form)
        return std::make_unique<ShortWriter>(path, info, options);
    return std::make_unique<LongWriter>(path, info, options);
}

} // namespace lamella
