#include "read/layer_assembly.hpp"

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lamella {

void Oddity::say(std::vector<std::string>& warnings) const {
    if (count_ != 0)
        warnings.push_back(fmt::format("{} {} (first at {})", count_, what_, first_));
}

bool RawLayer::end_clean_contour(std::size_t begin, bool closed, std::uint32_t part) {
    const auto contour = points.begin() + static_cast<std::ptrdiff_t>(begin);
    auto end = std::unique(contour, points.end());
    while (closed && end - contour > 1 && *(end - 1) == *contour)
        --end;
    points.erase(end, points.end());
    if (points.size() - begin < (closed ? 3U : 2U)) {
        points.resize(begin);
        return false;
    }
    end_contour(closed, part);
    return true;
}

void add_layer(LayerFile& file, RawLayer& raw, std::uint64_t index, double z, double bottom, double top,
               ReadLimits& limits) {
    const auto place = [&] {
        return raw.place.empty() ? fmt::format("layer {}", index) : raw.place;
    };
    for (LayerPart& part : file.parts)
        limits.make_room(part.layers, 1, place);
    limits.add_bytes_at(file.parts.size() * of_empty_layer, place);
    std::vector<LayerBuilder> builders(file.parts.size());
    std::size_t next = 0;
    for (const auto& [end, closed, part] : raw.ends) {
        LayerBuilder& builder = builders[part];
        for (; next < end; ++next)
            builder.add_point(raw.points[next]);
        builder.end_contour(closed);
    }
    std::vector<std::vector<Point2>> hatches(file.parts.size());
    next = 0;
    for (const auto& [end, part] : raw.hatch_ends)
        for (; next < end; ++next)
            hatches[part].push_back({raw.hatches[next].x + 0.0, raw.hatches[next].y + 0.0});
    for (std::size_t part = 0; part < builders.size(); ++part) {
        LayerPart& to = file.parts[part];
        Layer& layer =
            to.layers.emplace_back(to.exposure ? builders[part].finish_as_added(index, z, bottom, top)
                                               : builders[part].finish(index, z, bottom, top));
        if (!hatches[part].empty())
            layer.hatches = PointArray(std::move(hatches[part]));
    }
    // Those that come after need the height.
    raw.points = {};
    raw.ends = {};
    raw.hatches = {};
    raw.hatch_ends = {};
}

void check_part_planes(const LayerFile& file, std::uint64_t planes, std::uint64_t bytes) {
    constexpr std::uint64_t never_too_many = std::uint64_t{1} << 20;
    const std::uint64_t most = std::max(never_too_many, bytes);
    if (file.parts.size() > most / std::max<std::uint64_t>(planes, 1))
        throw Error(ErrorKind::input,
                    fmt::format("{}: found {} parts on {} planes in {} bytes; that is more empty layers than "
                                "anything else",
                                file.path, file.parts.size(), planes, bytes));
}

void sort_by_height(std::vector<RawLayer>& layers, std::vector<std::string>& warnings) {
    const auto below = [](const RawLayer& a, const RawLayer& b) {
        return a.z < b.z;
    };
    if (!std::is_sorted(layers.begin(), layers.end(), below)) {
        const auto first = std::is_sorted_until(layers.begin(), layers.end(), below);
        warnings.push_back(
            fmt::format("layers do not ascend: z = {} mm follows z = {} mm ({}); they were sorted", first->z,
                        std::prev(first)->z, first->place));
        std::stable_sort(layers.begin(), layers.end(), below);
    }
    std::size_t kept = 0;
    std::size_t joined = 0;
    for (std::size_t i = 1; i < layers.size(); ++i) {
        if (layers[i].z != layers[kept].z) {
            if (++kept != i)
                layers[kept] = std::move(layers[i]);
            continue;
        }
        RawLayer& into = layers[kept];
        const std::size_t points = into.points.size();
        into.points.insert(into.points.end(), layers[i].points.begin(), layers[i].points.end());
        for (const auto& [end, closed, part] : layers[i].ends)
            into.ends.push_back({points + end, closed, part});
        const std::size_t hatches = into.hatches.size();
        into.hatches.insert(into.hatches.end(), layers[i].hatches.begin(), layers[i].hatches.end());
        for (const auto& [end, part] : layers[i].hatch_ends)
            into.hatch_ends.push_back({hatches + end, part});
        ++joined;
    }
    if (!layers.empty())
        layers.resize(kept + 1);
    if (joined != 0)
        warnings.push_back(
            fmt::format("{} layers have the height of the one before; they were joined", joined));
}

} // namespace lamella
