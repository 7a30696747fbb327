#include "jobs/part_overlaps.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/polygon/boolean.hpp"

#include "contour/box2.hpp"
#include "core/naming.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace lamella {
namespace {

/// The rings of a part on a plane.
struct Placed {
    Box2 box;
    std::size_t part;
};

/// Returns pairs of parts whose boxes overlap, in ascending order; the first part of a pair has the smaller
/// index.
std::vector<std::pair<std::size_t, std::size_t>> pairs_of(std::span<const Layer> parts,
                                                          const std::vector<bool>& supports) {
    std::vector<Placed> placed;
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (parts[i].rings > 0)
            placed.push_back({box_of(parts[i].points.span().first(parts[i].offsets[parts[i].rings])), i});
    std::sort(placed.begin(), placed.end(),
              [](const Placed& a, const Placed& b) { return a.box.x0 < b.box.x0; });
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < placed.size(); ++i)
        for (std::size_t k = i + 1; k < placed.size() && placed[k].box.x0 < placed[i].box.x1; ++k) {
            const Box2& a = placed[i].box;
            const Box2& b = placed[k].box;
            if (a.y0 < b.y1 && b.y0 < a.y1 && supports[placed[i].part] == supports[placed[k].part])
                pairs.push_back(std::minmax(placed[i].part, placed[k].part));
        }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

} // namespace

UnitedParts unite_overlapping_parts(std::span<const Layer> parts, std::span<const std::uint32_t> objects,
                                    const std::vector<bool>& supports, const LayerLimits& limits,
                                    std::span<const std::string> names) {
    UnitedParts united{{parts.begin(), parts.end()},
                       std::vector<double>(parts.size(), 0),
                       std::vector<bool>(parts.size(), false)};
    std::vector<std::size_t> owners(parts.size()); // the part that has the material of each part
    std::iota(owners.begin(), owners.end(), std::size_t{0});
    const auto owner_of = [&owners](std::size_t part) {
        while (owners[part] != part)
            part = owners[part] = owners[owners[part]];
        return part;
    };
    const auto combined = [&](std::size_t part, const Layer& a, const Layer& b, BooleanOperation operation) {
        return naming(part < names.size() ? names[part] : std::string(),
                      [&] { return combine(a, b, operation, limits); });
    };
    const auto overlap = [&](std::size_t part, const Layer& a, const Layer& b) {
        return measure(combined(part, a, b, BooleanOperation::intersect)).area_mm2;
    };
    const std::vector<std::pair<std::size_t, std::size_t>> pairs = pairs_of(parts, supports);
    for (const auto& [one, other] : pairs)
        if (objects[one] == objects[other] && owner_of(one) != owner_of(other) &&
            overlap(other, parts[one], parts[other]) > 0)
            owners[std::max(owner_of(one), owner_of(other))] = std::min(owner_of(one), owner_of(other));
    for (std::size_t part = 0; part < parts.size(); ++part) {
        const std::size_t owner = owner_of(part);
        if (owner == part)
            continue;
        united.changed[owner] = united.changed[part] = true;
        united.parts[owner] = combined(part, united.parts[owner], parts[part], BooleanOperation::unite);
        united.parts[part] = {.index = parts[part].index,
                              .z = parts[part].z,
                              .bottom = parts[part].bottom,
                              .top = parts[part].top};
    }
    std::vector<std::pair<std::size_t, std::size_t>> separate;
    for (const auto& [one, other] : pairs)
        if (objects[one] != objects[other])
            separate.push_back(std::minmax(owner_of(one), owner_of(other)));
    std::sort(separate.begin(), separate.end());
    separate.erase(std::unique(separate.begin(), separate.end()), separate.end());
    for (const auto& [one, other] : separate)
        united.overlaps_mm2[other] += overlap(other, united.parts[one], united.parts[other]);
    return united;
}

} // namespace lamella
