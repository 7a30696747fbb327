#include "read/common_layer.hpp"

#include "lamella/core/error.hpp"

#include "container/text_place.hpp"
#include "core/executor.hpp"
#include "read/layer_assembly.hpp"
#include "read/read_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>

namespace lamella {

namespace {

static_assert(std::endian::native == std::endian::little, "binary numbers are read as memory has them");

constexpr std::string_view header_start = "$$HEADERSTART";
constexpr std::string_view header_end = "$$HEADEREND";
constexpr std::size_t longest_preface = 1U << 16; // comments before the header

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/// What the header says.
struct Header {
    bool binary = false;
    double units_mm = 0;
    bool aligned = false;
    std::map<std::int64_t, std::string> labels;     ///< of the parts, by their numbers
    std::optional<std::array<double, 6>> dimension; ///< mm
    std::optional<std::uint64_t> layers;
    std::size_t end = 0; ///< the byte behind $$HEADEREND
};

/// A cursor over text that reports places by line.
class Text {
  public:
    Text(std::string_view text, std::size_t at, const std::string& name)
        : text_(text), at_(at), name_(name) {}

    [[nodiscard]] bool done() const { return at_ >= text_.size(); }
    [[nodiscard]] std::size_t at() const { return at_; }
    void move_to(std::size_t at) { at_ = at; }
    [[nodiscard]] std::string_view rest() const { return text_.substr(at_); }

    /// Blanks and // comments //.
    void skip_blanks() {
        while (!done()) {
            if (is_blank(text_[at_])) {
                ++at_;
            } else if (rest().starts_with("//")) {
                const std::size_t close = text_.find("//", at_ + 2);
                if (close == std::string_view::npos)
                    fail("a comment that does not end", "it must close with //");
                at_ = close + 2;
            } else {
                return;
            }
        }
    }

    bool take(std::string_view token) {
        if (!rest().starts_with(token))
            return false;
        at_ += token.size();
        return true;
    }

    /// The letters of a command after $$, with "$$" taken.
    std::string_view take_command() {
        const std::size_t begin = at_;
        while (!done() &&
               ((text_[at_] >= 'A' && text_[at_] <= 'Z') || (text_[at_] >= 'a' && text_[at_] <= 'z')))
            ++at_;
        return text_.substr(begin, at_ - begin);
    }

    double number(const char* what) {
        skip_blanks();
        const std::size_t begin = at_;
        const char* from = text_.data() + at_;
        const char* const end = text_.data() + text_.size();
        if (from != end && *from == '+')
            ++from;
        double value = 0;
        const auto [to, error] = std::from_chars(from, end, value, std::chars_format::general);
        if (error != std::errc() || !std::isfinite(value)) {
            at_ = begin;
            fail(fmt::format("'{}'", printable(rest().substr(0, rest().find_first_of(", \t\r\n")), 40)),
                 fmt::format("{} must be a number", what));
        }
        at_ = static_cast<std::size_t>(to - text_.data());
        return value;
    }

    void expect(char separator, const char* what) {
        skip_blanks();
        if (done() || text_[at_] != separator)
            fail(done() ? "the end of the file" : fmt::format("'{}'", printable(rest().substr(0, 1), 8)),
                 fmt::format("'{}' must stand before {}", separator, what));
        ++at_;
    }

    [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
        throw Error(ErrorKind::input,
                    fmt::format("{}, line {}: found {}; {}", name_, line_at(text_, at_), found, expected));
    }

