#include "slices/formats/svg_outlines.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"

#include "container/decimal_text.hpp"
#include "core/farthest.hpp"
#include "slices/engine/even_odd_rings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace lamella {

namespace {

/// A cursor over the numbers of an attribute.
class SvgNumbers {
  public:
    SvgNumbers(std::string_view text, const SvgElement& element) : text_(text), element_(element) {}

    [[nodiscard]] bool done() {
        skip_separators();
        return text_.empty();
    }
    /// Takes a letter if it is next: a command of path data.
    [[nodiscard]] std::optional<char> letter() {
        skip_separators();
        const char c = text_.empty() ? '\0' : text_.front();
        const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        if (!is_letter)
            return std::nullopt;
        text_.remove_prefix(1);
        return c;
    }
    double next() {
        skip_separators();
        double value = 0;
        const char* const to = read_decimal(text_.data(), text_.data() + text_.size(), value);
        if (to == nullptr || is_too_far(value))
            element_.fail(fmt::format("found '{}'; a coordinate must be a number within {}",
                                      printable(text_.substr(0, text_.find_first_of(" ,")), 40),
                                      farthest_mm));
        text_.remove_prefix(static_cast<std::size_t>(to - text_.data()));
        return value;
    }

  private:
    void skip_separators() {
        text_.remove_prefix(std::min(text_.find_first_not_of(" ,\t\r\n"), text_.size()));
    }

    std::string_view text_;
    const SvgElement& element_;
};

struct SvgUnit {
    std::string_view name;
    double mm;
};

/// Units of lengths. Programs that write layers mean millimetres if there is none.
constexpr std::array svg_units = {SvgUnit{"", 1},          SvgUnit{"mm", 1},         SvgUnit{"cm", 10},
                                  SvgUnit{"in", 25.4},     SvgUnit{"pt", 25.4 / 72}, SvgUnit{"pc", 25.4 / 6},
                                  SvgUnit{"px", 25.4 / 96}};

struct SvgLength {
    double number = 0;
    std::string_view unit;
};

/// Returns the width or height of the document.
std::optional<SvgLength> length_of(const SvgElement& root, std::string_view attribute) {
    const std::string_view text = trimmed(root[attribute]);
    if (text.empty())
        return std::nullopt;
    // A unit may begin like an exponent (em, ex).
    const std::size_t end = text.find_last_of("0123456789.") + 1;
    return SvgLength{SvgNumbers(text.substr(0, end), root).next(), trimmed(text.substr(end))};
}

} // namespace

