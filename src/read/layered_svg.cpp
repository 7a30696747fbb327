#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "container/xml.hpp"
#include "core/executor.hpp"
#include "core/farthest.hpp"
#include "core/lower_case.hpp"
#include "read/decimal_text.hpp"
#include "read/even_odd_rings.hpp"
#include "read/layer_assembly.hpp"
#include "read/layer_pieces.hpp"
#include "read/layer_readers.hpp"
#include "read/read_limits.hpp"
#include "read/text_chunks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

namespace {

struct SvgUnit {
    std::string_view name;
    double mm;
};

/// Units of lengths. Programs that write layers mean millimetres if there is none.
constexpr std::array svg_units = {SvgUnit{"", 1},          SvgUnit{"mm", 1},         SvgUnit{"cm", 10},
                                  SvgUnit{"in", 25.4},     SvgUnit{"pt", 25.4 / 72}, SvgUnit{"pc", 25.4 / 6},
                                  SvgUnit{"px", 25.4 / 96}};

/// Returns whether an element fills its outlines by the even-odd rule; `inherited` is that of its parent.
bool is_even_odd(const XmlAttributes& attributes, bool inherited) {
    std::string_view rule = attributes.find("fill-rule");
    const std::string_view style = attributes.find("style");
    constexpr std::string_view property = "fill-rule:";
    if (const std::size_t at = style.find(property); at != std::string_view::npos)
        rule = style.substr(at + property.size());
    rule = trimmed(rule.substr(0, rule.find(';')));
    return rule.empty() || rule == "inherit" ? inherited : rule == "evenodd";
}

/// A cursor over the numbers of an attribute.
class Numbers {
  public:
    Numbers(std::string_view text, const std::string& name, std::size_t line)
        : text_(text), name_(name), line_(line) {}

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
            throw Error(ErrorKind::input,
                        fmt::format("{}, line {}: found '{}'; a coordinate must be a number within {}", name_,
                                    line_, printable(text_.substr(0, text_.find_first_of(" ,")), 40),
                                    farthest_mm));
        text_.remove_prefix(static_cast<std::size_t>(to - text_.data()));
        return value;
    }

  private:
    void skip_separators() {
        text_.remove_prefix(std::min(text_.find_first_not_of(" ,\t\r\n"), text_.size()));
    }

    std::string_view text_;
    const std::string& name_;
    std::size_t line_;
};

/// One <g> of the file. RawLayer::z is the value in the file.
struct Group : RawLayer {
    std::optional<double> slice_z;
    std::optional<double> height;
    double cut = 0; ///< height of the cut
    double bottom = 0;
    double top = 0;
};

/// Computes the heights of layers and sorts them by cut, which may differ from the order of tops. Slic3r 1.x
/// writes the cut in its scaled units, a millionth of the value in millimetres; later versions write the top
/// in millimetres.
void place_groups(std::vector<Group>& groups, std::vector<std::string>& warnings) {
    double highest = 0;
    bool has_slice_z = false;
    for (const Group& group : groups) {
        highest = std::max(highest, std::abs(group.z));
        has_slice_z = has_slice_z || group.slice_z.has_value();
    }
    const bool legacy = !has_slice_z && highest < 0.01;
    for (Group& group : groups)
        group.z *= legacy ? 1e6 : 1;
    // Layers with different cuts are different layers, even if their tops are rounded to the same value.
    sort_by_height(groups, warnings,
                   [](const Group& a, const Group& b) { return a.z == b.z && a.slice_z == b.slice_z; });
    const std::size_t n = groups.size();
    const auto step_below = [&](std::size_t i) {
        const auto z = [&](std::size_t k) {
            return groups[k].z;
        };
        if (i > 0)
            return z(i) - z(i - 1);
        return n > 1 ? z(1) - z(0) : std::max(0.0, z(0));
    };
    for (std::size_t i = 0; i < n; ++i) {
        Group& group = groups[i];
        const double thickness = group.height.value_or(step_below(i));
        group.top = legacy ? group.z + thickness / 2 : group.z;
        group.bottom = group.top - thickness;
        const double middle = group.bottom + thickness / 2;
        group.cut = legacy ? group.z : group.slice_z.value_or(middle);
        // The cut may be outside of the layer, because heights are rounded separately or come from other
        // programs. Extend the layer to it.
        group.bottom = std::min(group.bottom, group.cut);
        group.top = std::max(group.top, group.cut);
    }
    const auto below = [](const Group& a, const Group& b) {
        return a.cut < b.cut;
    };
    if (!std::is_sorted(groups.begin(), groups.end(), below)) // sorting takes memory
        std::stable_sort(groups.begin(), groups.end(), below);
    // Heights and thicknesses are rounded separately. A layer within this distance of the one below counts as
    // adjoining it.
    constexpr double rounding = 1e-3;
    for (std::size_t i = 1; i < n; ++i) {
        const double top_below = groups[i - 1].top;
        if (std::abs(groups[i].bottom - top_below) <= rounding && top_below <= groups[i].cut)
            groups[i].bottom = top_below;
    }
}

