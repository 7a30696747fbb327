#include "lamella/core/error.hpp"

#include "raster/grey_values.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace lamella {
namespace {

GreyValues values_of(std::vector<GreyPoint> curve) {
    const RasterOptions options{.grey_curve = std::move(curve)};
    check_grey(options);
    return grey_values(options);
}

TEST(GreyValues, AreTheCoverageUnlessBent) {
    const GreyValues plain = grey_values({});
    for (std::size_t i = 0; i < plain.size(); ++i)
        EXPECT_EQ(plain[i], i);
    for (const double gamma : {0.5, 2.2})
        for (std::size_t i = 0; i < plain.size(); ++i)
            EXPECT_NEAR(grey_values({.gamma = gamma})[i], 255 * std::pow(static_cast<double>(i) / 255, gamma),
                        0.5);
}

TEST(GreyValues, LieOnTheCurveAndBetweenItsPointsInProportion) {
    const GreyValues bent = values_of({{0.2, 102}, {0.6, 204}});
    EXPECT_EQ(bent[0], 0);
    EXPECT_EQ(bent[51], 102);
    EXPECT_EQ(bent[102], 153) << "half-way";
    EXPECT_EQ(bent[153], 204);
    EXPECT_EQ(bent[204], 230) << "half-way to white";
    EXPECT_EQ(bent[255], 255);
    EXPECT_EQ(values_of({{0, 0}, {1, 255}}), grey_values({}));
}

TEST(GreyValues, BeginAtTheDarkestGreyWhereThereIsAnyMaterial) {
    const GreyValues from = values_of({{0, 60}});
    EXPECT_EQ(from[0], 0) << "no material, no light";
    EXPECT_EQ(from[1], 61);
    EXPECT_EQ(from[255], 255);
}

TEST(GreyValues, AreRefusedWithTheirReason) {
    const auto message = [](const RasterOptions& options) {
        try {
            check_grey(options);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage);
            return std::string(error.what());
        }
        return std::string("none");
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(message({.gamma = 0}).find("gamma of 0"), std::string::npos);
    EXPECT_NE(message({.gamma = nan}).find("gamma of nan"), std::string::npos);
    EXPECT_NE(message({.gamma = 2, .grey_curve = {{0, 60}}}).find("exclude each other"), std::string::npos);
    EXPECT_NE(message({.grey_curve = {{1.5, 60}}}).find("point 1.5:60"), std::string::npos);
    EXPECT_NE(message({.grey_curve = {{0.5, 256}}}).find("0 to 255"), std::string::npos);
    EXPECT_NE(message({.grey_curve = {{nan, 6}}}).find("0 to 1"), std::string::npos);
    EXPECT_NE(message({.grey_curve = {{0.5, 60}, {0.5, 70}}}).find("0.5 after 0.5"), std::string::npos);
    EXPECT_NE(message({.grey_curve = {{1, 200}}}).find("leave this point out"), std::string::npos);
    EXPECT_EQ(message({.grey_curve = {{0, 1}, {1, 255}}}), "none");
}

} // namespace
} // namespace lamella
