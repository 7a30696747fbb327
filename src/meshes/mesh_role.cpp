#include "lamella/meshes/mesh_role.hpp"

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

namespace lamella {

namespace {

constexpr std::array role_rows = {
    MeshRoleRow{MeshRole::part, "part", "parts", "part", false},
    MeshRoleRow{MeshRole::support, "support", "supports", "support", true},
    MeshRoleRow{MeshRole::negative, "negative volume", "negative volumes", "negative", false},
    MeshRoleRow{MeshRole::modifier, "modifier", "modifiers", "modifier", true},
    MeshRoleRow{MeshRole::support_blocker, "support blocker", "support blockers", "support-blocker", true},
    MeshRoleRow{MeshRole::support_enforcer, "support enforcer", "support enforcers", "support-enforcer",
                true},
    MeshRoleRow{MeshRole::surface, "surface", "surfaces", "surface", true},
    MeshRoleRow{MeshRole::other, "object of type other", "objects of type other", "other", true},
};

std::string all_words() {
    std::string words;
    for (const MeshRoleRow& row : role_rows)
        if (row.role != MeshRole::part)
            words.append(words.empty() ? "" : ", ").append(row.word);
    return words;
}

} // namespace

std::span<const MeshRoleRow> mesh_roles() noexcept {
    return role_rows;
}

const MeshRoleRow& row_of(MeshRole role) noexcept {
    return role_rows[static_cast<std::size_t>(role)];
}

MeshRoles roles_named(std::string_view words) {
    MeshRoles roles;
    while (!words.empty()) {
        const std::string_view word = words.substr(0, words.find(','));
        words.remove_prefix(std::min(words.size(), word.size() + 1));
        const auto* const row =
            std::find_if(role_rows.begin(), role_rows.end(), [&](const MeshRoleRow& known) {
                return known.role != MeshRole::part && known.word == word;
            });
        if (row == role_rows.end())
            throw Error(ErrorKind::usage,
                        fmt::format("found '{}', expected one of {}, or several with commas between them",
                                    word.substr(0, 200), all_words()));
        roles.add(row->role);
    }
    return roles;
}

} // namespace lamella