  private:
    std::string_view text_;
    std::size_t at_;
    const std::string& name_;
};

std::string_view unquoted(std::string_view text) {
    while (!text.empty() && is_blank(text.back()))
        text.remove_suffix(1);
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
        text = text.substr(1, text.size() - 2);
    return text;
}

/// The part's number in "/1,name".
std::optional<std::int64_t> label_number(std::string_view line) {
    if (!line.starts_with('/'))
        return std::nullopt;
    line.remove_prefix(1);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
    return error == std::errc() ? std::optional(number) : std::nullopt;
}

Header read_header(std::string_view bytes, const std::string& name) {
    Header header;
    Text text(bytes, bytes.find(header_start) + header_start.size(), name);
    bool ascii = false;
    bool has_units = false;
    for (;;) {
        text.skip_blanks();
        if (text.done())
            text.fail("the end of the file", "the header must end with $$HEADEREND");
        if (text.take(header_end))
            break;
        const std::size_t line_end = std::min(bytes.find_first_of("\r\n", text.at()), bytes.size());
        if (!text.take("$$")) {
            text.move_to(line_end); // the standard lets other characters be ignored
            continue;
        }
        const std::string_view command = text.take_command();
        if (command == "BINARY") {
            header.binary = true;
        } else if (command == "ASCII") {
            ascii = true;
        } else if (command == "ALIGN") {
            header.aligned = true;
        } else if (command == "UNITS") {
            text.expect('/', "the units");
            header.units_mm = text.number("the units");
            has_units = true;
            if (!(header.units_mm > 0))
                text.fail(fmt::format("units of {} mm", header.units_mm), "they must be above 0");
        } else if (command == "DIMENSION") {
            text.expect('/', "the dimensions");
            std::array<double, 6> box{};
            for (std::size_t i = 0; i < box.size(); ++i) {
                if (i > 0)
                    text.expect(',', "the next dimension");
                box[i] = text.number("a dimension");
            }
            header.dimension = box;
        } else if (command == "LAYERS") {
            text.expect('/', "the number of layers");
            const double count = text.number("the number of layers");
            if (count >= 0 && count < 1e15)
                header.layers = static_cast<std::uint64_t>(count);
        } else if (command == "LABEL") {
            const std::string_view line = bytes.substr(text.at(), line_end - text.at());
            const std::size_t comma = line.find(',');
            if (const auto part = label_number(line); part && comma != std::string_view::npos)
                header.labels.try_emplace(*part, unquoted(line.substr(comma + 1)));
            text.move_to(line_end);
        } else if (command == "USERDATA") {
            // $$USERDATA/uid,length,bytes: the bytes may hold anything.
            const std::size_t first = bytes.find(',', text.at());
            if (first == std::string_view::npos)
                text.fail("user data without a length", "it must read $$USERDATA/uid,length,data");
            text.move_to(first + 1);
            const double length = text.number("the length of the user data");
            text.expect(',', "the user data");
            if (!(length >= 0 && length <= static_cast<double>(bytes.size() - text.at())))
                text.fail(fmt::format("user data of {} bytes", length),
                          fmt::format("{} bytes are left in the file", bytes.size() - text.at()));
            text.move_to(text.at() + static_cast<std::size_t>(length));
        } else {
            text.move_to(line_end); // VERSION, DATE and whatever else: nothing depends on it
        }
    }
    header.end = text.at();
    if (header.binary == ascii)
        text.fail(header.binary ? "both $$BINARY and $$ASCII" : "neither $$BINARY nor $$ASCII",
                  "the header must have one of them");
    if (!has_units)
        text.fail("no $$UNITS", "the header must say how many millimetres a unit is");
    return header;
}

/// Collects what the geometry section says, however it is coded.
class Collector {
  public:
    Collector(const Header& header, const std::string& name, ReadLimits& limits)
        : units_(header.units_mm), name_(name), limits_(limits) {
        for (const auto& [number, label] : header.labels)
            part_slot(number, [] { return std::string_view("the header"); });
    }

    void start_layer(double units, std::string place) {
        const double z = in_mm(units, place);
        limits_.make_room(layers_, 1, [&] { return std::string_view(place); });
        layers_.emplace_back();
        layers_.back().z = z;
        layers_.back().place = std::move(place);
    }
    [[nodiscard]] bool in_layer() const { return !layers_.empty(); }
    /// Before points of a polyline, or ends of hatches.
    template <class Place>
    void expect_points(std::uint64_t count, const Place& place) {
        limits_.make_room(layers_.back().points, count, place);
    }
    template <class Place>
    void expect_hatch_points(std::uint64_t count, const Place& place) {
        limits_.make_room(layers_.back().hatches, count, place);
    }
    void add_point(double x, double y) {
        RawLayer& layer = layers_.back();
        layer.points.push_back({in_mm(x, layer.place) + 0.0, in_mm(y, layer.place) + 0.0});
    }
    void add_hatch_point(double x, double y) {
        RawLayer& layer = layers_.back();
        layer.hatches.push_back({in_mm(x, layer.place), in_mm(y, layer.place)});
    }
    template <class Place>
    void end_hatches(std::int64_t part, const Place& place) {
        limits_.make_room(layers_.back().hatch_ends, 1, place);
        layers_.back().end_hatches(part_slot(part, place));
    }

