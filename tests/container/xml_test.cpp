#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "container/xml.hpp"
#include "fixtures/skip_if_slowed.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace lamella::xml_cases {
namespace {

/// Everything that is told of a document, in one text.
struct Told {
    std::string events;
    XmlHandlers handlers;

    Told() {
        handlers.start = [this](XmlName name, const XmlAttributes& attributes, std::size_t line) {
            events += fmt::format("{}:<{}", line, shown(name));
            for (const XmlName attribute : {XmlName{"", "xmlns"}, XmlName{"", "xmlns:p"}, XmlName{"", "p:x"},
                                            XmlName{"two", "x"}, XmlName{"", "x"}})
                if (const std::string_view value = attributes.find(attribute); value.data() != nullptr)
                    events += fmt::format(" {}='{}'", shown(attribute), value);
            events += ">";
        };
        handlers.end = [this](XmlName name) {
            events += fmt::format("</{}>", shown(name));
        };
    }

    static std::string shown(XmlName name) {
        return name.space.empty() ? std::string(name.local) : fmt::format("{{{}}}{}", name.space, name.local);
    }
};

std::string error_of(std::string_view document, const XmlRules& rules = {}) {
    try {
        parse_xml(document, "x.xml", Told().handlers, rules);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        return error.what();
    }
    return {};
}

TEST(Xml, AnElementDeclaresNoMoreNamespacesThanItMayHaveAttributes) {
    const auto declare = [](int count) {
        std::string document = "<a><b";
        for (int i = 0; i < count; ++i)
            document += fmt::format(" xmlns:p{0}='u{0}'", i);
        Told told;
        told.handlers.declare = [](std::string_view, std::string_view) {
        };
        parse_xml(document + "/><c xmlns='d'/></a>", "x.xml", told.handlers, {.namespaces = true});
    };
    EXPECT_NO_THROW(declare(1000));
    EXPECT_THROW(declare(1001), Error);
}

TEST(Xml, NamesAreAsWrittenUnlessNamespacesAreResolved) {
    const std::string document = "<a xmlns='one' xmlns:p='two'><p:b p:x='1' x='2'/><c xmlns='two'/></a>";
    Told plain;
    parse_xml(document, "x.xml", plain.handlers);
    EXPECT_EQ(plain.events,
              "1:<a xmlns='one' xmlns:p='two'>1:<p:b p:x='1' x='2'></p:b>1:<c xmlns='two'></c></a>");
    Told resolved;
    std::string declared;
    resolved.handlers.declare = [&](std::string_view prefix, std::string_view space) {
        declared += fmt::format("{}={};", prefix, space);
    };
    parse_xml(document, "x.xml", resolved.handlers, {.namespaces = true});
    EXPECT_EQ(resolved.events, "1:<{one}a>1:<{two}b {two}x='1' x='2'></{two}b>1:<{two}c></{two}c></{one}a>");
    EXPECT_EQ(declared, "=one;p=two;");
}

TEST(Xml, FindsAttributesByNameAndNamespace) {
    XmlHandlers handlers;
    handlers.start = [](XmlName, const XmlAttributes& attributes, std::size_t) {
        EXPECT_EQ(attributes.find("x"), "2");
        EXPECT_EQ(attributes.find(XmlName{"two", "x"}), "1");
        EXPECT_EQ(attributes.find("y").data(), nullptr);
        EXPECT_EQ(attributes.find(XmlName{"two", "y"}).data(), nullptr);
        EXPECT_NE(attributes.find("empty").data(), nullptr);
    };
    handlers.end = [](XmlName) {
    };
    parse_xml("<a xmlns:p='two' p:x='1' x='2' empty=''/>", "x.xml", handlers, {.namespaces = true});
}

TEST(Xml, GivesTextToWhoWantsIt) {
    Told told;
    told.handlers.text = [&](std::string_view text) {
        told.events += text;
    };
    parse_xml("<a>one<b>&lt;two&#62;</b>\xc3\xa9</a>", "x.xml", told.handlers);
    EXPECT_EQ(told.events, "1:<a>one1:<b><two></b>\xc3\xa9</a>");
}

TEST(Xml, RefusesWhatIsNotForUs) {
    EXPECT_EQ(error_of("<a>\n<b></a>"), "x.xml, line 2: the XML is broken: mismatched tag");
    EXPECT_EQ(error_of("<p:a/>", {.namespaces = true}), "x.xml, line 1: the XML is broken: unbound prefix");
    EXPECT_EQ(error_of("<a b='1' b='2'/>"), "x.xml, line 1: the XML is broken: duplicate attribute");
    EXPECT_NE(error_of("<!DOCTYPE a [<!ENTITY e 'e'>]><a>&e;</a>"), "");
    EXPECT_EQ(error_of("<!DOCTYPE svg PUBLIC 'x' 'y'><a/>"), "");
    EXPECT_NE(error_of("<!DOCTYPE svg PUBLIC 'x' 'y'><a/>", {.no_document_type = true}), "");
    EXPECT_EQ(error_of("<?xml version='1.0' encoding='utf-8'?><a/>", {.utf8_only = true}), "");
    EXPECT_EQ(error_of("\xef\xbb\xbf<a/>", {.utf8_only = true}), "");
    EXPECT_EQ(error_of("<?xml version='1.0' encoding='ISO-8859-1'?><a/>"), "");
    EXPECT_EQ(error_of("<?xml version='1.0' encoding='ISO-8859-1'?><a/>", {.utf8_only = true}),
              "x.xml, line 1: found encoding 'ISO-8859-1', expected UTF-8");
    const std::string_view utf16("\xff\xfe<\0a\0/\0>\0", 10);
    EXPECT_EQ(error_of(utf16), "");
    EXPECT_EQ(error_of(utf16, {.utf8_only = true}), "x.xml, line 1: found UTF-16, expected UTF-8");
    std::string deep;
    std::string many = "<a";
    for (int i = 0; i < 1001; ++i) {
        deep += "<a>";
        many += fmt::format(" a{}=''", i);
    }
    EXPECT_NE(error_of(deep).find("nested deeper"), std::string::npos);
    EXPECT_NE(error_of(many + "/>").find("more than 1000 attributes"), std::string::npos);
    EXPECT_NE(error_of("<a><!--" + std::string(90 << 20, 'x')).find("longer than 64 MB"), std::string::npos);
}

// Expat looks at a token that is not whole only now and then, which must not count against the token.
TEST(Xml, ReadsTokensOf64MBAndRefusesLongerOnes) {
    LAMELLA_SKIP_IF_SLOWED();
    const std::string before = "<a>" + std::string(3'000'001, 'x');
    const auto document = [&](std::size_t token) {
        std::string comment = "<!--" + std::string(token - 7, ' ') + "-->";
        comment.replace(40'000'000, 4, "<v/>");
        return before + comment + "<b/></a>";
    };
    constexpr std::size_t most = std::size_t{64} << 20;
    for (const bool skim : {false, true}) {
        Told told;
        if (skim) { // the tag in the comment sends the parser there
            told.handlers.many = {"<v"};
            told.handlers.skim = [](XmlCursor&) {
            };
        }
        parse_xml(document(most), "x.xml", told.handlers);
        EXPECT_EQ(told.events, "1:<a>1:<b></b></a>") << skim;
        try {
            parse_xml(document(most + 1), "x.xml", told.handlers);
            ADD_FAILURE() << skim;
        } catch (const Error& error) {
            EXPECT_STREQ(error.what(), "x.xml, line 1: found a tag, text or comment longer than 64 MB");
        }
    }
}

TEST(Xml, ThrowsWhatAHandlerThrows) {
    XmlHandlers handlers;
    handlers.start = [](XmlName, const XmlAttributes&, std::size_t) {
        throw std::out_of_range("mine");
    };
    handlers.end = [](XmlName) {
    };
    EXPECT_THROW(parse_xml("<a/>", "x.xml", handlers), std::out_of_range);
}

/// Skims runs of <v .../> up to the next "</".
struct Skimmer : Told {
    std::string skimmed;