/// Reads a document, or layers of it.
class SvgReader {
  public:
    SvgReader(const std::string& name, ReadLimits& limits) : name_(name), limits_(limits) {}

    /// Returns a reader of layers of this document, in which their first line is `line`.
    [[nodiscard]] SvgReader of_layers(std::uint64_t line, ReadLimits& limits) const {
        SvgReader reader(name_, limits);
        reader.depth_ = 1;
        reader.height_ = height_;
        reader.scale_ = scale_;
        reader.corner_ = corner_;
        reader.even_odd_root_ = reader.even_odd_ = even_odd_root_;
        reader.origin_ = origin_;
        reader.line_ = line;
        return reader;
    }

    /// Appends the layers that follow. Returns false, and changes nothing, if their parts are not numbered
    /// as they must be; reading them here reports it.
    [[nodiscard]] bool append(SvgReader&& layers) {
        std::size_t known = parts_.size();
        for (const MetPart& part : layers.met_) {
            if (part.number > known + 1)
                return false;
            known = std::max(known, part.number);
        }
        for (const MetPart& part : layers.met_)
            meet(part);
        append_layers(groups_, std::move(layers.groups_), limits_);
        found_.add(layers.found_);
        return true;
    }

    /// Returns true within the root element, but outside of its elements.
    [[nodiscard]] bool is_in_root() const { return depth_ == 1; }

    /// Returns the start tag of the root element, without attributes.
    [[nodiscard]] std::string parent() const { return fmt::format("<{}>", root_); }

    /// Takes the offset of the element that starts next.
    void start_at(std::size_t position) { position_ = position; }

    /// Returns the only layer.
    [[nodiscard]] RawLayer layer() && { return only_layer(std::move(groups_)); }

    void start(std::string_view element, const XmlAttributes& attributes, std::size_t line) {
        line += line_ - 1;
        const bool is_root = depth_++ == 0;
        if (is_root) {
            root_ = element;
            if (local(element) != "svg")
                fail(line, fmt::format("found <{}>; the document must be <svg>", printable(element, 40)));
            read_scale(attributes, line);
            even_odd_root_ = even_odd_ = is_even_odd(attributes, false);
            if (const std::string_view origin = attributes.find("data-lamella-origin");
                origin.data() != nullptr) {
                Numbers numbers(origin, name_, line);
                origin_.x = numbers.next();
                origin_.y = numbers.next();
            }
            if (const std::string_view name = attributes.find("data-lamella-rule"); name.data() != nullptr) {
                const std::optional<PlaneRule> rule = plane_rule(name);
                if (!rule)
                    fail(line, fmt::format("found the rule '{}'; planes are cut by section_above or "
                                           "section_below",
                                           printable(name, 40)));
                rule_ = *rule;
            }
        } else if (depth_ == 2 && local(element) == "g") {
            start_layer(attributes, line);
        } else {
            const std::string_view kind = local(element);
            const bool has_points = kind == "polygon" || kind == "polyline";
            if (!in_layer_ && (has_points || kind == "path"))
                found_.note(FindingKind::outside_outlines, at_line(line));
            else if (!in_layer_)
                return;
            else if (has_points)
                add_points(attributes, kind == "polygon", line);
            else if (kind == "path")
                add_path(attributes, line);
            else if (kind == "g")
                start_part(attributes, line);
            else if (kind != "title" && kind != "desc")
                found_.note(FindingKind::other_elements, at_line(line));
        }
        if ((is_root || in_layer_) && !attributes.find("transform").empty())
            found_.note(FindingKind::unfollowed_transforms, at_line(line));
    }