    /// Ends a polyline of the direction given: 0 clockwise, 1 counter-clockwise, 2 open.
    template <class Place>
    void end_polyline(std::int64_t part, int direction, const Place& place) {
        RawLayer& layer = layers_.back();
        const std::size_t begin = layer.ends.empty() ? 0 : layer.ends.back().end;
        const bool closed = direction != 2;
        const bool returns = layer.points.size() > begin && layer.points.back() == layer.points[begin];
        limits_.make_room(layer.ends, 1, place);
        if (!layer.end_clean_contour(begin, closed, part_slot(part, place))) {
            dropped_.note(place);
            return;
        }
        if (!closed)
            return;
        if (!returns)
            unclosed_.note(place);
        // Where the points run the other way, the stated direction holds.
        const double area = twice_area(layer, begin);
        if (direction == 1 ? area < 0 : area > 0) {
            std::reverse(layer.points.begin() + static_cast<std::ptrdiff_t>(begin), layer.points.end());
            turned_.note(place);
        }
    }

    /// Puts the parts into `file` in the order of their numbers.
    void number_parts(const Header& header, LayerFile& file) {
        if (slots_.empty())
            part_slot(1, [] { return std::string_view("the end"); });
        std::vector<std::uint32_t> places(slots_.size());
        for (const auto& [number, slot] : slots_) {
            places[slot] = static_cast<std::uint32_t>(file.parts.size());
            const auto label = header.labels.find(number);
            file.parts.push_back({label == header.labels.end() ? std::string() : label->second, {}});
        }
        for (RawLayer& layer : layers_) {
            for (auto& contour : layer.ends)
                contour.part = places[contour.part];
            for (auto& hatches : layer.hatch_ends)
                hatches.part = places[hatches.part];
        }
    }

    [[nodiscard]] std::vector<RawLayer>& layers() { return layers_; }

    void say(std::vector<std::string>& warnings) const {
        unclosed_.say(warnings);
        turned_.say(warnings);
        dropped_.say(warnings);
    }

  private:
    /// Coordinates beyond the limit could make areas and thicknesses overflow; no part is near it.
    [[nodiscard]] double in_mm(double units, const std::string& place) const {
        constexpr double farthest = 1e100;
        const double mm = units * units_;
        if (!(std::abs(mm) <= farthest))
            throw Error(ErrorKind::input,
                        fmt::format("{}, layer at {}: found {} units of {} mm; heights and coordinates must "
                                    "lie within {} mm",
                                    name_, place, units, units_, farthest));
        return mm;
    }

    /// Which of the parts met so far has this number.
    template <class Place>
    std::uint32_t part_slot(std::int64_t number, const Place& place) {
        // A node of `slots_`, the part, and what is made of both for a while.
        constexpr std::uint64_t part_bytes = 2 * (64 + sizeof(LayerPart));
        if (last_slot_ == slots_.end() || last_slot_->first != number)
            last_slot_ = slots_.find(number);
        if (last_slot_ == slots_.end()) {
            limits_.add_bytes_at(part_bytes, place);
            last_slot_ = slots_.emplace(number, static_cast<std::uint32_t>(slots_.size())).first;
        }
        return last_slot_->second;
    }

