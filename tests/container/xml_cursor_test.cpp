#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "container/xml.hpp"
#include "container/xml_cursor.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::xml_cursor_cases {
namespace {

using test::Random;

/// Returns a document in which one in `unusual` things is not written plainly.
std::string random_document(Random& random, std::int64_t unusual) {
    const auto one_of = [&](const std::vector<std::string>& words) {
        return words[static_cast<std::size_t>(random.bits() % words.size())];
    };
    const auto is_unusual = [&] {
        return unusual != 0 && random.integer(0, unusual) == 0;
    };
    std::string text = "<a>";
    for (std::int64_t rows = random.integer(1, 20); rows > 0; --rows) {
        text += one_of({"", "\n", "\r\n", "\r", " \n\n"});
        if (is_unusual())
            text += one_of({"<!-- <r> -->", "text", "<![CDATA[<r>]]>", "<?go?>", "&lt;", "\xc3\xa9",
                            "<r xmlns='u'/>", "<r><r x='1'><r/>\n</r><q>t</q></r>"});
        text += "<r";
        if (is_unusual())
            text += one_of({" x='&#49;'", " y='\xc3\xa9'", " p:x='2'", " x = '1'", "\ny='\n'"});
        else
            text += one_of({"", " x='1'", " x=\"12\" y='a'", "\n x='3'"});
        if (random.integer(0, 3) == 0) {
            text += "/>";
            continue;
        }
        text += ">";
        for (std::int64_t n = random.integer(0, 5); n > 0; --n)
            text += one_of({"<v/>", "<v x='1'/>\n", "<v y='>'></v>", "<v><v x='7'/></v >"}) +
                    (is_unusual() ? "<!---->" : "");
        text += is_unusual() ? "</r\n>" : "</r>";
    }
    if (is_unusual())
        text += one_of({"<r>", "</r>", "<r x='1' x='2'/>", "<r x='<'/>", "< r/>", "<r/", "</ a>"});
    return text + "</a>";
}

/// Returns the elements of a document with their lines, and the error if there is one. With `scans`, a cursor
/// reads what it can. `scanned` counts the elements that it has read.
std::string events(const std::string& text, bool scans, std::size_t& scanned) {
    std::string all;
    LineCounter lines(text);
    const auto start = [&](std::string_view name, std::string_view x, std::uint64_t line) {
        all += fmt::format("{}:<{} {}>", line, name, x);
    };
    const auto end = [&](std::string_view name) {
        all += fmt::format("</{}>", name);
    };
    XmlHandlers handlers;
    handlers.start = [&](XmlName name, const XmlAttributes& attributes, std::size_t line) {
        start(name.local, attributes.find("x"), line);
    };
    handlers.end = [&](XmlName name) {
        end(name.local);
    };
    if (scans) {
        handlers.many = {"<r"};
        handlers.skim = [&](XmlCursor& cursor) {
            cursor.scan(
                text.size(),
                [&](std::string_view name, std::size_t tag) {
                    const std::size_t position = cursor.position();
                    std::string_view x;
                    const auto read = [&](std::size_t, const char* value) {
                        const std::string_view rest(value);
                        x = rest.substr(0, rest.find_first_not_of("0123456789"));
                        return value + x.size();
                    };
                    XmlTagEnd tag_end = cursor.take_attributes(std::array<std::string_view, 1>{"x"}, read);
                    if (tag_end == XmlTagEnd::none) {
                        cursor.move_to(position);
                        tag_end = cursor.take_attributes(std::array<std::string_view, 0>(), read);
                        if (tag_end != XmlTagEnd::none && x.data() != nullptr)
                            return XmlTagEnd::none; // the parser knows the value
                    }
                    if (tag_end != XmlTagEnd::none) {
                        ++scanned;
                        start(name, x, lines.line(tag));
                    }
                    return tag_end;
                },
                end);
        };
    }
    try {
        parse_xml(text, "x.xml", handlers);
    } catch (const Error& error) {
        all += error.what();
    }
    return all;
}

TEST(XmlCursor, ReadsAsTheParserDoesAndLeavesTheRestToIt) {
    Random random(77);
    std::size_t scanned = 0;
    for (int round = 0; round < test::rounds_within_reason(5000); ++round) {
        const std::string text = random_document(random, random.integer(0, 3) * 20);
        std::size_t none = 0;
        EXPECT_EQ(events(text, true, scanned), events(text, false, none)) << text;
    }
    EXPECT_GT(scanned, 100U);
}

TEST(XmlCursor, TheParserContinuesWithinTheElementsThatWereEntered) {
    const std::string text = "<a>\n<r>\n<v/>\n<!-- -->\n<v x='5'/>\n</r>\n<r/></a>";
    std::size_t scanned = 0;
    EXPECT_EQ(events(text, true, scanned), "1:<a >2:<r >3:<v ></v>5:<v 5></v></r>7:<r ></r></a>");
    EXPECT_EQ(scanned, 2U);
}

TEST(XmlCursor, StopsAtTheFirstElementFromTheLimitOn) {
    const std::string text = "<r><v/></r> <r/> <r/></a>";
    for (const auto& [limit, expected] :
         {std::pair<std::size_t, std::size_t>{1, 12}, {11, 12}, {12, 12}, {13, 17}, {99, 21}}) {
        XmlCursor cursor(text, 0, text.rfind('<'));
        cursor.scan(
            limit,
            [&](std::string_view, std::size_t) {
                return cursor.take_attributes(std::array<std::string_view, 0>(),
                                              [](std::size_t, const char* value) { return value; });
            },
            [](std::string_view) {});
        EXPECT_EQ(cursor.position(), expected) << limit;
    }
}

} // namespace
} // namespace lamella::xml_cursor_cases
