#include "lamella/core/error.hpp"

#include "container/zip_reader.hpp"
#include "container/zip_writer.hpp"
#include "core/executor.hpp"
#include "core/lower_case.hpp"
#include "fixtures/expect_error.hpp"
#include "temporary_folder.hpp"
#include "zip_bytes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace lamella::zip_reader_cases {
namespace {

using zip_test::zip_bytes;
using zip_test::ZipPart;

ByteSource source_of(std::string_view bytes) {
    return copy_bytes(std::as_bytes(std::span(bytes.data(), bytes.size())), "x.zip");
}

std::string text_of(const ByteSource& source) {
    return {reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size()};
}

std::string content(const ZipReader& zip, std::string_view name) {
    const ZipEntry* entry = zip.find(name);
    return entry == nullptr ? "(missing)" : text_of(zip.read(*entry));
}

const std::string long_text = [] {
    std::string text;
    for (int i = 0; i < 20'000; ++i)
        text.append(std::to_string(i)).append(" ");
    return text;
}();

/// Opens an archive and reads all of it.
void read_all(std::string_view bytes, std::uint64_t most = 0) {
    const ZipReader zip(source_of(bytes), most);
    for (const ZipEntry& entry : zip.entries())
        static_cast<void>(zip.read(entry));
}

/// The error, "" when there is none.
std::string error_of(std::string_view bytes, std::uint64_t most = 0, ErrorKind kind = ErrorKind::input) {
    try {
        read_all(bytes, most);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), kind) << error.what();
        const std::string_view text = error.what();
        EXPECT_TRUE(text.starts_with("x.zip: ")) << text;
        EXPECT_EQ(text.find('\n'), std::string_view::npos);
        return error.what();
    }
    return {};
}

testing::AssertionResult says(const std::string& error, std::string_view part) {
    if (error.find(part) != std::string::npos)
        return testing::AssertionSuccess();
    return testing::AssertionFailure() << "found '" << error << "', expected '" << part << "'";
}

TEST(ZipReader, ReadsStoredAndDeflatedEntriesOfEveryForm) {
    for (const bool zip64 : {false, true})
        for (const bool behind : {false, true})
            for (const bool deflated : {false, true}) {
                ZipPart part{.name = "a/long", .content = long_text, .deflated = deflated};
                part.sizes_behind = behind;
                part.zip64 = zip64;
                ZipPart empty = part;
                empty.name = "none";
                empty.content.clear();
                const std::string bytes =
                    zip_bytes({part, empty, {.name = "last", .content = "end"}}, {.zip64 = zip64});
                const ZipReader zip(source_of(bytes), 0);
                ASSERT_EQ(zip.entries().size(), 3U);
                EXPECT_EQ(content(zip, "a/long"), long_text);
                EXPECT_EQ(content(zip, "none"), "");
                EXPECT_EQ(content(zip, "last"), "end");
                EXPECT_TRUE(zip.counted_warnings().empty());
                EXPECT_EQ(zip.unpacked(), long_text.size() + 3);
            }
}

TEST(ZipReader, ReadsWhatOurWriterWrites) {
    const TemporaryFolder folder;
    const std::string path = (folder.path() / "x.zip").string();
    {
        ZipWriter zip(path);
        zip.add("stored", "content");
        zip.add("d\xc3\xa9j\xc3\xa0", long_text, ZipMethod::deflated);
        zip.begin("stream", ZipMethod::deflated);
        const std::string compressed = [] {
            std::string chunk;
            Deflater().append_chunk(long_text, chunk);
            return chunk;
        }();
        zip.append({compressed, long_text.size(), crc32_of(long_text)});
        zip.append({compressed, long_text.size(), crc32_of(long_text)});
        zip.end();
        zip.finish();
    }
    const ZipReader zip(open_bytes(path), 0);
    EXPECT_EQ(content(zip, "stored"), "content");
    EXPECT_EQ(content(zip, "d\xc3\xa9j\xc3\xa0"), long_text);
    EXPECT_EQ(content(zip, "stream"), long_text + long_text);
}

// The memory of this entry is more than a page of any size, and its CRC is computed in several chunks.
TEST(ZipReader, AnyNumberOfThreadsReadTheSameBytesAndFindTheSameDamage) {
    std::string text;
    while (text.size() < 5'000'000)
        text += long_text;
    for (const ZipMethod method : {ZipMethod::stored, ZipMethod::deflated}) {
        const TemporaryFolder folder;
        ZipWriter writer(folder.file("x.zip"));
        writer.add("a", text, method);
        writer.finish();
        const ZipReader zip(open_bytes(folder.file("x.zip")), 0);
        ZipEntry damaged = zip.entries().front();
        damaged.crc ^= 1;
        std::string error;
        for (const unsigned threads : {1U, 2U, 5U}) {
            Executor helpers({.threads = threads});
            EXPECT_TRUE(text_of(zip.read(zip.entries().front(), {}, &helpers)) == text) << threads;
            const std::string found =
                test::error_of(ErrorKind::input, [&] { static_cast<void>(zip.read(damaged, {}, &helpers)); });
            EXPECT_TRUE(error.empty() || found == error) << found;
            error = found;
        }
        EXPECT_TRUE(says(error, "its checksum is")) << error;
    }
}