    static double twice_area(const RawLayer& layer, std::size_t begin) {
        const Point2& o = layer.points[begin];
        double twice = 0;
        for (std::size_t i = begin + 2; i < layer.points.size(); ++i) {
            const Point2& a = layer.points[i - 1];
            const Point2& b = layer.points[i];
            twice += (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
        }
        return twice;
    }

    double units_;
    const std::string& name_;
    ReadLimits& limits_;
    std::vector<RawLayer> layers_;
    std::map<std::int64_t, std::uint32_t> slots_; ///< of parts, by their numbers
    std::map<std::int64_t, std::uint32_t>::iterator last_slot_ = slots_.end();
    Oddity unclosed_{"closed contours did not return to their first point; they were closed"};
    Oddity turned_{"contours ran against their stated direction; they were turned round"};
    Oddity dropped_{"contours had too few different points; they were dropped"};
};

/// An integer parameter such as a direction, out of a number that may have a decimal point.
std::int64_t integer(Text& text, const char* what) {
    const double value = text.number(what);
    if (value != std::floor(value) || std::abs(value) > 9e15)
        text.fail(fmt::format("{}", value), fmt::format("{} must be a whole number", what));
    return static_cast<std::int64_t>(value);
}

void check_direction(const Text& text, std::int64_t direction) {
    if (direction < 0 || direction > 2)
        text.fail(fmt::format("direction {}", direction),
                  "it must be 0 (clockwise), 1 (counter-clockwise) or 2 (open)");
}

void read_ascii(std::string_view bytes, const std::string& name, const Header& header,
                const Execution& execution, Collector& collector) {
    Text text(bytes, header.end, name);
    text.skip_blanks();
    if (!text.take("$$GEOMETRYSTART"))
        text.fail(text.done() ? "the end of the file"
                              : fmt::format("'{}'", printable(text.rest().substr(0, 20), 40)),
                  "$$GEOMETRYSTART must follow the header");
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::read, bytes.size());
    std::size_t reported = 0;
    for (;;) {
        text.skip_blanks();
        if (text.done())
            text.fail("the end of the file", "the geometry must end with $$GEOMETRYEND");
        if (text.at() - reported > (1U << 20)) {
            executor.check_cancelled();
            progress.add(text.at() - reported);
            reported = text.at();
        }
        if (!text.take("$$"))
            text.fail(fmt::format("'{}'", printable(text.rest().substr(0, 20), 40)),
                      "a command must start with $$");
        const std::size_t command_at = text.at() - 2;
        const std::string_view command = text.take_command();
        if (command == "GEOMETRYEND")
            break;
        if (command == "LAYER") {
            text.expect('/', "the layer's height");
            const double z = text.number("the layer's height");
            collector.start_layer(z, fmt::format("byte {}", command_at));
        } else if (command == "POLYLINE" || command == "HATCHES") {
            if (!collector.in_layer())
                text.fail(fmt::format("$${} before the first $$LAYER", command),
                          "contours belong to a layer");
            text.expect('/', "the part's number");
            const std::int64_t part = integer(text, "the part's number");
            text.expect(',', "the next parameter");
            const bool polyline = command == "POLYLINE";
            std::int64_t direction = 2;
            if (polyline) {
                direction = integer(text, "the direction");
                check_direction(text, direction);
                text.expect(',', "the number of points");
            }
            const std::int64_t count =
                integer(text, polyline ? "the number of points" : "the number of hatches");
            // Two characters at least for each number that must follow.
            const std::int64_t numbers = polyline ? 2 : 4;
            if (count < 0 || count > static_cast<std::int64_t>(text.rest().size()) / (2 * numbers) + 1)
                text.fail(fmt::format("a count of {}", count),
                          fmt::format("{} bytes are left in the file", text.rest().size()));
            const auto place = [&] {
                return fmt::format("line {}", line_at(bytes, command_at));
            };
            if (polyline)
                collector.expect_points(static_cast<std::uint64_t>(count), place);
            else
                collector.expect_hatch_points(2 * static_cast<std::uint64_t>(count), place);
            for (std::int64_t i = 0; i < count; ++i) {
                std::array<double, 4> value{};
                for (std::size_t k = 0; k < static_cast<std::size_t>(numbers); ++k) {
                    text.expect(',', "the next coordinate");
                    value[k] = text.number("a coordinate");
                }
                if (polyline) {
                    collector.add_point(value[0], value[1]);
                } else {
                    collector.add_hatch_point(value[0], value[1]);
                    collector.add_hatch_point(value[2], value[3]);
                }
            }
            text.skip_blanks();
            if (!text.done() && !text.rest().starts_with("$$"))
                text.fail(fmt::format("'{}'", printable(text.rest().substr(0, 12), 24)),
                          fmt::format("the count of {} says that the coordinates end here", count));
            if (polyline)
                collector.end_polyline(part, static_cast<int>(direction), place);
            else
                collector.end_hatches(part, place);
        } else {
            // Extensions such as $$POWER/100.0 stand between polylines.
            text.move_to(std::min(bytes.find_first_of("\r\n", text.at()), bytes.size()));
        }
    }
    progress.finish();
}

enum class Command : std::uint16_t {
    layer_long = 127,
    layer_short = 128,
    polyline_short = 129,
    polyline_long = 130,
    hatches_short = 131,
    hatches_long = 132,
};

/// A cursor over the binary geometry.
class Bytes {
  public:
    Bytes(std::string_view bytes, std::size_t at, bool aligned, const std::string& name)
        : bytes_(bytes), at_(at), aligned_(aligned), name_(name) {}

