#pragma once

// Checks materials, colours and textures of a 3MF model. They are not used, but violations are remarks, which
// are errors for strict callers.

#include "container/xml.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace lamella {

/// Checks the groups of properties by the rules of the Materials and Properties Extension.
class ThreeMfProperties {
  public:
    /// Checks an element in <resources>, at any depth; `id` is that of a resource. Returns a description of
    /// the violation, if there is one.
    [[nodiscard]] std::optional<std::string> check(XmlName name, const XmlAttributes& attributes,
                                                   std::optional<std::uint32_t> id);

  private:
    enum class Kind { base, composite, color, texture, texture_group, multi, other };

    [[nodiscard]] Kind kind_of(std::string_view id) const;
    [[nodiscard]] std::optional<std::string> check_multi(const XmlAttributes& attributes) const;

    std::map<std::uint32_t, Kind> kinds_;
};

} // namespace lamella