TEST(ZipReader, StoredEntriesAreViewsOfTheArchive) {
    const ByteSource source = source_of(zip_bytes({{.name = "a", .content = "text", .deflated = false}}));
    const ZipReader zip(source, 0);
    const ByteSource part = zip.read(zip.entries().front());
    EXPECT_GE(part.bytes.data(), source.bytes.data());
    EXPECT_LT(part.bytes.data(), source.bytes.data() + source.bytes.size());
    EXPECT_EQ(part.name, "x.zip, part 'a'");
}

TEST(ZipReader, NamesHaveSlashesAndAreFoundInAnyCaseWhereNoOtherIs) {
    const ZipReader zip(source_of(zip_bytes({{.name = "3D\\Model.model", .content = "1"},
                                             {.name = "/_RELS/.rels", .content = "2"},
                                             {.name = "Twice", .content = "3"},
                                             {.name = "twice", .content = "4"}})),
                        0);
    EXPECT_EQ(content(zip, "3d/3dmodel.model"), "(missing)");
    EXPECT_EQ(content(zip, "3d/model.MODEL"), "1");
    EXPECT_EQ(content(zip, "_rels/.rels"), "2");
    EXPECT_EQ(content(zip, "twice"), "4");
    EXPECT_EQ(content(zip, "TWICE"), "3");
    ASSERT_EQ(zip.counted_warnings().size(), 2U);
    EXPECT_TRUE(says(zip.counted_warnings()[0], "1 names in the zip archive have '\\'"));
    EXPECT_TRUE(says(zip.counted_warnings()[1], "begin with '/'"));
}

TEST(ZipReader, FindsEachNameAmongManyAlike) {
    std::vector<std::string> names{""};
    for (std::size_t i = 0; names.size() < 400; ++i)
        for (const char c : {'a', 'A', '[', '_', 'z', 'Z'})
            names.push_back(names[i] + c);
    std::mt19937 random(3);
    std::shuffle(names.begin() + 1, names.end(), random);
    std::vector<ZipPart> parts;
    for (std::size_t i = 1; i < names.size() / 2; ++i)
        parts.push_back({.name = names[i], .content = names[i], .deflated = false});
    const ZipReader zip(source_of(zip_bytes(parts)), 0);
    for (const std::string& name : names) {
        std::string expected = "(missing)";
        for (const ZipPart& part : parts) {
            const bool similar = lower_case(part.name) == lower_case(name) && expected != name;
            if (part.name == name || (similar && (expected == "(missing)" || part.name < expected)))
                expected = part.name;
        }
        EXPECT_EQ(content(zip, name), expected) << name;
    }
}

TEST(ZipReader, ReportsWhatFollowsTheArchive) {
    const std::string bytes = zip_bytes({{.name = "a", .content = "text"}});
    const ZipReader zip(source_of(std::string(bytes).append("appended")), 0);
    EXPECT_EQ(content(zip, "a"), "text");
    ASSERT_EQ(zip.counted_warnings().size(), 1U);
    EXPECT_TRUE(says(zip.counted_warnings()[0], "8 bytes follow"));
    EXPECT_TRUE(ZipReader(source_of(zip_bytes({}, {.comment = "PK\x05\x06 in a comment"})), 0)
                    .counted_warnings()
                    .empty());
}

