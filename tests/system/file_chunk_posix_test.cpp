#include "fixtures/expect_error.hpp"
#include "system/file_chunk.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

namespace lamella::file_chunk_posix_cases {
namespace {

TEST(FileChunk, CallsTheFileByTheNameThatItWillHave) {
    FileChunk chunk("/dev/full", 0, "part.cli");
    EXPECT_EQ(test::error_of(ErrorKind::output, [&] { chunk.append("x"); }),
              "cannot write 'part.cli': the disk is full; free some space or choose another place");
}

} // namespace
} // namespace lamella::file_chunk_posix_cases
