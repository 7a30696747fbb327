#include "read/layer_assembly.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "core/counted.hpp"
#include "core/let_go.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <tuple>

namespace lamella {

namespace {

/// Returns whether the scan vectors have the order in which a layer stores them: by part, and in each part
/// first rings, then chains, then hatches. The order of contours of parts without an exposure does not
/// matter.
bool is_in_order(const RawLayer& raw, const LayerFile& file) {
    enum : std::uint8_t { ring, chain, hatch };
    std::tuple<std::uint32_t, std::uint8_t> last{};
    bool ascends = true;
    const auto follow = [&](std::uint32_t part, std::uint8_t kind) {
        if (!file.parts[part].exposure)
            return;
        ascends = ascends && last <= std::tuple(part, kind);
        last = {part, kind};
    };
    std::size_t contour = 0;
    const auto follow_contours = [&](std::size_t end) {
        for (; contour < end; ++contour)
            follow(raw.ends[contour].part, raw.ends[contour].closed ? ring : chain);
    };
    std::size_t begin = 0;
    for (const RawLayer::Hatches& hatches : raw.hatch_ends) {
        follow_contours(hatches.behind);
        if (hatches.end != begin)
            follow(hatches.part, hatch);
        begin = hatches.end;
    }
    follow_contours(raw.ends.size());
    return ascends;
}

/// Warns if the order of vectors changes, because machines execute them in this order.
void report_changed_order(std::span<const RawLayer> layers, LayerFile& file) {
    std::size_t changed = 0;
    double lowest = 0;
    for (const RawLayer& raw : layers)
        if (!is_in_order(raw, file) && changed++ == 0)
            lowest = raw.z;
    if (changed != 0)
        file.warnings.push_back(
            fmt::format("vectors of {}, the lowest at z = {:.6g} mm, are executed in another order in "
                        "the file; they were put into that of the parts",
                        counted(changed, "layer"), lowest));
}

/// The content of one part on a plane of the file.
struct PartOfLayer {
    std::size_t points = 0;
    std::size_t contours = 0;
    std::size_t hatches = 0; ///< ends of lines
    Layer layer = {};
};

/// Calls take(begin, piece) for consecutive pieces that know only their ends.
template <class Piece, class Take>
void for_pieces(const std::vector<Piece>& pieces, const Take& take) {
    std::size_t begin = 0;
    for (const Piece& piece : pieces) {
        take(begin, piece);
        begin = piece.end;
    }
}

/// Appends points; -0 becomes +0.
void append(std::vector<Point2>& to, std::span<const Point2> points) {
    for (const Point2& p : points)
        to.push_back({p.x + 0.0, p.y + 0.0});
}

} // namespace

std::string_view negative_parameter(const ParameterSet& set) {
    return set.power_w < 0           ? "power"
           : set.speed_mm_s < 0      ? "speed"
           : set.jump_speed_mm_s < 0 ? "speed of jumps"
                                     : "";
}

std::string ReadLabels::of(std::string_view label) {
    constexpr std::size_t longest = 4096; // longest label that writers keep
    std::string text = printable(label, longest);
    if (text != label && changed_++ == 0)
        first_ = text;
    return text;
}

void ReadLabels::append_to(std::vector<std::string>& warnings) const {
    if (changed_ != 0)
        warnings.push_back(
            fmt::format("{} bytes that are no text (UTF-8), or more than 4096 of them; the first "
                        "is read as '{}'",
                        counted(changed_, "label has", "labels have"), excerpt(first_)));
}

void append_to(const DistinctNames& names, std::vector<std::string>& warnings) {
    constexpr std::size_t longest = 60;
    if (const std::uint64_t changed = names.changed(); changed != 0)
        warnings.push_back(fmt::format("{} the name of another one; a number was put behind it, the first is "
                                       "now '{}'",
                                       counted(changed, "part has", "parts have"),
                                       printable(names.first_changed(), longest)));
}

void CountedWarning::append_to(std::vector<std::string>& warnings) const {
    if (count_ != 0)
        warnings.push_back(fmt::format("{} (first at {})", counted(count_, one_, many_), first_));
}

bool RawLayer::keep_contour(bool closed, std::uint32_t part) {
    const std::size_t begin = contour_begin();
    const auto contour = points.begin() + static_cast<std::ptrdiff_t>(begin);
    auto end = std::unique(contour, points.end());
    while (closed && end - contour > 1 && *(end - 1) == *contour)
        --end;
    points.erase(end, points.end());
    if (points.size() - begin < (closed ? 3U : 2U)) {
        points.resize(begin);
        return false;
    }
    ends.push_back({points.size(), closed, part});
    return true;
}

void add_layer(LayerFile& file, RawLayer& raw, std::uint64_t index, double z, double bottom, double top,
               ReadLimits& limits) {
    const auto location = [&] {
        return raw.location.empty() ? fmt::format("layer {}", index) : raw.location;
    };
    for (LayerPart& part : file.parts)
        limits.make_room(part.layers, 1, location);
    limits.add_bytes_at(file.parts.size() * (of_empty_layer + sizeof(PointArray)), location);
    // Until `raw` is freed there are two copies of its contents, and a third one of contours while they are
    // put into normal form.
    constexpr std::uint64_t of_contour = 64;
    const std::uint64_t copies =
        (2 * raw.points.size() + raw.hatches.size()) * sizeof(Point2) + raw.ends.size() * of_contour;
    limits.add_bytes_at(copies, location);
    assert(raw.ends.empty() || raw.ends.back().end <= raw.points.size());
    assert(raw.hatch_ends.empty() || raw.hatch_ends.back().end <= raw.hatches.size());
    std::vector<PartOfLayer> parts(file.parts.size());
    for_pieces(raw.ends, [&](std::size_t begin, const RawLayer::Contour& contour) {
        assert(contour.part < parts.size() && begin <= contour.end);
        PartOfLayer& part = parts[contour.part];
        part.points += contour.end - begin;
        part.contours += 1;
        part.layer.rings += contour.closed ? 1 : 0;
    });
    for_pieces(raw.hatch_ends, [&](std::size_t begin, const RawLayer::Hatches& hatches) {
        parts[hatches.part].hatches += hatches.end - begin;
    });
    std::vector<std::vector<Point2>> points(parts.size());
    std::vector<std::vector<Point2>> hatches(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        points[i].reserve(parts[i].points);
        hatches[i].reserve(parts[i].hatches);
        parts[i].layer.offsets.reserve(parts[i].contours + 1);
    }
    for (const bool closed : {true, false})
        for_pieces(raw.ends, [&](std::size_t begin, const RawLayer::Contour& contour) {
            if (contour.closed != closed)
                return;
            append(points[contour.part], std::span(raw.points).subspan(begin, contour.end - begin));
            parts[contour.part].layer.offsets.push_back(points[contour.part].size());
        });
    for_pieces(raw.hatch_ends, [&](std::size_t begin, const RawLayer::Hatches& some) {
        append(hatches[some.part], std::span(raw.hatches).subspan(begin, some.end - begin));
    });
    // Layers that follow still need the height, so `raw` itself stays.
    let_go(raw.points);
    let_go(raw.ends);
    let_go(raw.hatches);
    let_go(raw.hatch_ends);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Layer& layer = parts[i].layer;
        assert(layer.offsets.back() == points[i].size() && layer.rings <= layer.contours());
        layer.index = index;
        layer.z = z;
        layer.bottom = bottom;
        layer.top = top;
        if (!points[i].empty())
            layer.points = PointArray(std::move(points[i]));
        LayerPart& to = file.parts[i];
        if (!hatches[i].empty() || !to.hatches.empty()) {
            to.hatches.resize(to.layers.size());
            to.hatches.emplace_back(std::move(hatches[i]));
        }
        to.layers.push_back(to.exposure ? std::move(layer) : normal_form(std::move(layer)));
    }
    limits.give_back(0, copies);
}

