#include "lamella/core/error.hpp"

#include "container/deflate.hpp"
#include "container/inflate.hpp"
#include "container/zip_writer.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace lamella {
namespace {

TEST(ZipWriter, LeavesNothingBehindWhenItIsNotFinished) {
    const TemporaryFolder folder;
    {
        ZipWriter zip(folder.file("a.zip"));
        zip.begin("entry", ZipMethod::stored);
        zip.append_stored("content");
        EXPECT_THROW(zip.finish(), Error);
        EXPECT_THROW(zip.add("another", ""), Error);
    }
    EXPECT_TRUE(folder.entries().empty());
}

TEST(ZipWriter, GivesTheSameBytesIfContentIsCompletedLaterInAnyOrder) {
    const TemporaryFolder folder;
    const auto text = std::make_shared<const std::string>(300'000, 'x');
    const auto stream = std::make_shared<std::string>();
    Deflater().append_chunk(*text, *stream);
    const ZipChunk chunk{*stream, text->size(), crc32_of(*text)};
    ZipWriter now(folder.file("now.zip"), Overwriting::yes);
    ZipWriter later(folder.file("later.zip"), Overwriting::yes);
    const auto complete = [](Completions& after) {
        while (!after.empty()) {
            after.back()();
            after.pop_back();
        }
    };
    Completions after;
    for (ZipWriter* const zip : {&now, &later}) {
        const bool at_once = zip == &now;
        zip->begin("stored", ZipMethod::stored);
        for (int i = 0; i < 3; ++i) {
            at_once ? zip->append_stored(*text) : zip->append_stored(*text, text, after);
            zip->append_stored("few");
        }
        complete(after);
        zip->end();
        zip->begin("deflated", ZipMethod::deflated);
        for (int i = 0; i < 3; ++i)
            at_once ? zip->append(chunk) : zip->append(chunk, stream, after);
        complete(after);
        zip->end();
        zip->finish();
    }
    EXPECT_EQ(file_bytes(folder.file("later.zip")), file_bytes(folder.file("now.zip")));
}

} // namespace
} // namespace lamella
