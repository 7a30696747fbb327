#include "write/exposure_keys.hpp"

#include <algorithm>
#include <cassert>
#include <functional>

namespace lamella {

namespace {

bool is_alike(const Exposure& a, const Exposure& b) {
    return a.region == b.region && a.kind == b.kind && a.contour == b.contour && a.parameters == b.parameters;
}

template <class T, class Alike>
std::size_t place_of(std::vector<T>& known, const T& item, const Alike& alike) {
    const auto found = std::find_if(known.begin(), known.end(), [&](const T& k) { return alike(k, item); });
    if (found != known.end())
        return static_cast<std::size_t>(found - known.begin());
    known.push_back(item);
    return known.size() - 1;
}

} // namespace

ExposureKeys::ExposureKeys(std::span<const PartInfo> all) {
    for (const PartInfo& part : all) {
        const std::string& label = part.exposure ? part.exposure->part : part.label;
        Key& key = keys.emplace_back();
        key.part = place_of(parts, label, std::equal_to<>());
        if (part.exposure)
            key.exposure = place_of(exposures, *part.exposure, is_alike);
    }
    assert(keys.size() == all.size());
}

} // namespace lamella
