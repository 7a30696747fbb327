#include "lamella/core/error.hpp"
#include "lamella/meshes/mesh_role.hpp"

#include "fixtures/expect_error.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>

namespace lamella {
namespace {

TEST(MeshRole, RowsStandInTheOrderOfTheRoles) {
    for (std::size_t i = 0; i < mesh_roles().size(); ++i)
        EXPECT_EQ(static_cast<std::size_t>(mesh_roles()[i].role), i);
}

TEST(MeshRole, EachIsFoundByItsWord) {
    for (const MeshRoleRow& row : mesh_roles())
        if (row.role != MeshRole::part) {
            EXPECT_EQ(roles_named(row.word), MeshRoles{row.role});
        }
    EXPECT_EQ(roles_named(""), MeshRoles{});
    EXPECT_EQ(roles_named("support-blocker,modifier"),
              (MeshRoles{MeshRole::modifier, MeshRole::support_blocker}));
    for (const char* words : {"part", "thing", "support modifier", "modifier,,support"}) {
        EXPECT_NE(test::error_of(ErrorKind::usage, [&] { static_cast<void>(roles_named(words)); })
                      .find("expected one of support, negative, modifier"),
                  std::string::npos);
    }
}

} // namespace
} // namespace lamella