    void end() {
        if (--depth_ == 1) {
            if (in_layer_)
                groups_.back().end_layer(limits_);
            in_layer_ = false;
        }
        if (depth_ == 2)
            part_ = 0;
    }

    /// `parse` is as in add_layers.
    void finish(LayerFile& file, std::uint64_t bytes, const Execution& execution, ParseLayer parse) {
        if (groups_.empty())
            throw Error(ErrorKind::input,
                        fmt::format("{}: found no layer; a layered SVG holds one <g> with slic3r:z for "
                                    "each layer",
                                    name_));
        file.rule = rule_;
        file.parts = std::move(parts_);
        labels_.append_to(file.warnings);
        if (!unknown_scale_.empty())
            file.warnings.push_back(unknown_scale_);
        append_to(found_, file.warnings);
        place_groups(groups_, file.warnings);
        check_part_planes(file, groups_.size(), bytes);
        std::vector<PlacedLayer> planes;
        planes.reserve(groups_.size());
        for (Group& group : groups_)
            planes.push_back({&group, planes.size(), group.cut, group.bottom, group.top});
        add_layers(file, planes, limits_, execution, std::move(parse));
    }

  private:
    static std::string_view local(std::string_view element) {
        const std::size_t colon = element.find(':');
        return colon == std::string_view::npos ? element : element.substr(colon + 1);
    }

    [[noreturn]] void fail(std::size_t line, const std::string& text) const {
        throw Error(ErrorKind::input, fmt::format("{}, line {}: {}", name_, line, text));
    }

    struct Length {
        double number = 0;
        std::string_view unit;
    };

    /// Returns the width or height of the document.
    std::optional<Length> length(const XmlAttributes& attributes, std::string_view name,
                                 std::size_t line) const {
        const std::string_view text = trimmed(attributes.find(name));
        if (text.empty())
            return std::nullopt;
        // A unit may begin like an exponent (em, ex).
        const std::size_t end = text.find_last_of("0123456789.") + 1;
        return Length{Numbers(text.substr(0, end), name_, line).next(), trimmed(text.substr(end))};
    }

