#include "fixtures/png_file.hpp"
#include "resin_jobs.hpp"
#include "slices/images/resin_archive.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lamella::resin_archive_cases {
namespace {

TEST(ResinArchive, NumbersImagesFromOne) {
    for (const char* format : {"chitubox-zip", "nanodlp"}) {
        const std::string archive = job_of(format, squares(2));
        for (const char* name : {"1.png", "2.png"}) {
            const std::size_t begin = archive.find("\x89PNG", archive.find(name));
            ASSERT_NE(begin, std::string::npos);
            const PngFile image = read_png(archive.substr(begin, archive.find("IEND", begin) + 8 - begin));
            ASSERT_EQ(image.error, "");
            EXPECT_EQ(image.width, 8U);
            EXPECT_EQ(image.height, 4U);
            EXPECT_EQ(image.values[8 + 3], 255);
            EXPECT_EQ(image.values[8 + 2], 0);
        }
        EXPECT_EQ(archive.find("0.png"), std::string::npos);
    }
}

} // namespace
} // namespace lamella::resin_archive_cases
