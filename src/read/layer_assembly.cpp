#include "read/layer_assembly.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lamella {

void Oddity::say(std::vector<std::string>& warnings) const {
    if (count_ != 0)
        warnings.push_back(fmt::format("{} {} (first at {})", count_, what_, first_));
}

Layer make_layer(RawLayer& raw, std::uint64_t index, double z, double bottom, double top) {
    LayerBuilder builder;
    std::size_t next = 0;
    for (const auto& [end, closed] : raw.ends) {
        for (; next < end; ++next)
            builder.add_point(raw.points[next]);
        builder.end_contour(closed);
    }
    raw = {};
    return builder.finish(index, z, bottom, top);
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
        const std::size_t before = into.points.size();
        into.points.insert(into.points.end(), layers[i].points.begin(), layers[i].points.end());
        for (const auto& [end, closed] : layers[i].ends)
            into.ends.emplace_back(before + end, closed);
        ++joined;
    }
    if (!layers.empty())
        layers.resize(kept + 1);
    if (joined != 0)
        warnings.push_back(
            fmt::format("{} layers have the height of the one before; they were joined", joined));
}

} // namespace lamella
