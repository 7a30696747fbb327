#include "lamella/read/file_kind.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace lamella {
namespace {

using namespace std::string_view_literals;

TEST(FileKind, LayersAreToldByTheirFirstWord) {
    for (const std::string_view head :
         {"$$HEADERSTART\n"sv, "// a comment\n$$HEADERSTART"sv, "<?xml version=\"1.0\"?><svg"sv,
          "<?xml version=\"1.0\"?><!-- begins"sv, "-SLCVER 2.0"sv, "{\"layers\": []}"sv,
          "PK\3\4 layers/z.npy"sv, "\xEF\xBB\xBF \r\n<svg>"sv})
        EXPECT_EQ(file_kind(head), FileKind::layers) << head;
}

TEST(FileKind, PackagesMayHoldEither) {
    EXPECT_EQ(file_kind("PK\3\4 3D/3dmodel.model"), FileKind::either);
}

TEST(FileKind, EverythingElseIsAMesh) {
    for (const std::string_view head : {""sv, "  \n"sv, "solid part"sv, "ply\n"sv, "OFF\n"sv, "v 0 0 0\n"sv,
                                        "PK"sv, "<?xml version=\"1.0\"?><amf unit=\"inch\">"sv,
                                        "<!DOCTYPE html><html><svg>"sv, "\x1f\x8b\x08"sv, "$HEADER"sv})
        EXPECT_EQ(file_kind(head), FileKind::mesh) << head;
}

TEST(FileKind, IsSafeOnEveryPrefix) {
    const std::string head = "\xEF\xBB\xBF \n$$HEADERSTART";
    for (std::size_t length = 0; length < 6; ++length)
        EXPECT_EQ(file_kind(std::string_view(head).substr(0, length)), FileKind::mesh) << length;
    EXPECT_EQ(file_kind(head), FileKind::layers);
}

} // namespace
} // namespace lamella
