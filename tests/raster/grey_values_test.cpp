#include "lamella/core/error.hpp"

#include "raster/grey_values.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace lamella {
namespace {

GreyValues curve(const std::vector<GreyPoint>& points) {
    return grey_curve(points);
}

/// Returns the text of the error that the work throws.
template <class Work>
std::string message(const Work& work) {
    try {
        work();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        return error.what();
    }
    return "none";
}

TEST(GreyValues, AreTheCoverageUnlessBent) {
    const GreyValues plain = values_of({});
    for (std::size_t i = 0; i < plain.size(); ++i)
        EXPECT_EQ(plain[i], i);
    for (const double gamma : {0.5, 2.2})
        for (std::size_t i = 0; i < plain.size(); ++i)
            EXPECT_NEAR(values_of({.gamma = gamma})[i], 255 * std::pow(static_cast<double>(i) / 255, gamma),
                        0.5);
}

TEST(GreyValues, LieOnTheCurveAndBetweenItsPointsInProportion) {
    const GreyValues bent = curve({{0.2, 102}, {0.6, 204}});
    EXPECT_EQ(bent[0], 0);
    EXPECT_EQ(bent[51], 102);
    EXPECT_EQ(bent[102], 153) << "half-way";
    EXPECT_EQ(bent[153], 204);
    EXPECT_EQ(bent[204], 230) << "half-way to white";
    EXPECT_EQ(bent[255], 255);
    EXPECT_EQ(curve({{0, 0}, {1, 255}}), values_of({}));
}

TEST(GreyValues, BeginAtTheDarkestGreyWhereThereIsAnyMaterial) {
    const GreyValues from = curve({{0, 60}});
    EXPECT_EQ(from[0], 0) << "no material, no light";
    EXPECT_EQ(from[1], 61);
    EXPECT_EQ(from[255], 255);
}

TEST(GreyValues, AreThoseOfATable) {
    GreyValues table = curve({{0, 100}});
    EXPECT_EQ(values_of({.grey_values = table}), table);
    EXPECT_NO_THROW(check_grey({.grey_values = table}));
    table[255] = 254;
    EXPECT_NE(message([&] { check_grey({.grey_values = table}); }).find("from 0 to 254"), std::string::npos);
}

TEST(GreyValues, AreRefusedWithTheirReason) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto refused = [](const RasterOptions& options) {
        return message([&] { check_grey(options); });
    };
    EXPECT_NE(refused({.gamma = 0}).find("gamma of 0"), std::string::npos);
    EXPECT_NE(refused({.gamma = nan}).find("gamma of nan"), std::string::npos);
    EXPECT_NE(refused({.gamma = 2, .grey_values = curve({{0, 60}})}).find("exclude each other"),
              std::string::npos);
    const auto bent = [](const std::vector<GreyPoint>& points) {
        return message([&] { static_cast<void>(curve(points)); });
    };
    EXPECT_NE(bent({{1.5, 60}}).find("point 1.5:60"), std::string::npos);
    EXPECT_NE(bent({{0.5, 256}}).find("0 to 255"), std::string::npos);
    EXPECT_NE(bent({{nan, 6}}).find("0 to 1"), std::string::npos);
    EXPECT_NE(bent({{0.5, 60}, {0.5, 70}}).find("0.5 after 0.5"), std::string::npos);
    EXPECT_NE(bent({{1, 200}}).find("leave this point out"), std::string::npos);
    EXPECT_EQ(bent({{0, 1}, {1, 255}}), "none");
}

} // namespace
} // namespace lamella