TEST(ZipReader, RefusesLiars) {
    const ZipPart good{.name = "a", .content = long_text};
    const auto lie = [&](auto change) {
        ZipPart part = good;
        change(part);
        return error_of(zip_bytes({part, {.name = "b", .content = "text"}}));
    };
    EXPECT_EQ(lie([](ZipPart&) {}), "");
    EXPECT_TRUE(says(lie([](ZipPart& p) { p.inner_name = "other"; }), "calls itself 'other'"));
    EXPECT_TRUE(says(lie([](ZipPart& p) { p.inner_size = 7; }), "has another method, size or checksum"));
    EXPECT_TRUE(says(lie([](ZipPart& p) { p.crc = 7; }), "its checksum is"));
    EXPECT_TRUE(says(lie([](ZipPart& p) { p.size = 7; }), "holds more than the 7 bytes"));
    EXPECT_TRUE(says(lie([](ZipPart& p) { p.size = p.content.size() + 1; }), "holds fewer than the"));
    EXPECT_TRUE(says(lie([](ZipPart& p) { p.size = std::uint64_t{1} << 31; }), "which is impossible"));
    EXPECT_TRUE(says(lie([](ZipPart& p) {
                         p.zip64 = true;
                         p.size = ~std::uint64_t{0};
                     }),
                     "which is impossible"));
    EXPECT_TRUE(says(lie([](ZipPart& p) { p.compressed_size = 1'000'000; }), "reaches into the directory"));
    EXPECT_TRUE(says(lie([](ZipPart& p) {
                         p.zip64 = true;
                         p.compressed_size = ~std::uint64_t{0};
                     }),
                     "reaches into the directory"));
    EXPECT_TRUE(says(lie([](ZipPart& p) { p.position = 3; }), "does not begin where the directory says"));
    EXPECT_TRUE(
        says(lie([](ZipPart& p) { p.position = 0xFFFFFFFE; }), "does not begin where the directory says"));
    EXPECT_TRUE(says(lie([](ZipPart& p) { p.method = 12; }), "is compressed by method 12, expected 0"));
    EXPECT_TRUE(says(lie([](ZipPart& p) { p.flags = 1; }), "is encrypted"));
    EXPECT_TRUE(says(lie([](ZipPart& p) { p.disc = 2; }), "is on disc 2"));
    EXPECT_TRUE(says(lie([](ZipPart& p) { p.compressed = std::string(1000, '\xff'); }), "are invalid"));
    EXPECT_TRUE(says(lie([](ZipPart& p) { p.compressed = zip_test::deflated(p.content).append("more"); }),
                     "are invalid"));
    EXPECT_TRUE(says(lie([](ZipPart& p) {
                         p.deflated = false;
                         p.size = 3;
                     }),
                     "which is impossible"));
    EXPECT_TRUE(says(error_of(zip_bytes({good, good})), "two entries of the zip archive are called 'a'"));
    EXPECT_TRUE(says(error_of(zip_bytes({{.name = "a/b", .content = "1"}, {.name = "a\\b", .content = "2"}})),
                     "two entries of the zip archive are called 'a/b'"));
    ZipPart same_bytes = good; // an entry within the bytes of another one
    same_bytes.name = "b";
    same_bytes.content = zip_bytes({{.name = "c", .content = "text"}});
    same_bytes.deflated = false;
    EXPECT_TRUE(says(error_of(zip_bytes({same_bytes, {.name = "c", .content = "text", .position = 31}})),
                     "lies upon entry"));
}

TEST(ZipReader, RefusesDirectoriesThatAreNotThere) {
    const std::vector<ZipPart> parts = {{.name = "a", .content = "text"}};
    EXPECT_TRUE(says(error_of("PK\x03\x04 and nothing"), "the end of the zip archive is missing"));
    EXPECT_TRUE(
        says(error_of(std::string("junk").append(zip_bytes(parts))), "or something is in front of it"));
    EXPECT_TRUE(says(error_of(zip_bytes(parts, {.directory_offset = 0})), "should take"));
    EXPECT_TRUE(says(error_of(zip_bytes(parts, {.directory_size = 0xFFFFFFF0})), "should take"));
    EXPECT_TRUE(says(error_of(zip_bytes(parts, {.entries = 2})), "claims 2 entries"));
    EXPECT_TRUE(
        says(error_of(zip_bytes(parts, {.zip64 = true, .entries = ~std::uint64_t{0}})), "claims 18446744"));
    EXPECT_TRUE(says(error_of(zip_bytes(parts, {.zip64 = true, .directory_offset = ~std::uint64_t{0}})),
                     "should take"));
    EXPECT_TRUE(says(error_of(zip_bytes(parts, {.zip64 = true, .directory_size = ~std::uint64_t{0}})),
                     "should take"));
}

TEST(ZipReader, RefusesTwoDirectories) {
    const std::vector<ZipPart> parts = {{.name = "a", .content = "text"}};
    const std::string whole = zip_bytes(parts, {.zip64 = true});
    read_all(whole);
    const std::size_t end = whole.size() - 22;
    // The classic record of the end may have the true numbers as well, and no others.
    for (const std::size_t field : {10U, 12U, 16U}) {
        std::string other = whole;
        other[end + field] = '\x07';
        other[end + field + 1] = '\0';
        EXPECT_TRUE(says(error_of(other), "the two ends of the zip archive contradict each other")) << field;
    }
    std::string both = whole;
    both.replace(end + 10, 2, std::string("\1\0", 2));
    read_all(both);
    // Room for another directory.
    std::string wide = whole;
    wide.insert(end - 20, 10, 'x');
    EXPECT_TRUE(says(error_of(wide), "should have its (64-bit) end at byte"));
}