    /// Reads the size of the document, and the scale that its view box defines.
    void read_scale(const XmlAttributes& attributes, std::size_t line) {
        const std::array<std::optional<Length>, 2> size = {length(attributes, "width", line),
                                                           length(attributes, "height", line)};
        height_ = size[1] ? size[1]->number : 0;
        const auto refuse_scale = [&](std::string_view what) {
            unknown_scale_ = fmt::format("line {}: {}; coordinates were taken as millimetres", line, what);
        };
        const std::string_view box = attributes.find("viewBox");
        if (box.data() == nullptr) {
            // Units of the screen, such as em, say nothing of the part.
            for (const std::optional<Length>& one : size)
                for (const SvgUnit& known : svg_units)
                    if (one && known.name == one->unit && known.mm != 1)
                        refuse_scale(
                            fmt::format("the size of the document is in '{}', and no viewBox says what "
                                        "that is in coordinates",
                                        known.name));
            return;
        }
        Numbers numbers(box, name_, line);
        const Point2 corner = {numbers.next(), numbers.next()};
        const std::array<double, 2> in_box = {numbers.next(), numbers.next()};
        std::optional<double> scale;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const auto* const unit =
                !size[axis] ? svg_units.end()
                            : std::find_if(svg_units.begin(), svg_units.end(), [&](const SvgUnit& known) {
                                  return known.name == size[axis]->unit;
                              });
            if (unit == svg_units.end()) // a part of the screen, or no size at all
                continue;
            const double of_axis = size[axis]->number / in_box[axis] * unit->mm;
            constexpr double same = 1e-6; // relative; sizes are rounded
            if (!(of_axis > 0 && std::isfinite(of_axis)) ||
                (scale && std::abs(of_axis - *scale) > same * *scale))
                return refuse_scale("width, height and viewBox define no common scale of x and y");
            scale = scale.value_or(of_axis);
        }
        scale_ = scale.value_or(1);
        corner_ = corner;
        height_ = in_box[1];
    }

    std::optional<double> number(const XmlAttributes& attributes, std::string_view name,
                                 std::size_t line) const {
        const std::string_view text = attributes.find(name);
        if (text.data() == nullptr)
            return std::nullopt;
        Numbers numbers(text, name_, line);
        const double value = numbers.next();
        if (!numbers.done())
            fail(line, fmt::format("found {} = '{}'; it must be one number with a decimal point", name,
                                   printable(text, 40)));
        return value;
    }

    void start_layer(const XmlAttributes& attributes, std::size_t line) {
        const auto z = number(attributes, "slic3r:z", line);
        if (!z)
            return; // a group without z, such as a legend
        in_layer_ = true;
        Group group;
        group.z = *z;
        group.location = fmt::format("line {}", line);
        group.begin = position_;
        group.slice_z = number(attributes, "slic3r:slice-z", line);
        group.height = number(attributes, "slic3r:layer-height", line);
        if (group.height && *group.height < 0)
            fail(line, fmt::format("found a layer height of {}; it must not be below 0", *group.height));
        make_room(groups_, line);
        groups_.push_back(std::move(group));
        even_odd_ = is_even_odd(attributes, even_odd_root_);
    }

    /// Returns a point of the file in millimetres of the part.
    [[nodiscard]] Point2 placed(double x, double y, std::size_t line) const {
        const Point2 p = {(x - corner_.x) * scale_ + origin_.x, (y - corner_.y) * scale_ + origin_.y};
        if (is_too_far(p.x) || is_too_far(p.y))
            fail(line, fmt::format("found a point that lies beyond {} mm once it is scaled", farthest_mm));
        return p;
    }

    /// Lamella's own files put each of several parts into a group, numbered from 1.
    void start_part(const XmlAttributes& attributes, std::size_t line) {
        const auto part = depth_ == 3 ? number(attributes, "data-lamella-part", line) : std::nullopt;
        if (!part)
            return;
        const std::size_t known = parts_.size();
        constexpr double most = std::numeric_limits<std::uint32_t>::max();
        if (!(*part >= 1 && *part <= (is_piece() ? most : static_cast<double>(known + 1))) ||
            *part != std::floor(*part))
            fail(line, fmt::format("found part {}; parts are numbered, and {} came so far", *part, known));
        part_ = static_cast<std::uint32_t>(*part) - 1;
        MetPart met{static_cast<std::size_t>(part_) + 1, std::string(attributes.find("data-lamella-label")),
                    line};
        if (!is_piece())
            return meet(met);
        if (const auto [labelled, added] = labelled_.try_emplace(met.number, false);
            added || (!labelled->second && !met.label.empty())) {
            labelled->second = !met.label.empty();
            limits_.add_bytes_at(2 * node_bytes + sizeof met + met.label.size(), at_line(line));
            met_.push_back(std::move(met));
        }
    }

    /// A part where its number or its label is new.
    struct MetPart {
        std::size_t number;
        std::string label;
        std::size_t line;
    };

    /// Makes the part if it is the next one, and sets its label unless it has one.
    void meet(const MetPart& part) {
        if (part.number > parts_.size()) {
            make_room(parts_, part.line);
            parts_.push_back({.label = {}});
        }
        if (PartInfo& drawn = parts_[part.number - 1]; drawn.label.empty()) {
            drawn.label = labels_.of(part.label);
            drawn.exposure = labelled_exposure(drawn.label);
        }
    }

    /// Returns whether this reads layers without the document around them.
    [[nodiscard]] bool is_piece() const { return root_.empty(); }

    void add_points(const XmlAttributes& attributes, bool closed, std::size_t line) {
        RawLayer& layer = groups_.back();
        Numbers numbers(attributes.find("points"), name_, line);
        const std::size_t first = layer.ends.size();
        while (!numbers.done()) {
            const double x = numbers.next();
            make_room(layer.points, line);
            layer.points.push_back(placed(x, numbers.next(), line));
        }
        end_contour(closed, line);
        direct_by_type(attributes.find("slic3r:type"), first, line);
    }

    /// Returns the points of a contour of the layer.
    [[nodiscard]] std::span<Point2> contour(std::size_t i) {
        RawLayer& layer = groups_.back();
        const std::size_t begin = i == 0 ? 0 : layer.ends[i - 1].end;
        return std::span(layer.points).subspan(begin, layer.ends[i].end - begin);
    }

    /// Reverses rings from the contour `first` on that contradict the type of their element.
    void direct_by_type(std::string_view type, std::size_t first, std::size_t line) {
        const bool hole = type == "hole";
        if (!hole && type != "contour")
            return;
        for (std::size_t i = first; i < groups_.back().ends.size(); ++i) {
            const std::span<Point2> ring = contour(i);
            const double area = groups_.back().ends[i].closed ? ring_area(ring) : 0;
            if (area == 0 || (area < 0) == hole)
                continue;
            std::reverse(ring.begin(), ring.end());
            found_.note(FindingKind::reversed_by_rule, at_line(line));
        }
    }

    /// Reverses rings of a path from the contour `first` on that contradict the even-odd rule.
    void direct_by_rule(std::size_t first, std::size_t line) {
        std::vector<std::span<Point2>> rings;
        for (std::size_t i = first; i < groups_.back().ends.size(); ++i)
            if (groups_.back().ends[i].closed)
                rings.push_back(contour(i));
        if (rings.size() < 2)
            return;
        limits_.add_bytes_at(rings.size() * (sizeof(Box3) + sizeof rings[0]), at_line(line));
        const std::optional<std::size_t> reversed = direct_by_even_odd(rings);
        limits_.give_back(0, rings.size() * (sizeof(Box3) + sizeof rings[0]));
        if (!reversed)
            found_.note(FindingKind::unsorted_rings, at_line(line));
        for (std::size_t i = 0; i < reversed.value_or(0); ++i)
            found_.note(FindingKind::reversed_by_rule, at_line(line));
    }

    /// Reads straight outlines: M, L, H, V and Z in both cases. Slic3r inverts the y axis in paths.
    void add_path(const XmlAttributes& attributes, std::size_t line) {
        if (const std::string_view type = attributes.find("slic3r:type");
            type == "infill" || type == "perimeter")
            return; // tool paths inside the outlines
        RawLayer& layer = groups_.back();
        Numbers numbers(attributes.find("d"), name_, line);
        Point2 at;
        std::optional<Point2> first; // of the contour; Z returns to it
        const auto add = [&](const Point2& p) {
            make_room(layer.points, line);
            layer.points.push_back(placed(p.x, height_ - (p.y - corner_.y) + corner_.y, line));
        };
        const std::size_t begin = layer.ends.size();
        char command = 'M';
        while (!numbers.done()) {
            if (const auto letter = numbers.letter())
                command = *letter;
            if (command == 'z' || command == 'Z') {
                end_contour(true, line);
                at = first.value_or(at);
                command = 'M';
                continue;
            }
            const bool relative = command >= 'a';
            const bool moves = command == 'M' || command == 'm';
            if (!moves && first && layer.points.size() == layer.contour_begin())
                add(*first); // after Z the next contour begins where the last one began
            switch (command) {
            case 'M':
            case 'm':
                end_contour(false, line);
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
                fail(line,
                     fmt::format("found path command '{}'; outlines of layers are straight (M, L, H, V, Z)",
                                 command));
            }
            if (moves) {
                first = at;
                command = relative ? 'l' : 'L'; // further pairs are the ends of lines
            }
            add(at);
        }
        end_contour(false, line);
        if (is_even_odd(attributes, even_odd_))
            direct_by_rule(begin, line);
        else if (attributes.find("slic3r:type") == "hole")
            direct_by_type("hole", begin, line);
    }

    /// Ends the contour under construction, if there is one.
    void end_contour(bool closed, std::size_t line) {
        RawLayer& layer = groups_.back();
        if (layer.points.size() == layer.contour_begin())
            return;
        const bool returning_chain = !closed && layer.is_returning_chain();
        closed = closed || returning_chain;
        if (!layer.end_contour(closed, part_, limits_, at_line(line), found_))
            return;
        if (returning_chain)
            found_.note(FindingKind::returning_chains, at_line(line));
        else if (!closed)
            found_.note(FindingKind::open_polylines, at_line(line));
    }

    /// Makes room for one more item.
    template <class T>
    void make_room(std::vector<T>& items, std::size_t line) {
        limits_.make_room(items, 1, at_line(line));
    }

    const std::string& name_;
    ReadLimits& limits_;
    std::string root_; ///< name of the root element
    std::uint64_t line_ = 1;
    std::size_t position_ = 0; ///< of the element
    PlaneRule rule_ = PlaneRule::section_above;
    std::vector<PartInfo> parts_ = {PartInfo{.label = {}}};
    std::vector<MetPart> met_;             ///< of a piece, in the order of the file
    std::map<std::size_t, bool> labelled_; ///< whether these parts of a piece have labels
    std::uint32_t part_ = 0;
    int depth_ = 0;
    bool in_layer_ = false;
    double height_ = 0; ///< of the document, in units of its coordinates
    double scale_ = 1;  ///< millimetres per unit
    Point2 corner_;     ///< of the view box, in units
    bool even_odd_root_ = false;
    bool even_odd_ = false;     ///< of the current layer
    std::string unknown_scale_; ///< a warning
    Point2 origin_; ///< origin of the part in Lamella's own files; in other files coordinates are relative to
                    ///< a corner of the part
    std::vector<Group> groups_;
    ReadLabels labels_;
    Findings found_;
};

} // namespace

