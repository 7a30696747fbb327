#include "container/json_text.hpp"
#include "container/quoted.hpp"
#include "container/xml.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::quoted_cases {
namespace {

std::string any_bytes(test::Random& random) {
    std::string text;
    const std::vector<std::string> some{"a",    "\"",  "\\",    "<",    ">", "&",    "'",
                                        "\n",   "\0",  "\x7F",  "é",    "😀", "\xC3", "\xFF",
                                        "</x>", "]]>", "&amp;", "<!--", " "};
    for (std::int64_t n = random.integer(0, 12); n > 0; --n)
        text += some[random.bits() % some.size()];
    return text;
}

TEST(Quoted, ReadBackAsTheText) {
    test::Random random(661);
    for (int round = 0; round < test::rounds_within_reason(2000); ++round) {
        const std::string bytes = any_bytes(random);
        const std::string text = quotable(bytes);
        EXPECT_EQ(quotable(text), text) << "what is text stays";
        for (const std::string& json : {json_quoted(bytes), page_quoted(bytes)}) {
            JsonText read(json, "x");
            EXPECT_EQ(read.string(), text) << json;
            read.end();
        }
        EXPECT_EQ(page_quoted(bytes).find('<'), std::string::npos) << "no tag begins in it";
        const std::string xml = "<x a=\"" + xml_escaped(bytes) + "\">" + xml_escaped(bytes) + "</x>";
        std::string content;
        std::string attribute;
        XmlHandlers handlers;
        handlers.start = [&](XmlName, const XmlAttributes& attributes, std::size_t) {
            attribute = attributes.find("a");
        };
        handlers.end = [](XmlName) {
        };
        handlers.text = [&](std::string_view some) {
            content += some;
        };
        parse_xml(xml, "x", handlers);
        EXPECT_EQ(content, text) << xml;
        EXPECT_EQ(attribute, text) << xml;
    }
}

TEST(Quoted, CutsTextsThatNobodyMeans) {
    const std::string megabyte(1U << 20U, 'x');
    EXPECT_LE(quotable(megabyte).size(), (1U << 16U) + 100);
    EXPECT_GE(quotable(megabyte).size(), 1U << 16U);
    EXPECT_LE(printable_label(megabyte).size(), 4096U + 100);
    EXPECT_EQ(printable_label("label"), "label");
}

} // namespace
} // namespace lamella::quoted_cases
