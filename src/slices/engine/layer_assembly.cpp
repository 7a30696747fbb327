#include "slices/engine/layer_assembly.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "contour/plane_sums.hpp"
#include "core/counted.hpp"
#include "core/executor.hpp"
#include "core/let_go.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>

namespace lamella {

namespace {

/// Returns whether the scan vectors have the order in which a layer stores them: by part, and in each part
/// first rings, then chains, then hatches. The order of contours of parts without an exposure does not
/// matter.
bool is_in_order(const RawLayer& raw, const LayerFile& file) {
    std::tuple<std::uint32_t, RawLayer::Run::Kind> last{};
    for (const RawLayer::Run& run : raw.runs) {
        if (!file.parts[run.part].exposure)
            continue;
        if (last > std::tuple(run.part, run.kind))
            return false;
        last = {run.part, run.kind};
    }
    return true;
}

/// Warns if the order of vectors changes, because machines execute them in this order.
void report_changed_order(std::span<const RawLayer> layers, LayerFile& file, const Execution& execution) {
    if (std::none_of(file.parts.begin(), file.parts.end(),
                     [](const PartInfo& part) { return part.exposure.has_value(); }))
        return;
    std::vector<char> in_order(layers.size());
    Executor(execution).for_chunks(layers.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
        in_order[i] = is_in_order(layers[i], file) ? 1 : 0;
    });
    std::size_t changed = 0;
    double lowest = 0;
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (in_order[i] == 0 && changed++ == 0)
            lowest = layers[i].z;
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

/// Makes the layers of a plane, one for each part, and frees the contours and hatches of `plane`. Those of
/// parts that are not `exposed` are in normal form.
template <class Location>
Plane make_layers(const PlacedLayer& plane, const std::vector<bool>& exposed, ReadLimits& limits,
                  const Location& location) {
    RawLayer& raw = *plane.raw;
    // Until `raw` is freed there are two copies of its contents, and a third one of contours while they are
    // put into normal form.
    constexpr std::uint64_t of_contour = 64;
    const std::uint64_t copies =
        (2 * raw.points.size() + raw.hatches.size()) * sizeof(Point2) + raw.ends.size() * of_contour;
    limits.add_bytes_at(copies, location);
    assert(raw.ends.empty() || raw.ends.back().end <= raw.points.size());
    assert(raw.hatch_ends.empty() || raw.hatch_ends.back().end <= raw.hatches.size());
    std::vector<PartOfLayer> parts(exposed.size());
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
    Plane layers;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Layer& layer = parts[i].layer;
        assert(layer.offsets.back() == points[i].size() && layer.rings <= layer.contours());
        layer.index = plane.index;
        layer.z = plane.z;
        layer.bottom = plane.bottom;
        layer.top = plane.top;
        if (!points[i].empty())
            layer.points = PointArray(std::move(points[i]));
        layers.add(exposed[i] ? std::move(layer) : normal_form(std::move(layer)),
                   hatches[i].empty() ? PointArray() : PointArray(std::move(hatches[i])));
    }
    limits.give_back(0, copies);
    return layers;
}

std::vector<bool> exposed_parts(const LayerFile& file) {
    std::vector<bool> exposed;
    for (const PartInfo& part : file.parts)
        exposed.push_back(part.exposure.has_value());
    return exposed;
}

/// Returns a function that parses the layers of a plane again.
std::function<Plane(std::size_t)> parsing(std::span<const PlacedLayer> planes, std::vector<bool> exposed,
                                          const ReadLimits& limits, ParseLayer parse) {
    std::vector<std::vector<std::size_t>> begins; // of each plane
    for (const PlacedLayer& plane : planes) {
        begins.emplace_back().push_back(plane.raw->begin);
        begins.back().insert(begins.back().end(), plane.raw->joined.begin(), plane.raw->joined.end());
    }
    return [begins = std::move(begins), exposed = std::move(exposed), &limits,
            parse = std::move(parse)](std::size_t position) {
        ReadLimits own(limits); // what it counts is freed with the plane
        own.keep_in_memory();
        const std::vector<std::size_t>& layers = begins[position];
        RawLayer raw = parse(layers.front(), own);
        for (const std::size_t begin : std::span(layers).subspan(1))
            raw.append(parse(begin, own));
        return make_layers({&raw}, exposed, own, [&] { return fmt::format("layer {}", position); });
    };
}

} // namespace

LayerFile layer_file(const std::string& name, std::string_view format, double units_mm) {
    LayerFile file;
    file.path = name;
    file.format = format;
    file.units_mm = units_mm;
    return file;
}

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

void append_to(const Findings& found, std::vector<std::string>& warnings) {
    for (std::string& text : found.texts())
        warnings.push_back(std::move(text));
}

PartInfo VectorParts::of(std::int64_t part, const std::string& label, std::optional<Exposure> exposure) {
    const auto [known, is_new] = known_.try_emplace(part);
    if (is_new)
        known->second = names.of(labels.of(label));
    PartInfo info{.label = known->second, .box = {}, .exposure = std::move(exposure)};
    if (info.exposure) {
        info.exposure->part = info.label;
        info.label = info.exposure->label();
    }
    return info;
}

bool RawLayer::keep_contour(bool closed, std::uint32_t part) {
    const std::size_t first = contour_begin();
    const auto contour = points.begin() + static_cast<std::ptrdiff_t>(first);
    auto end = std::unique(contour, points.end());
    while (closed && end - contour > 1 && *(end - 1) == *contour)
        --end;
    points.erase(end, points.end());
    if (points.size() - first < (closed ? 3U : 2U)) {
        points.resize(first);
        return false;
    }
    ends.push_back({points.size(), closed, part});
    return true;
}