bool is_svg(std::string_view bytes) {
    constexpr std::size_t longest_preface = 1U << 16;
    const std::string_view begin = after_blanks(bytes.substr(0, longest_preface));
    return begin.starts_with('<') &&
           (begin.find("<svg") != std::string_view::npos || begin.find(":svg") != std::string_view::npos);
}

namespace {

/// Returns whether the document is in UTF-8, as far as its first line says.
bool is_utf8(std::string_view document) {
    const std::string_view text = document.substr(after_byte_order_mark(document));
    const std::string declaration =
        lower_case(text.starts_with("<?xml") ? text.substr(0, text.find("?>")) : std::string_view());
    return declaration.find("encoding") == std::string::npos ||
           declaration.find("utf-8") != std::string::npos;
}

/// Reads a document. Its layers are parsed in pieces, as long as these are well-formed on their own.
class SvgDocument {
  public:
    SvgDocument(std::string_view bytes, const std::string& name, ReadLimits& limits,
                const Execution& execution)
        : bytes_(bytes), name_(name), limits_(limits), execution_(execution), executor_(execution),
          progress_(execution, Stage::read, bytes.size()), reader_(name, limits), in_pieces_(is_utf8(bytes)) {
    }

    LayerFile read() {
        limits_.keep_text_in_memory(bytes_.size());
        if (!in_pieces_)
            limits_.keep_in_memory();
        LayerFile file = layer_file(name_, "svg", 1);
        file.rounding = text_rounding;
        std::uint64_t held = 0;
        XmlHandlers handlers = handlers_of(reader_, held, limits_);
        handlers.progress = [&](std::size_t read) {
            executor_.check_cancelled();
            const std::size_t counted = std::min(read, counted_ahead_);
            counted_ahead_ -= counted;
            progress_.add(read - counted);
        };
        handlers.many = {"<g"};
        handlers.skim = [&](XmlCursor& cursor) {
            read_layers(cursor);
        };
        parse_xml(bytes_, name_, handlers);
        reader_.finish(file, bytes_.size(), execution_,
                       [bytes = bytes_, &name = name_, parent = reader_.parent(),
                        around = std::make_shared<SvgReader>(reader_.of_layers(1, limits_))](
                           std::size_t begin, ReadLimits& limits) {
                           SvgReader reader = around->of_layers(1, limits);
                           std::uint64_t kept = 0;
                           static_cast<void>(parse_xml_elements(bytes, begin, begin + 1, parent, name,
                                                                handlers_of(reader, kept, limits)));
                           return std::move(reader).layer();
                       });
        progress_.finish();
        return file;
    }

