#include "resin_jobs.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lamella::nanodlp_cases {
namespace {

TEST(NanoDlp, HasItsSettingsAsJson) {
    const std::string archive = job_of("nanodlp", squares(4));
    const auto entry = [&](const std::string& name) {
        return entry_of(archive, name);
    };
    const std::string options = entry("options.json");
    EXPECT_EQ(entry("slicer.json"), options);
    EXPECT_NE(options.find(
                  "\"PWidth\": 8, \"PHeight\": 4, \"XPixelSize\": 1, \"YPixelSize\": 1, \"Thickness\": 500"),
              std::string::npos)
        << options;
    EXPECT_NE(entry("plate.json").find("\"LayersCount\": 4"), std::string::npos);
    EXPECT_NE(entry("profile.json").find("\"CureTime\": 2, \"SupportCureTime\": 20"), std::string::npos);
    EXPECT_NE(entry("info.json")
                  .find("{\"TotalSolidArea\": 4, \"LargestArea\": 4, \"SmallestArea\": 4, \"MinX\": 3, "
                        "\"MinY\": 1, \"MaxX\": 5, \"MaxY\": 3, \"AreaCount\": 1}"),
              std::string::npos);
}

} // namespace
} // namespace lamella::nanodlp_cases
