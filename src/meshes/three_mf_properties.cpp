// The 3MF Materials and Properties Extension 1.x, chapters 2 to 6.

#include "meshes/three_mf_properties.hpp"

#include "container/decimal_text.hpp"
#include "meshes/three_mf_terms.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lamella {

namespace {

bool has(const XmlAttributes& attributes, std::string_view name) {
    return attributes.find(name).data() != nullptr;
}

} // namespace

ThreeMfProperties::Kind ThreeMfProperties::kind_of(std::string_view id) const {
    std::uint32_t number = 0;
    if (read_index(id.data(), id.data() + id.size(), number) == nullptr)
        return Kind::other;
    const auto found = kinds_.find(number);
    return found == kinds_.end() ? Kind::other : found->second;
}

std::optional<std::string> ThreeMfProperties::check(XmlName name, const XmlAttributes& attributes,
                                                    std::optional<std::uint32_t> id) {
    const auto is = [&](std::string_view element) {
        return name.local == element && name.space == three_mf::materials;
    };
    const auto add = [&](Kind kind) {
        if (id)
            kinds_.emplace(*id, kind);
    };
    if (name == XmlName{three_mf::core, "basematerials"}) {
        add(Kind::base);
    } else if (is("color")) {
        if (!has(attributes, "color"))
            return "found a colour without its value";
    } else if (is("colorgroup")) {
        add(Kind::color);
    } else if (is("texture2d")) {
        add(Kind::texture);
        if (!has(attributes, "path"))
            return "found a texture without a path";
        const std::string_view type = attributes.find("contenttype");
        if (type != "image/png" && type != "image/jpeg")
            return "found a texture whose content is neither image/png nor image/jpeg";
    } else if (is("texture2dgroup")) {
        add(Kind::texture_group);
        if (kind_of(trimmed(attributes.find("texid"))) != Kind::texture)
            return "found a group of texture coordinates without a texture";
    } else if (is("compositematerials")) {
        add(Kind::composite);
        if (kind_of(trimmed(attributes.find("matid"))) != Kind::base || !has(attributes, "matindices"))
            return "found composite materials that do not say which base materials they consist of";
    } else if (is("multiproperties")) {
        add(Kind::multi);
        return check_multi(attributes);
    }
    return std::nullopt;
}

std::optional<std::string> ThreeMfProperties::check_multi(const XmlAttributes& attributes) const {
    std::string_view ids = trimmed(attributes.find("pids"));
    if (ids.empty())
        return "found multiproperties without pids";
    int materials_count = 0;
    int colors = 0;
    while (!ids.empty()) {
        const std::size_t end = std::min(ids.find_first_of(" \t\r\n"), ids.size());
        const Kind kind = kind_of(ids.substr(0, end));
        ids = trimmed(ids.substr(end));
        materials_count += kind == Kind::base || kind == Kind::composite ? 1 : 0;
        colors += kind == Kind::color ? 1 : 0;
        if (kind == Kind::multi)
            return "found multiproperties that consist of multiproperties";
    }
    if (materials_count > 1 || colors > 1)
        return "found multiproperties of more than one material or more than one group of colours";
    return std::nullopt;
}

} // namespace lamella