std::string_view SvgElement::local() const {
    const std::size_t colon = name.find(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

std::optional<double> SvgElement::number(std::string_view attribute) const {
    const std::string_view text = (*this)[attribute];
    if (text.data() == nullptr)
        return std::nullopt;
    SvgNumbers numbers(text, *this);
    const double value = numbers.next();
    if (!numbers.done())
        fail(fmt::format("found {} = '{}'; it must be one number with a decimal point", attribute,
                         printable(text, 40)));
    return value;
}

bool SvgElement::is_even_odd(bool inherited) const {
    std::string_view rule = (*this)["fill-rule"];
    const std::string_view style = (*this)["style"];
    constexpr std::string_view property = "fill-rule:";
    if (const std::size_t at = style.find(property); at != std::string_view::npos)
        rule = style.substr(at + property.size());
    rule = trimmed(rule.substr(0, rule.find(';')));
    return rule.empty() || rule == "inherit" ? inherited : rule == "evenodd";
}

void SvgElement::fail(const std::string& text) const {
    throw Error(ErrorKind::input, fmt::format("{}, line {}: {}", document, line, text));
}

SvgCanvas::SvgCanvas(const SvgElement& root) {
    read_scale(root);
    if (const std::string_view origin = root["data-lamella-origin"]; origin.data() != nullptr) {
        SvgNumbers numbers(origin, root);
        origin_.x = numbers.next();
        origin_.y = numbers.next();
    }
}

/// Reads the size of the document, and the scale that its view box defines.
void SvgCanvas::read_scale(const SvgElement& root) {
    const std::array<std::optional<SvgLength>, 2> size = {length_of(root, "width"),
                                                          length_of(root, "height")};
    height_ = size[1] ? size[1]->number : 0;
    const auto refuse_scale = [&](std::string_view why) {
        warning_ = fmt::format("line {}: {}; coordinates were taken as millimetres", root.line, why);
    };
    const std::string_view box = root["viewBox"];
    if (box.data() == nullptr) {
        // Units of the screen, such as em, say nothing of the part.
        for (const std::optional<SvgLength>& one : size)
            for (const SvgUnit& known : svg_units)
                if (one && known.name == one->unit && known.mm != 1)
                    refuse_scale(
                        fmt::format("the size of the document is in '{}', and no viewBox says what that is "
                                    "in coordinates",
                                    known.name));
        return;
    }
    SvgNumbers numbers(box, root);
    const Point2 corner = {numbers.next(), numbers.next()};
    const std::array<double, 2> in_box = {numbers.next(), numbers.next()};
    std::optional<double> scale;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const auto* const unit =
            !size[axis] ? svg_units.end()
                        : std::find_if(svg_units.begin(), svg_units.end(),
                                       [&](const SvgUnit& known) { return known.name == size[axis]->unit; });
        if (unit == svg_units.end()) // a part of the screen, or no size at all
            continue;
        const double of_axis = size[axis]->number / in_box[axis] * unit->mm;
        constexpr double same = 1e-6; // relative; sizes are rounded
        if (!(of_axis > 0 && std::isfinite(of_axis)) || (scale && std::abs(of_axis - *scale) > same * *scale))
            return refuse_scale("width, height and viewBox define no common scale of x and y");
        scale = scale.value_or(of_axis);
    }
    scale_ = scale.value_or(1);
    corner_ = corner;
    height_ = in_box[1];
}

Point2 SvgCanvas::placed(const Point2& point, const SvgElement& element) const {
    const Point2 p = {(point.x - corner_.x) * scale_ + origin_.x, (point.y - corner_.y) * scale_ + origin_.y};
    if (is_too_far(p.x) || is_too_far(p.y))
        element.fail(fmt::format("found a point that lies beyond {} mm once it is scaled", farthest_mm));
    return p;
}

namespace {

/// Adds the outlines of an element.
class SvgOutlines {
  public:
    SvgOutlines(const SvgElement& element, const SvgDrawing& to)
        : element_(element), to_(to), first_(to.layer.ends.size()) {}

    void add_points(bool closed) {
        SvgNumbers numbers(element_["points"], element_);
        while (!numbers.done()) {
            const double x = numbers.next();
            add(to_.canvas.placed({x, numbers.next()}, element_));
        }
        end_contour(closed);
        direct_by_type(element_["slic3r:type"]);
    }

    void add_path(bool even_odd) {
        const std::string_view type = element_["slic3r:type"];
        if (type == "infill" || type == "perimeter")
            return; // tool paths inside the outlines
        SvgNumbers numbers(element_["d"], element_);
        Point2 at;
        std::optional<Point2> first; // of the contour; Z returns to it
        char command = 'M';
        while (!numbers.done()) {
            if (const auto letter = numbers.letter())
                command = *letter;
            if (command == 'z' || command == 'Z') {
                end_contour(true);
                at = first.value_or(at);
                command = 'M';
                continue;
            }
            const bool relative = command >= 'a';
            const bool moves = command == 'M' || command == 'm';
            if (!moves && first && to_.layer.points.size() == to_.layer.contour_begin())
                add(to_.canvas.placed_in_path(*first, element_)); // after Z the next contour begins where the
                                                                  // last one began
            switch (command) {
            case 'M':
            case 'm':
                end_contour(false);
                [[fallthrough]];
            case 'L':
            case 'l': {
                const double x = numbers.next();
                const double y = numbers.next();
                at = relative ? Point2{at.x + x, at.y + y} : Point2{x, y};
                break;
            }
            case 'H':
            case 'h':
                at.x = numbers.next() + (relative ? at.x : 0);
                break;
            case 'V':
            case 'v':
                at.y = numbers.next() + (relative ? at.y : 0);
                break;
            default:
                element_.fail(fmt::format(
                    "found path command '{}'; outlines of layers are straight (M, L, H, V, Z)", command));
            }
            if (moves) {
                first = at;
                command = relative ? 'l' : 'L'; // further pairs are the ends of lines
            }
            add(to_.canvas.placed_in_path(at, element_));
        }
        end_contour(false);
        if (element_.is_even_odd(even_odd))
            direct_by_rule();
        else if (type == "hole")
            direct_by_type(type);
    }

  private:
    void add(const Point2& point) {
        to_.limits.make_room(to_.layer.points, 1, element_.location());
        to_.layer.points.push_back(point);
    }

    /// Returns the points of a contour of the layer.
    [[nodiscard]] std::span<Point2> contour(std::size_t i) const {
        const std::size_t begin = i == 0 ? 0 : to_.layer.ends[i - 1].end;
        return std::span(to_.layer.points).subspan(begin, to_.layer.ends[i].end - begin);
    }

    /// Reverses rings of the element that contradict its type.
    void direct_by_type(std::string_view type) {
        const bool hole = type == "hole";
        if (!hole && type != "contour")
            return;
        for (std::size_t i = first_; i < to_.layer.ends.size(); ++i) {
            const std::span<Point2> ring = contour(i);
            const double area = to_.layer.ends[i].closed ? ring_area(ring) : 0;
            if (area == 0 || (area < 0) == hole)
                continue;
            std::reverse(ring.begin(), ring.end());
            to_.found.note(FindingKind::reversed_by_rule, element_.location());
        }
    }

    /// Reverses rings of a path that contradict the even-odd rule.
    void direct_by_rule() {
        std::vector<std::span<Point2>> rings;
        for (std::size_t i = first_; i < to_.layer.ends.size(); ++i)
            if (to_.layer.ends[i].closed)
                rings.push_back(contour(i));
        if (rings.size() < 2)
            return;
        const std::uint64_t taken = rings.size() * (sizeof(Box3) + sizeof rings[0]);
        to_.limits.add_bytes_at(taken, element_.location());
        const std::optional<std::size_t> reversed = direct_by_even_odd(rings);
        to_.limits.give_back(0, taken);
        if (!reversed)
            to_.found.note(FindingKind::unsorted_rings, element_.location());
        for (std::size_t i = 0; i < reversed.value_or(0); ++i)
            to_.found.note(FindingKind::reversed_by_rule, element_.location());
    }

    /// Ends the contour under construction, if there is one.
    void end_contour(bool closed) {
        if (to_.layer.points.size() == to_.layer.contour_begin())
            return;
        const bool returning_chain = !closed && to_.layer.is_returning_chain();
        closed = closed || returning_chain;
        if (!to_.layer.end_contour(closed, to_.part, to_.limits, element_.location(), to_.found))
            return;
        if (returning_chain)
            to_.found.note(FindingKind::returning_chains, element_.location());
        else if (!closed)
            to_.found.note(FindingKind::open_polylines, element_.location());
    }

    const SvgElement& element_;
    SvgDrawing to_;
    std::size_t first_; ///< contour of the element
};

} // namespace

void add_svg_points(const SvgElement& element, bool closed, const SvgDrawing& to) {
    SvgOutlines(element, to).add_points(closed);
}

void add_svg_path(const SvgElement& element, bool even_odd, const SvgDrawing& to) {
    SvgOutlines(element, to).add_path(even_odd);
}

} // namespace lamella