  private:
    struct Piece {
        SvgReader reader;
        std::size_t end = std::string_view::npos; ///< where the next piece begins; npos after an error
    };

    /// `held` counts the bytes for the longest attribute.
    static XmlHandlers handlers_of(SvgReader& reader, std::uint64_t& held, ReadLimits& limits) {
        return {.start = [&](XmlName element, const XmlAttributes& attributes,
                             std::size_t line) { reader.start(element.local, attributes, line); },
                .end = [&](XmlName) { reader.end(); },
                .hold =
                    [&](std::size_t token) {
                        // The parser's buffer, the one before it, and the values of attributes.
                        const std::uint64_t taken = 4 * std::uint64_t{token};
                        if (taken <= held)
                            return;
                        limits.add_bytes_at(taken - held,
                                            [] { return std::string_view("a long attribute"); });
                        held = taken;
                    },
                .element =
                    [&](std::size_t position) {
                        reader.start_at(position);
                    }};
    }

    /// Reads the layers from the cursor on.
    void read_layers(XmlCursor& cursor) {
        if (!reader_.is_in_root() || !in_pieces_)
            return;
        const std::string parent = reader_.parent();
        const std::size_t begin = cursor.position();
        const std::uint64_t first_line = line_at(bytes_, begin);
        read_sibling_pieces(
            bytes_, begin, first_line, executor_,
            [&](std::size_t from, std::size_t limit, std::uint64_t line) {
                return read_piece(from, limit, parent, line);
            },
            [&](Piece&& piece, std::uint64_t line) {
                in_pieces_ = piece.end != std::string_view::npos && reader_.append(std::move(piece.reader));
                if (in_pieces_)
                    cursor.move_to(piece.end, line - first_line);
                return in_pieces_;
            });
        counted_ahead_ += cursor.position() - begin;
    }

    Piece read_piece(std::size_t begin, std::size_t limit, std::string_view parent, std::uint64_t line) {
        executor_.check_cancelled();
        Piece piece{.reader = reader_.of_layers(line, limits_)};
        std::uint64_t held = 0;
        XmlHandlers handlers = handlers_of(piece.reader, held, limits_);
        handlers.progress = [&](std::size_t) {
            executor_.check_cancelled();
        };
        try {
            piece.end = parse_xml_elements(bytes_, begin, limit, parent, name_, handlers);
            progress_.add(piece.end - begin);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input)
                throw;
        }
        limits_.give_back(0, held);
        return piece;
    }

    std::string_view bytes_;
    const std::string& name_;
    ReadLimits& limits_;
    const Execution& execution_;
    Executor executor_;
    ProgressMeter progress_;
    SvgReader reader_;
    bool in_pieces_;
    std::size_t counted_ahead_ = 0; ///< bytes whose progress was reported before the parser skipped them
};

} // namespace

LayerFile read_layered_svg(std::string_view bytes, const std::string& name, ReadLimits& limits,
                           const Execution& execution) {
    return SvgDocument(bytes, name, limits, execution).read();
}

} // namespace lamella
