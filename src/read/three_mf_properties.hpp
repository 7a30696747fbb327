#pragma once

// Materials, colours and textures of a 3MF model: nothing of them is read, but a strict caller hears what is
// wrong with them.

#include "container/xml.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace lamella {

/// Holds the groups of properties against the rules of the Materials and Properties Extension.
class ThreeMfProperties {
  public:
    /// Looks at an element directly in <resources>, or further down; `id` is that of a resource. Says what is
    /// wrong, when something is.
    [[nodiscard]] std::optional<std::string> check(XmlName name, const XmlAttributes& attributes,
                                                   std::optional<std::uint32_t> id);

  private:
    enum class Kind { base, composite, color, texture, texture_group, multi, other };

    [[nodiscard]] Kind kind_of(std::string_view id) const;
    [[nodiscard]] std::optional<std::string> check_multi(const XmlAttributes& attributes) const;

    std::map<std::uint32_t, Kind> kinds_;
};

} // namespace lamella
