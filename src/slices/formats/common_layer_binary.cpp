#include "lamella/core/error.hpp"

#include "core/executor.hpp"
#include "slices/engine/common_layer_format.hpp"
#include "slices/formats/common_layer_geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

namespace lamella {

namespace {

static_assert(std::endian::native == std::endian::little, "binary numbers are read as memory has them");

/// A cursor over the binary geometry.
class Bytes {
  public:
    Bytes(std::string_view bytes, std::size_t at, bool aligned, const std::string& name)
        : bytes_(bytes), at_(at), aligned_(aligned), name_(name) {}

    [[nodiscard]] std::size_t at() const { return at_; }
    [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
    [[nodiscard]] const char* data() const { return bytes_.data() + at_; }

    /// Returns whether only padding is left: some writers append a line end or zeros.
    [[nodiscard]] bool only_padding_left() const {
        return std::all_of(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), bytes_.end(),
                           [](char c) { return c == '\n' || c == '\r' || c == '\0'; });
    }

    template <class T>
    T take(const char* what) {
        T value;
        if (left() < sizeof value)
            fail(at_, fmt::format("the end of the file within {}", what), "the file is truncated");
        std::memcpy(&value, data(), sizeof value);
        at_ += sizeof value;
        if (aligned_ && sizeof value == 2)
            at_ = std::min(at_ + 2, bytes_.size()); // every 16-bit number fills a 32-bit word
        return value;
    }

    /// Returns `count` records of `size` bytes and moves after them. Fails if they exceed the file.
    const char* take_records(std::int64_t count, std::size_t size, const char* what) {
        if (count < 0 || static_cast<std::uint64_t>(count) > left() / size)
            fail(at_, fmt::format("a count of {} {}", count, what),
                 fmt::format("{} bytes are left in the file, room for {}", left(), left() / size));
        const char* first = data();
        at_ += static_cast<std::size_t>(count) * size;
        return first;
    }

    [[noreturn]] void fail(std::size_t at, const std::string& found, const std::string& expected) const {
        throw Error(ErrorKind::input, fmt::format("{}, byte {}: found {}; {}", name_, at, found, expected));
    }

