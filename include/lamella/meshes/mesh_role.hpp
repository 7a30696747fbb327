#pragma once

// Roles that a file gives to its objects and volumes.

#include "lamella/core/api.hpp"

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>

LAMELLA_API_BEGIN
namespace lamella {

enum class MeshRole : std::uint8_t {
    part,     ///< material
    support,  ///< supports parts while they are built
    negative, ///< is subtracted from the parts of its object
    modifier, ///< changes settings where it overlaps parts
    support_blocker,
    support_enforcer,
    surface, ///< encloses no solid
    other,   ///< is not to be built
};

/// Names of a role, and whether readers skip bodies that have it.
struct MeshRoleRow {
    MeshRole role;
    std::string_view name; ///< singular, such as "support blocker"
    std::string_view many;
    std::string_view word; ///< for options, such as "support-blocker"
    bool left_out;
};

/// Returns one row for each role, in the order of the roles.
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

/// Returns the roles in a list of words, such as "modifier,support-blocker"; none for "". Throws Error{usage}
/// listing the words if a word is unknown or is "part", which is always included.
[[nodiscard]] MeshRoles roles_named(std::string_view words);

} // namespace lamella
LAMELLA_API_END
