#include "lamella/core/suggest.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lamella {
namespace {

TEST(Suggest, FindsTheNameThatWasMistyped) {
    const std::vector<std::string> names{"slice", "convert", "verify"};
    EXPECT_EQ(nearest("slcie", names), "slice");
    EXPECT_EQ(nearest("conv", names), "convert");
    EXPECT_EQ(nearest("merge", names), "");
    EXPECT_EQ(did_you_mean("verfy", names), "; did you mean verify?");
    EXPECT_EQ(did_you_mean(std::string(65, 'x'), {}), "");
}

} // namespace
} // namespace lamella