// Entries that share packed bytes are how a small archive holds petabytes.
TEST(ZipReader, RefusesEntriesThatShareBytes) {
    const std::string zeros(1'000'000, '\0');
    std::vector<ZipPart> parts = {{.name = "0", .content = zeros}};
    for (int i = 1; i < 50; ++i)
        parts.push_back({.name = "0", .content = "", .size = zeros.size(), .position = 0});
    EXPECT_NE(error_of(zip_bytes(parts)), "");
}

TEST(ZipReader, UnpacksNoMoreThanItMayAndSaysWhichOptionAllowsMore) {
    const std::string bytes =
        zip_bytes({{.name = "a", .content = std::string(500'000, 'x')},
                   {.name = "b", .content = std::string(500'000, 'y'), .deflated = false}});
    EXPECT_EQ(error_of(bytes, 1'000'000), "");
    const std::string error = error_of(bytes, 999'999, ErrorKind::limit);
    EXPECT_TRUE(says(error, "zip entry 'b' of 500000 bytes"));
    EXPECT_TRUE(says(error, "`max_memory`"));
    EXPECT_TRUE(says(error_of(bytes, 1, ErrorKind::limit), "zip entry 'a'"));
}

TEST(ZipReader, CountsAnEntryThatIsReadAgainOnce) {
    const std::string bytes =
        zip_bytes({{.name = "a", .content = long_text}, {.name = "b", .content = "end", .deflated = false}});
    const ZipReader zip(source_of(bytes), long_text.size() + 3);
    for (int pass = 0; pass < 3; ++pass) {
        EXPECT_EQ(content(zip, "a"), long_text);
        EXPECT_EQ(content(zip, "b"), "end");
    }
    EXPECT_EQ(zip.unpacked(), long_text.size() + 3);
}

TEST(ZipReader, FirstBytesOfAnEntryTakeNoMoreThanThese) {
    const std::string content(10'000'000, 'a');
    for (const bool deflated : {true, false}) {
        const std::string bytes = zip_bytes({{.name = "a", .content = content, .deflated = deflated}});
        const ZipReader zip(copy_bytes(std::as_bytes(std::span(bytes)), "a.zip"), 1000);
        EXPECT_EQ(zip.first_bytes(zip.entries().front(), 5), "aaaaa");
        EXPECT_EQ(zip.first_bytes(zip.entries().front(), 70'000), content.substr(0, 70'000));
        EXPECT_EQ(zip.unpacked(), 0U);
    }
    const std::string small = zip_bytes({{.name = "a", .content = "abc"}});
    const ZipReader zip(copy_bytes(std::as_bytes(std::span(small)), "a.zip"), 1000);
    EXPECT_EQ(zip.first_bytes(zip.entries().front(), 100), "abc");
}

TEST(ZipReader, EveryPrefixIsRefused) {
    const std::string bytes = zip_bytes(
        {{.name = "a", .content = "text text text"}, {.name = "b/c", .content = "more", .deflated = false}},
        {.comment = "comment"});
    EXPECT_EQ(error_of(bytes), "");
    for (std::size_t size = 1; size < bytes.size(); ++size)
        EXPECT_NE(error_of(bytes.substr(0, size)), "") << size;
}

TEST(ZipReader, SurvivesMutations) {
    ZipPart wide{.name = "wide", .content = long_text.substr(0, 300)};
    wide.zip64 = true;
    ZipPart behind = wide;
    behind.name = "behind";
    behind.sizes_behind = true;
    const std::vector<std::string> seeds = {
        zip_bytes({{.name = "a", .content = "text text"}, {.name = "b", .content = "x", .deflated = false}}),
        zip_bytes({wide, behind}, {.zip64 = true})};
    std::mt19937 random(20'22);
    std::size_t read_anyway = 0;
    for (int round = 0; round < 20'000; ++round) {
        std::string bytes = seeds[random() % seeds.size()];
        for (unsigned change = 0; change <= random() % 3; ++change) {
            const std::size_t at = random() % bytes.size();
            switch (random() % 4) {
            case 0:
                bytes[at] = static_cast<char>(random());
                break;
            case 1:
                bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
                break;
            case 2:
                bytes.replace(at, 4, "\xff\xff\xff\xff");
                break;
            default:
                bytes.erase(at, 1 + random() % 8);
            }
            if (bytes.empty())
                bytes.assign(1, 'P');
        }
        read_anyway += error_of(bytes, 1 << 20).empty() ? 1 : 0;
    }
    EXPECT_GT(read_anyway, 500U) << "the mutations are so wild that they test nothing";
}

} // namespace
} // namespace lamella::zip_reader_cases
