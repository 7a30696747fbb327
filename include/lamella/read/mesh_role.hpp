#pragma once

// What a file marks an object or a volume as.

#include "lamella/core/api.hpp"

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>

LAMELLA_API_BEGIN
namespace lamella {

enum class MeshRole : std::uint8_t {
    part,     ///< material
    support,  ///< holds parts while they are made
    negative, ///< is subtracted from the parts of its object
    modifier, ///< changes settings where it overlaps parts
    support_blocker,
    support_enforcer,
    surface, ///< bounds no solid
    other,   ///< is not to be made
};

/// How a role is named, and what readers do with a body that has it, unless they are asked to include it.
struct MeshRoleRow {
    MeshRole role;
    std::string_view name; ///< of one, such as "support blocker"
    std::string_view many;
    std::string_view word; ///< for options: "support-blocker"
    bool left_out;
};

/// One row for each role, in the order of the roles.
[[nodiscard]] std::span<const MeshRoleRow> mesh_roles() noexcept;
[[nodiscard]] const MeshRoleRow& row_of(MeshRole role) noexcept;

/// A set of roles.
class MeshRoles {
  public:
    constexpr MeshRoles() = default;
    constexpr MeshRoles(std::initializer_list<MeshRole> roles) {
        for (const MeshRole role : roles)
            add(role);
    }

    constexpr void add(MeshRole role) noexcept { bits_ |= 1U << static_cast<unsigned>(role); }
    [[nodiscard]] constexpr bool contains(MeshRole role) const noexcept {
        return (bits_ >> static_cast<unsigned>(role) & 1U) != 0;
    }
    friend constexpr bool operator==(MeshRoles, MeshRoles) noexcept = default;

  private:
    std::uint32_t bits_ = 0;
};

/// The roles of a list of their words, such as "modifier,support-blocker"; none for "". Throws Error{usage}
/// that lists the words where one is not known, and for "part", which is always included.
[[nodiscard]] MeshRoles roles_named(std::string_view words);

} // namespace lamella
LAMELLA_API_END