  private:
    std::string_view bytes_;
    std::size_t at_;
    bool aligned_;
    const std::string& name_;
};

bool is_layer(std::string_view bytes) {
    std::uint16_t command = 0;
    std::memcpy(&command, bytes.data(), std::min(bytes.size(), sizeof command));
    return command == static_cast<std::uint16_t>(CommonLayerCommand::layer_long) ||
           command == static_cast<std::uint16_t>(CommonLayerCommand::layer_short);
}

} // namespace

PieceBegins binary_pieces(std::string_view bytes, const CommonLayerHeader& header) {
    std::size_t begin = header.aligned ? (header.end + 3) / 4 * 4 : header.end;
    // Some writers end the header with a line end, with which no command begins.
    if (!header.aligned) {
        const std::string_view rest = bytes.substr(begin);
        if (rest.starts_with("\r\n"))
            begin += 2;
        else if (rest.starts_with("\n"))
            begin += 1;
    }
    begin = std::min(begin, bytes.size());
    PieceBegins begins{begin}; // the others are at layers, up to the first command that is not sound
    for (std::size_t at = begin; at < bytes.size();) {
        const std::optional<std::uint64_t> size = common_layer_command_size(bytes.substr(at), header.aligned);
        if (!size)
            break;
        if (is_layer(bytes.substr(at)))
            add_piece(begins, at);
        at += *size;
    }
    return begins;
}

CommonLayerGeometry read_binary_piece(std::string_view bytes, const std::string& name,
                                      const CommonLayerHeader& header, std::size_t begin, std::size_t limit,
                                      const Reading& reading) {
    CommonLayerGeometry geometry(header, name, reading.limits);
    Bytes in(bytes, begin, header.aligned, name);
    // The standard specifies unsigned 16-bit numbers, but some exports have signed ones. Only the box in the
    // header distinguishes the two: if it has no negative coordinate, they are unsigned.
    const auto reaches_below = [&](std::size_t axis) {
        return header.dimension && (*header.dimension)[axis] < 0;
    };
    const bool signed_heights = reaches_below(2);
    const bool signed_points = reaches_below(0) || reaches_below(1);
    const auto number = [](std::uint16_t bits, bool has_sign) {
        return has_sign ? static_cast<double>(static_cast<std::int16_t>(bits)) : static_cast<double>(bits);
    };
    const auto short_number = [&](const char* from) {
        std::uint16_t bits = 0;
        std::memcpy(&bits, from, sizeof bits);
        return number(bits, signed_points);
    };
    ReadPosition position(reading, begin);
    while (in.left() > 0 && !in.only_padding_left()) {
        const std::size_t at = in.at();
        if (at >= limit && is_layer(bytes.substr(at)))
            break;
        position.reached(at);
        const auto command = static_cast<CommonLayerCommand>(in.take<std::uint16_t>("a command"));
        const auto offset = at_byte(at);
        switch (command) {
        case CommonLayerCommand::layer_long: {
            const auto height = in.take<float>("a layer");
            if (!std::isfinite(height))
                in.fail(at, "a height that is not finite", "it must be a number");
            geometry.start_layer(at, static_cast<double>(height), offset());
            break;
        }
        case CommonLayerCommand::layer_short:
            geometry.start_layer(at, number(in.take<std::uint16_t>("a layer"), signed_heights), offset());
            break;
        case CommonLayerCommand::polyline_short:
        case CommonLayerCommand::polyline_long:
        case CommonLayerCommand::hatches_short:
        case CommonLayerCommand::hatches_long: {
            if (!geometry.in_layer())
                in.fail(at, "geometry before the first layer", "contours belong to a layer");
            const bool is_long =
                command == CommonLayerCommand::polyline_long || command == CommonLayerCommand::hatches_long;
            const bool hatches =
                command == CommonLayerCommand::hatches_short || command == CommonLayerCommand::hatches_long;
            const auto parameter = [&]() -> std::int64_t {
                const char* const what = hatches ? "hatches" : "a polyline";
                return is_long ? std::int64_t{in.take<std::int32_t>(what)}
                               : std::int64_t{in.take<std::uint16_t>(what)};
            };
            const std::int64_t part = parameter();
            const std::int64_t stated = hatches ? 0 : parameter();
            const auto direction = common_layer_direction(stated);
            if (!direction)
                in.fail(at, fmt::format("a polyline of direction {}", stated), common_layer_directions);
            const std::int64_t count = parameter();
            const std::int64_t points_each = hatches ? 2 : 1;
            const std::size_t size = is_long ? 8 : 4;
            const char* from = in.take_records(count, points_each * size, hatches ? "hatches" : "points");
            const auto number_of_points = static_cast<std::uint64_t>(points_each * count);
            std::vector<Point2>& points = geometry.expect_points(hatches, number_of_points, offset);
            for (std::uint64_t i = 0; i < number_of_points; ++i, from += size) {
                if (!is_long) {
                    geometry.add_point(points, short_number(from), short_number(from + 2));
                    continue;
                }
                std::array<float, 2> p{};
                std::memcpy(p.data(), from, sizeof p);
                if (!std::isfinite(p[0]) || !std::isfinite(p[1]))
                    in.fail(at, "a point that is not finite", "coordinates must be numbers");
                geometry.add_point(points, static_cast<double>(p[0]), static_cast<double>(p[1]));
            }
            if (hatches)
                geometry.end_hatches(part, offset);
            else
                geometry.end_polyline(part, *direction, offset);
            break;
        }
        default:
            in.fail(at, fmt::format("command {}", static_cast<unsigned>(command)),
                    "the commands are 127 to 132: layers, polylines and hatches");
        }
    }
    geometry.end = in.at();
    position.end(geometry.end);
    return geometry;
}

} // namespace lamella
