#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "slices/formats/common_layer_geometry.hpp"
#include "slices/formats/common_layer_text.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// Returns an integer parameter such as a direction; it may be written with a decimal point.
std::int64_t integer(CommonLayerText& text, const char* what) {
    const double value = text.number(what);
    if (value != std::floor(value) || std::abs(value) > 9e15)
        text.fail(fmt::format("{}", value), fmt::format("{} must be a whole number", what));
    return static_cast<std::int64_t>(value);
}

/// Takes the number of a non-standard command, such as "/100.0". Returns none if anything else follows.
std::optional<double> take_only_number(CommonLayerText& text) {
    double number = 0;
    if (!text.take("/") || !text.take_number(number))
        return std::nullopt;
    const bool ends = text.done() || is_line_end(text.rest()[0]) || text.rest().starts_with("//") ||
                      text.rest().starts_with("$$");
    return ends ? std::optional(number) : std::nullopt;
}

CommonLayerDirection take_direction(CommonLayerText& text) {
    const std::int64_t stated = integer(text, "the direction");
    const auto known = common_layer_direction(stated);
    if (!known)
        text.fail(fmt::format("direction {}", stated), common_layer_directions);
    return *known;
}

} // namespace

TextPieces ascii_pieces(std::string_view bytes, const std::string& name, const CommonLayerHeader& header,
                        Executor& executor) {
    CommonLayerText text(bytes, header.end, name);
    text.skip_blanks();
    if (!text.take("$$GEOMETRYSTART"))
        text.fail(text.done() ? "the end of the file"
                              : fmt::format("'{}'", printable(text.rest().substr(0, 20), 40)),
                  "$$GEOMETRYSTART must follow the header");
    return find_text_pieces(bytes, text.at(), "$$LAYER", executor);
}

CommonLayerGeometry read_ascii_piece(std::string_view bytes, const std::string& name,
                                     const CommonLayerHeader& header, std::size_t begin, std::size_t limit,
                                     std::uint64_t line, const Reading& reading) {
    CommonLayerGeometry geometry(header, name, reading.limits);
    CommonLayerText text(bytes, begin, name);
    ReadPosition position(reading, begin);
    std::size_t layer_at = begin; // offset of the last layer
    std::uint64_t layer_line = line;
    const auto line_of_command = [&](std::size_t command_at) {
        return layer_line + line_at(bytes.substr(layer_at), command_at - layer_at) - 1;
    };
    geometry.end = bytes.size();
    for (;;) {
        text.skip_blanks();
        if (text.done())
            text.fail("the end of the file", "the geometry must end with $$GEOMETRYEND");
        position.reached(text.at());
        if (!text.take("$$"))
            text.fail(fmt::format("'{}'", printable(text.rest().substr(0, 20), 40)),
                      "a command must start with $$");
        const std::size_t command_at = text.at() - 2;
        const std::string_view command = text.take_command();
        if (command == "GEOMETRYEND")
            break;
        if (command == "LAYER") {
            if (command_at >= limit) {
                geometry.end = command_at;
                break;
            }
            text.expect('/', "the layer's height");
            const double z = text.number("the layer's height");
            layer_line = line_of_command(command_at);
            layer_at = command_at;
            geometry.start_layer(command_at, z, fmt::format("line {}", layer_line));
        } else if (command == "POLYLINE" || command == "HATCHES") {
            if (!geometry.in_layer())
                text.fail(fmt::format("$${} before the first $$LAYER", command),
                          "contours belong to a layer");
            text.expect('/', "the part's number");
            const std::int64_t part = integer(text, "the part's number");
            text.expect(',', "the next parameter");
            const bool hatches = command == "HATCHES";
            CommonLayerDirection direction{};
            if (!hatches) {
                direction = take_direction(text);
                text.expect(',', "the number of points");
            }
            const std::int64_t count =
                integer(text, hatches ? "the number of hatches" : "the number of points");
            const std::int64_t points_each = hatches ? 2 : 1;
            // Each number takes at least two characters.
            if (count < 0 || count > static_cast<std::int64_t>(text.rest().size()) / (4 * points_each) + 1)
                text.fail(fmt::format("a count of {}", count),
                          fmt::format("{} bytes are left in the file", text.rest().size()));
            const auto location = [&] {
                return fmt::format("line {}", line_of_command(command_at));
            };
            const auto number_of_points = static_cast<std::uint64_t>(points_each * count);
            std::vector<Point2>& points = geometry.expect_points(hatches, number_of_points, location);
            for (std::uint64_t i = 0; i < number_of_points; ++i) {
                position.reached(text.at());
                std::array<double, 2> p{};
                for (double& value : p) {
                    text.expect(',', "the next coordinate");
                    value = text.number("a coordinate");
                }
                geometry.add_point(points, p[0], p[1]);
            }
            text.skip_blanks();
            if (!text.done() && !text.rest().starts_with("$$"))
                text.fail(fmt::format("'{}'", printable(text.rest().substr(0, 12), 24)),
                          fmt::format("the count of {} says that the coordinates end here", count));
            if (hatches)
                geometry.end_hatches(part, location);
            else
                geometry.end_polyline(part, direction, location);
        } else {
            // Extensions such as $$POWER/100.0 occur between polylines.
            const auto location = [&] {
                return fmt::format("line {}", line_of_command(command_at));
            };
            geometry.take_setting(command, take_only_number(text), location);
            text.skip_to_command();
        }
    }
    position.end(geometry.end);
    return geometry;
}

} // namespace lamella