    [[nodiscard]] std::size_t at() const { return at_; }
    [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
    [[nodiscard]] const char* data() const { return bytes_.data() + at_; }

    /// Some writers put a line end or zeros behind the last command.
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
            at_ = std::min(at_ + 2, bytes_.size()); // every 16-bit number fills a word of 32
        return value;
    }

    /// Room for `count` records of `size` bytes, all of them in the file. Moves behind them.
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

/// How 16-bit coordinates are meant. The standard says unsigned; exports exist that are signed, and only the
/// header's box tells: unsigned where it is said to be non-negative.
class ShortNumbers {
  public:
    explicit ShortNumbers(const Header& header)
        : signed_(header.dimension && ((*header.dimension)[0] < 0 || (*header.dimension)[1] < 0)) {}

    [[nodiscard]] double operator()(const char* from) const {
        std::uint16_t bits = 0;
        std::memcpy(&bits, from, sizeof bits);
        return signed_ ? static_cast<double>(static_cast<std::int16_t>(bits)) : static_cast<double>(bits);
    }

  private:
    bool signed_;
};

double finite(const Bytes& in, std::size_t at, float value, const char* what) {
    if (!std::isfinite(value))
        in.fail(at, fmt::format("{} that is not finite", what), "it must be a number");
    return static_cast<double>(value);
}

void read_binary(std::string_view bytes, const std::string& name, const Header& header,
                 const Execution& execution, Collector& collector) {
    std::size_t begin = header.aligned ? (header.end + 3) / 4 * 4 : header.end;
    // Some writers end the header with a line end; a command never begins with one.
    if (!header.aligned) {
        const std::string_view rest = bytes.substr(begin);
        if (rest.starts_with("\r\n"))
            begin += 2;
        else if (rest.starts_with("\n"))
            begin += 1;
    }
    Bytes in(bytes, std::min(begin, bytes.size()), header.aligned, name);
    const ShortNumbers short_number(header);
    const auto take_point = [&](const char* from, bool is_long, std::size_t at, const auto& take) {
        if (is_long) {
            std::array<float, 2> p{};
            std::memcpy(p.data(), from, sizeof p);
            if (!std::isfinite(p[0]) || !std::isfinite(p[1]))
                in.fail(at, "a point that is not finite", "coordinates must be numbers");
            take(static_cast<double>(p[0]), static_cast<double>(p[1]));
        } else {
            take(short_number(from), short_number(from + 2));
        }
    };
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::read, bytes.size());
    std::size_t reported = 0;
    while (in.left() > 0 && !in.only_padding_left()) {
        const std::size_t at = in.at();
        if (at - reported > (1U << 22)) {
            executor.check_cancelled();
            progress.add(at - reported);
            reported = at;
        }
        const auto command = static_cast<Command>(in.take<std::uint16_t>("a command"));
        const auto in_layer = [&] {
            if (!collector.in_layer())
                in.fail(at, "geometry before the first layer", "contours belong to a layer");
        };
        const auto place = [&] {
            return fmt::format("byte {}", at);
        };
        switch (command) {
        case Command::layer_long:
            collector.start_layer(finite(in, at, in.take<float>("a layer"), "a height"), place());
            break;
        case Command::layer_short:
            collector.start_layer(in.take<std::uint16_t>("a layer"), place());
            break;
        case Command::polyline_short:
        case Command::polyline_long: {
            in_layer();
            const bool is_long = command == Command::polyline_long;
            const auto parameter = [&]() -> std::int64_t {
                return is_long ? std::int64_t{in.take<std::int32_t>("a polyline")}
                               : std::int64_t{in.take<std::uint16_t>("a polyline")};
            };
            const std::int64_t part = parameter();
            const std::int64_t direction = parameter();
            if (direction < 0 || direction > 2)
                in.fail(at, fmt::format("a polyline of direction {}", direction),
                        "it must be 0 (clockwise), 1 (counter-clockwise) or 2 (open)");
            const std::int64_t count = parameter();
            const std::size_t size = is_long ? 8 : 4;
            const char* first = in.take_records(count, size, "points");
            collector.expect_points(static_cast<std::uint64_t>(count), place);
            for (std::int64_t i = 0; i < count; ++i, first += size)
                take_point(first, is_long, at, [&](double x, double y) { collector.add_point(x, y); });
            collector.end_polyline(part, static_cast<int>(direction), place);
            break;
        }
        case Command::hatches_short:
        case Command::hatches_long: {
            in_layer();
            const bool is_long = command == Command::hatches_long;
            const auto parameter = [&]() -> std::int64_t {
                return is_long ? std::int64_t{in.take<std::int32_t>("hatches")}
                               : std::int64_t{in.take<std::uint16_t>("hatches")};
            };
            const std::int64_t part = parameter();
            const std::int64_t count = parameter();
            const std::size_t size = is_long ? 8 : 4;
            const char* first = in.take_records(count, 2 * size, "hatches");
            collector.expect_hatch_points(2 * static_cast<std::uint64_t>(count), place);
            for (std::int64_t i = 0; i < 2 * count; ++i, first += size)
                take_point(first, is_long, at, [&](double x, double y) { collector.add_hatch_point(x, y); });
            collector.end_hatches(part, place);
            break;
        }
        default:
            in.fail(at, fmt::format("command {}", static_cast<unsigned>(command)),
                    "the commands are 127 to 132: layers, polylines and hatches");
        }
    }
    progress.finish();
}

/// Heights are tops of layers, and an empty layer before the first one tells where that begins. Exports exist
/// whose first layer lies on the bottom of the part and has contours: there heights are bottoms.
void make_layers(std::vector<RawLayer>& raw, const Header& header, std::uint64_t bytes, LayerFile& file,
                 ReadLimits& limits) {
    sort_by_height(raw, file.warnings);
    if (raw.empty())
        return;
    const std::size_t n = raw.size();
    const bool has_zero_layer = raw.front().ends.empty() && raw.front().hatch_ends.empty() && n > 1;
    const double lowest = header.dimension ? (*header.dimension)[2] : 0.0;
    // A single layer below the bottom of the part has no thickness that could be told.
    const double first_step = n > 1 ? raw[1].z - raw[0].z : std::max(0.0, raw[0].z - lowest);
    const bool heights_are_bottoms = !has_zero_layer && n > 1 && raw.front().z <= lowest;
    if (heights_are_bottoms)
        file.warnings.push_back(
            fmt::format("the first layer, at the bottom of the part (z = {} mm), has contours; heights "
                        "are taken for the bottoms of layers",
                        raw.front().z));
    const std::size_t begin = has_zero_layer ? 1 : 0;
    check_part_planes(file, n - begin, bytes);
    for (std::size_t i = begin; i < n; ++i) {
        double bottom = 0;
        double top = 0;
        if (heights_are_bottoms) {
            bottom = raw[i].z;
            top = i + 1 < n ? raw[i + 1].z : bottom + (bottom - raw[i - 1].z);
        } else {
            top = raw[i].z;
            bottom = i > 0 ? raw[i - 1].z : top - first_step;
        }
        add_layer(file, raw[i], i - begin, bottom + (top - bottom) / 2, bottom, top, limits);
    }
}

} // namespace

bool is_common_layer(std::string_view bytes) {
    const std::size_t at = bytes.substr(0, longest_preface).find(header_start);
    return at != std::string_view::npos;
}

LayerFile read_common_layer(std::string_view bytes, const std::string& name, ReadLimits& limits,
                            const Execution& execution) {
    const Header header = read_header(bytes, name);
    LayerFile file;
    file.path = name;
    file.format = header.binary ? "cli" : "cli-ascii";
    file.units_mm = header.units_mm;
    file.resolution_mm = header.units_mm;

    Collector collector(header, name, limits);
    if (header.binary)
        read_binary(bytes, name, header, execution, collector);
    else
        read_ascii(bytes, name, header, execution, collector);
    const std::uint64_t found = collector.layers().size();
    if (found == 0)
        throw Error(ErrorKind::input,
                    fmt::format("{}, byte {}: found no layer; a slice file must have at least one", name,
                                header.end));
    if (header.layers && *header.layers != found)
        file.warnings.push_back(
            fmt::format("the header announces {} layers; the file has {}", *header.layers, found));
    collector.say(file.warnings);
    collector.number_parts(header, file);
    make_layers(collector.layers(), header, bytes.size(), file, limits);
    return file;
}

} // namespace lamella