void RawLayer::end_layer(ReadLimits& limits) {
    assert(runs.empty());
    const auto add = [&](std::uint32_t part, Run::Kind kind, std::size_t from, std::size_t to) {
        if (!runs.empty() && runs.back().part == part && runs.back().kind == kind)
            runs.back().end = to;
        else
            runs.push_back({part, kind, from, to, {}});
    };
    std::size_t contour = 0;
    const auto add_contours = [&](std::size_t up_to) {
        for (; contour < up_to; ++contour)
            add(ends[contour].part, ends[contour].closed ? Run::Kind::ring : Run::Kind::chain,
                contour == 0 ? 0 : ends[contour - 1].end, ends[contour].end);
    };
    for_pieces(hatch_ends, [&](std::size_t from, const Hatches& lines) {
        add_contours(lines.behind);
        if (lines.end != from)
            add(lines.part, Run::Kind::hatch, from, lines.end);
    });
    add_contours(ends.size());
    for (Run& run : runs)
        run.box = PlaneSums::flat_box(std::span(run.kind == Run::Kind::hatch ? hatches : points)
                                          .subspan(run.begin, run.end - run.begin));
    limits.add_bytes(runs.size() * sizeof(Run), location);
    if (limits.in_memory())
        return;
    limits.give_back(0, (points.capacity() + hatches.capacity()) * sizeof(Point2) +
                            ends.capacity() * sizeof(Contour) + hatch_ends.capacity() * sizeof(Hatches));
    let_go(points);
    let_go(ends);
    let_go(hatches);
    let_go(hatch_ends);
}

void RawLayer::renumber(std::span<const std::uint32_t> numbers) {
    const auto renumber_all = [&](auto& items) {
        for (auto& item : items) {
            assert(item.part < numbers.size());
            item.part = numbers[item.part];
        }
    };
    renumber_all(ends);
    renumber_all(hatch_ends);
    renumber_all(runs);
}

void add_layers(LayerFile& file, std::span<const PlacedLayer> planes, ReadLimits& limits,
                const Execution& execution, ParseLayer parse) {
    const std::size_t parts = limits.in_memory() ? file.parts.size() : 1;
    limits.add_bytes(planes.size() * (parts * (sizeof(Layer) + of_empty_layer + sizeof(PointArray)) +
                                      sizeof(Layer) + sizeof(PlaneContent)),
                     planes.empty() ? std::string_view() : planes.front().raw->location);
    PlaneSums sums(file.parts.size());
    std::uint64_t largest = 0; // number of points
    for (const PlacedLayer& plane : planes) {
        file.planes.push_back({.index = plane.index, .z = plane.z, .bottom = plane.bottom, .top = plane.top});
        PlaneContent& content = file.contents.emplace_back();
        for (const RawLayer::Run& run : plane.raw->runs) {
            if (run.kind == RawLayer::Run::Kind::hatch) {
                sums.add_hatches(run.part, run.box, (run.end - run.begin) / 2);
                content.hatch_lines += (run.end - run.begin) / 2;
            } else {
                sums.add_contours(run.part, run.box);
                content.points += run.end - run.begin;
            }
        }
        largest = std::max(largest, content.points + 2 * content.hatch_lines);
    }
    sums.put(file);
    std::vector<bool> exposed = exposed_parts(file);
    if (!limits.in_memory()) {
        file.bytes = limits.bytes();
        file.spare_bytes = limits.bytes_left();
        file.plane_bytes = bytes_of_plane(largest);
        file.make = parsing(planes, std::move(exposed), limits, std::move(parse));
        return;
    }
    std::vector<Plane> kept(planes.size());
    Executor executor(execution);
    executor.for_chunks(planes.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
        kept[i] = make_layers(planes[i], exposed, limits, [&] {
            const std::string& location = planes[i].raw->location;
            return location.empty() ? fmt::format("layer {}", planes[i].index) : location;
        });
    });
    executor.check_cancelled();
    keep_planes(file, std::move(kept));
}

void add_layers_by_tops(LayerFile& file, std::span<RawLayer> layers, double bottom, ReadLimits& limits,
                        const Execution& execution, ParseLayer parse) {
    report_changed_order(layers, file, execution);
    std::vector<PlacedLayer> planes;
    planes.reserve(layers.size());
    for (RawLayer& raw : layers) {
        const double top = raw.z;
        planes.push_back({&raw, planes.size(), bottom + (top - bottom) / 2, bottom, top});
        bottom = top;
    }
    add_layers(file, planes, limits, execution, std::move(parse));
}

void add_layers_by_bottoms(LayerFile& file, std::span<RawLayer> layers, double top, ReadLimits& limits,
                           const Execution& execution, ParseLayer parse) {
    report_changed_order(layers, file, execution);
    std::vector<PlacedLayer> planes;
    planes.reserve(layers.size());
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const double bottom = layers[i].z;
        const double end = i + 1 < layers.size() ? layers[i + 1].z : top;
        planes.push_back({&layers[i], i, bottom + (end - bottom) / 2, bottom, end});
    }
    add_layers(file, planes, limits, execution, std::move(parse));
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
    joined.push_back(other.begin);
    joined.insert(joined.end(), other.joined.begin(), other.joined.end());
    runs.insert(runs.end(), other.runs.begin(), other.runs.end());
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
