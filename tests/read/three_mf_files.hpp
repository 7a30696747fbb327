#pragma once

// Parts of 3MF files and of the errors about them.

#include <gtest/gtest.h>

#include <string>

namespace lamella::package_test::three_mf_cases {

inline std::string in_model(const std::string& error) {
    EXPECT_TRUE(error.starts_with("x, part '3D/3dmodel.model', line ")) << error;
    return error;
}

inline const std::string one_item = "<item objectid=\"1\"/>";

} // namespace lamella::package_test::three_mf_cases