    Skimmer() {
        handlers.many = {"<v"};
        handlers.skim = [this](XmlCursor& cursor) {
            const std::size_t end = cursor.text().find("</", cursor.position());
            if (end == std::string_view::npos)
                return;
            skimmed += fmt::format("[{}]", cursor.text().substr(cursor.position(), end - cursor.position()));
            cursor.move_to(end);
        };
    }
};

TEST(Xml, SkimmedElementsDoNotReachTheParserAndLinesAreStillRight) {
    Skimmer skimmer;
    parse_xml("<a>\n<r>\n<v/>\n<v x='1'/>\n</r>\n<r><x/>\n <v\n/></r>\n<vs/>\n</a>", "x.xml",
              skimmer.handlers);
    EXPECT_EQ(skimmer.events, "1:<a>2:<r></r>6:<r>6:<x></x></r>9:<vs></vs></a>");
    EXPECT_EQ(skimmer.skimmed, "[<v/>\n<v x='1'/>\n][<v\n/>]");
}

TEST(Xml, LinesAreRightBehindSkimmedElementsWithLineEndsOfEveryKind) {
    for (const bool known : {false, true}) {
        Skimmer skimmer;
        const auto skim = skimmer.handlers.skim;
        skimmer.handlers.skim = [&](XmlCursor& cursor) {
            const std::size_t begin = cursor.position();
            skim(cursor);
            const std::size_t end = cursor.position();
            if (known)
                cursor.move_to(end, line_at(cursor.text().substr(begin), end - begin) - 1);
        };
        parse_xml("<a>\r<r>\r\n<v/>\r\n<v/>\r<v/>\n\r</r>\n<x/></a>", "x.xml", skimmer.handlers);
        EXPECT_EQ(skimmer.events, "1:<a>2:<r></r>8:<x></x></a>");
    }
}

TEST(Xml, SkimsNothingInCommentsTextsAndOtherPlaces) {
    for (const std::string_view inner :
         {"<!-- <v/> -->", "<!--<v/>-->", "<![CDATA[<v/>]]>", "text <v/>", "<?pi <v/>?>"}) {
        Skimmer skimmer;
        parse_xml(fmt::format("<a>{}</a>", inner), "x.xml", skimmer.handlers);
        EXPECT_EQ(skimmer.skimmed, "") << inner;
    }
    Skimmer skimmer;
    EXPECT_THROW(parse_xml("<a x='<v/>'></a>", "x.xml", skimmer.handlers), Error);
    EXPECT_EQ(skimmer.skimmed, "");
}

// Each try to skim hands the parser an unfinished comment once more: a million of them must not take hours.
TEST(Xml, TagsInALongCommentCostLittle) {
    std::string document = "<a><!--";
    for (int i = 0; i < 1'000'000; ++i)
        document += "<v/>";
    Skimmer skimmer;
    parse_xml(document + "--></a>", "x.xml", skimmer.handlers);
    EXPECT_EQ(skimmer.skimmed, "");
    EXPECT_EQ(skimmer.events, "1:<a></a>");
}

TEST(Xml, ElementsOfTheRootReportWhereTheyBegin) {
    const std::string text = "<a>\n<v/><b x='1'><c/></b><!-- <b> -->\n <v/><v/>\n<b/></a>";
    const std::size_t first = text.find("<b");
    for (const bool skim : {false, true}) {
        Told told;
        if (skim) {
            told.handlers.many = {"<v"};
            told.handlers.skim = [](XmlCursor& cursor) {
                EXPECT_TRUE(cursor.take("<v/>"));
            };
        }
        std::vector<std::size_t> found;
        told.handlers.element = [&](std::size_t position) {
            if (text.substr(position).starts_with("<b"))
                found.push_back(position);
            else
                EXPECT_TRUE(text.substr(position).starts_with("<v")) << position;
        };
        parse_xml(text, "x.xml", told.handlers);
        EXPECT_EQ(found, (std::vector{first, text.rfind("<b")})) << skim;
        found.clear();
        static_cast<void>(parse_xml_elements(text, first, text.size(), "<a>", "x.xml", told.handlers));
        EXPECT_EQ(found, (std::vector{first, text.rfind("<b")})) << skim;
    }
}

TEST(Xml, ProgressAddsUpToTheDocument) {
    std::string document = "<a>";
    for (int i = 0; i < 1'500'000; ++i)
        document += "<v/>";
    document += "</a>";
    for (const bool skim : {false, true}) {
        Skimmer told;
        if (!skim)
            told.handlers.skim = nullptr;
        told.handlers.start = [](XmlName, const XmlAttributes&, std::size_t) {
        };
        told.handlers.end = [](XmlName) {
        };
        std::size_t bytes = 0;
        told.handlers.progress = [&](std::size_t read) {
            bytes += read;
        };
        parse_xml(document, "x.xml", told.handlers);
        EXPECT_EQ(bytes, document.size()) << skim;
    }
}

TEST(Xml, TakesUtf8WithoutItsHyphen) {
    for (const XmlRules& rules : {XmlRules{}, XmlRules{.namespaces = true, .utf8_only = true}})
        for (const char* name : {"utf8", "UTF8", "utf-8"})
            for (const char quote : {'\'', '"'}) {
                Told told;
                parse_xml(
                    fmt::format("<?xml version='1.0' encoding={0}{1}{0}?><a x='\xC3\xA4'/>", quote, name),
                    "x", told.handlers, rules);
                EXPECT_NE(told.events.find("x='\xC3\xA4'"), std::string::npos) << name;
            }
    for (const char* declaration : {"<?xml version='1.0' encoding='utf8x'?>",
                                    "<?xml version='1.0' encoding='utf8\"?>", "<?xml encoding='utf8'"}) {
        Told told;
        EXPECT_THROW(parse_xml(std::string(declaration) + "<a/>", "x", told.handlers), Error) << declaration;
    }
}

} // namespace
} // namespace lamella::xml_cases
