#pragma once

#include "lamella/core/error.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

namespace lamella::test {

/// Runs `action` and expects an Error of this kind: one line of readable length that names all `parts`.
template <class Action>
void expect_error(ErrorKind kind, std::initializer_list<const char*> parts, const Action& action) {
    try {
        action();
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        const std::string text = error.what();
        EXPECT_EQ(error.kind(), kind) << text;
        for (const char* part : parts)
            EXPECT_NE(text.find(part), std::string::npos) << '"' << part << "\" is not in: " << text;
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        EXPECT_LT(text.size(), 250U) << text;
    }
}

} // namespace lamella::test