void add_layers_by_tops(LayerFile& file, std::span<RawLayer> layers, double bottom, ReadLimits& limits) {
    report_changed_order(layers, file);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const double top = layers[i].z;
        add_layer(file, layers[i], i, bottom + (top - bottom) / 2, bottom, top, limits);
        bottom = top;
    }
}

void add_layers_by_bottoms(LayerFile& file, std::span<RawLayer> layers, double top, ReadLimits& limits) {
    report_changed_order(layers, file);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const double bottom = layers[i].z;
        const double end = i + 1 < layers.size() ? layers[i + 1].z : top;
        add_layer(file, layers[i], i, bottom + (end - bottom) / 2, bottom, end, limits);
    }
}

void check_part_planes(const LayerFile& file, std::uint64_t planes, std::uint64_t bytes) {
    // About two thousand small stacked parts in a file of 200 KB can have this many layers. They take a
    // gigabyte, which counts towards the memory limit.
    constexpr std::uint64_t never_too_many = std::uint64_t{1} << 22;
    const std::uint64_t most = std::max(never_too_many, bytes);
    if (file.parts.size() > most / std::max<std::uint64_t>(planes, 1))
        throw Error(ErrorKind::input,
                    fmt::format("{}: found {} parts on {} planes in {} bytes; that is more empty layers than "
                                "anything else",
                                file.path, file.parts.size(), planes, bytes));
}

void RawLayer::append(const RawLayer& other) {
    const std::size_t contours = ends.size();
    const std::size_t had_points = points.size();
    points.insert(points.end(), other.points.begin(), other.points.end());
    for (const auto& [end, closed, part] : other.ends)
        ends.push_back({had_points + end, closed, part});
    const std::size_t had_hatches = hatches.size();
    hatches.insert(hatches.end(), other.hatches.begin(), other.hatches.end());
    for (const auto& [end, part, behind] : other.hatch_ends)
        hatch_ends.push_back({had_hatches + end, part, contours + behind});
    drawn = drawn || other.drawn;
}

void sort_by_height(std::vector<RawLayer>& layers, std::vector<std::string>& warnings) {
    sort_by_height(layers, warnings, [](const RawLayer& a, const RawLayer& b) { return a.z == b.z; });
}

} // namespace lamella
