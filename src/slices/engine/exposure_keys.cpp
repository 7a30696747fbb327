#include "slices/engine/exposure_keys.hpp"

#include "core/bit_cast.hpp"

#include <array>
#include <cassert>
#include <cstdint>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

namespace lamella {

namespace {

/// Returns the properties of an exposure except its part. Numbers are compared by their bits, since NaN has
/// no order; -0 becomes 0.
auto key_of(const Exposure& exposure) {
    const auto bits = [](auto... numbers) {
        return std::array{lamella::bit_cast<std::uint64_t>(numbers + 0.0)...};
    };
    const auto& [name, power, speed, jump_speed, focus, spot, mark_delay, jump_delay] = exposure.parameters;
    return std::tuple(exposure.region, exposure.kind, exposure.contour, std::string_view(name),
                      bits(power, speed, jump_speed, focus, spot, mark_delay, jump_delay));
}

/// Returns the index of an item in a list, and appends it if it is absent. `positions` maps the keys of
/// present items to their indices.
template <class Key, class T>
std::size_t place_of(std::map<Key, std::size_t>& positions, const Key& key, std::vector<T>& known,
                     const T& item) {
    const auto [position, is_new] = positions.try_emplace(key, known.size());
    if (is_new)
        known.push_back(item);
    return position->second;
}

} // namespace

ExposureKeys::ExposureKeys(std::span<const PartInfo> all) {
    std::map<decltype(key_of(Exposure{})), std::size_t> exposure_keys_of;
    std::map<std::string_view, std::vector<std::size_t>> positions; // indices in `parts`, by label
    std::map<std::pair<std::string_view, std::optional<std::size_t>>, std::size_t> times;
    for (const PartInfo& part : all) {
        const std::string& label = part.exposure ? part.exposure->part : part.label;
        Key& key = keys.emplace_back();
        if (part.exposure)
            key.exposure = place_of(exposure_keys_of, key_of(*part.exposure), exposures, *part.exposure);
        // If a part already has an equal exposure, this one belongs to the next part of the same label.
        const std::size_t number = times[{label, key.exposure}]++;
        std::vector<std::size_t>& same = positions[label];
        if (number == same.size()) {
            same.push_back(parts.size());
            parts.push_back(label);
        }
        key.part = same[number];
    }
    assert(keys.size() == all.size());
    assert(parts.size() <= all.size() && exposures.size() <= all.size());
}

} // namespace lamella
