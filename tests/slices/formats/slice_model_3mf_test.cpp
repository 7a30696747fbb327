// Slices are read alike by any number of threads, and as by an XML parser alone.

#include "lamella/core/error.hpp"

#include "container/in_memory.hpp"
#include "container/read_limits.hpp"
#include "core/executor.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "slices/formats/slice_model_3mf.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace lamella::slice_model_3mf_cases {
namespace {

using test::Random;

constexpr std::string_view core = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
constexpr std::string_view slices = "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07";

/// Tags of the core and of slices.
struct Prefixes {
    std::string core;
    std::string slices;

    [[nodiscard]] std::string declarations() const {
        const auto declares = [](const std::string& prefix, std::string_view space) {
            return fmt::format(" xmlns{}=\"{}\"",
                               prefix.empty() ? "" : ":" + prefix.substr(0, prefix.size() - 1), space);
        };
        return declares(core, slice_model_3mf_cases::core) + declares(slices, slice_model_3mf_cases::slices);
    }
};

class Writer {
  public:
    Writer(Random& random, Prefixes prefixes, std::int64_t unusual)
        : random_(random), prefixes_(std::move(prefixes)), unusual_(unusual) {}

    /// Returns a model of some stacks. One in `unusual` pieces of the text is not written as usual.
    std::string model() {
        std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>" + end_of_line() + "<" +
                           prefixes_.core + "model xmlns:e=\"urn:e\"" + prefixes_.declarations() + ">";
        body_ = text.size();
        text += end_of_line();
        const std::int64_t stacks = random_.integer(1, 4);
        for (std::int64_t id = 1; id <= stacks; ++id)
            text += stack(id, random_.integer(0, 2) == 0 ? 5 : random_.integer(100, 800));
        return text + "</" + prefixes_.core + "model>";
    }

    /// Returns the offset of the contents of the root element.
    [[nodiscard]] std::size_t body() const { return body_; }

  private:
    std::string stack(std::int64_t id, std::int64_t slices) {
        std::string text = fmt::format("<{}slicestack id=\"{}\" zbottom=\"{}\">", prefixes_.slices, id,
                                       random_.integer(0, 1));
        for (std::int64_t top = 2; top < slices + 2; ++top)
            text += between() + slice(top);
        return text + between() + fmt::format("</{}slicestack>", prefixes_.slices);
    }

    std::string slice(std::int64_t top) {
        if (is_unusual() && random_.integer(0, 40) == 0)
            return fmt::format("<{}sliceref slicestackid=\"{}\"/>", prefixes_.slices, top);
        const std::int64_t rings = random_.integer(0, 8);
        if (rings == 0)
            return tag("slice", {attribute("ztop", top)}, true);
        std::string vertices;
        std::string polygons;
        std::int64_t count = 0;
        for (std::int64_t ring = 0; ring < rings; ++ring) {
            const std::int64_t corners = random_.integer(is_unusual() ? 1 : 3, 20);
            for (std::int64_t i = 0; i < corners; ++i)
                vertices +=
                    between() + tag("vertex", {attribute("x", number()), attribute("y", number())}, true);
            std::string segments;
            for (std::int64_t i = 1; i < corners; ++i)
                segments += between() + tag("segment", {attribute("v2", count + i)}, true);
            if (!is_unusual()) // otherwise open
                segments += between() + tag("segment", {attribute("v2", count)}, true);
            polygons += between() + tag("polygon", {attribute("startv", count)}, false) + segments +
                        between() + end("polygon");
            count += corners;
        }
        return tag("slice", {attribute("ztop", top)}, false) + between() + tag("vertices", {}, false) +
               vertices + between() + end("vertices") + polygons + between() + end("slice");
    }

    std::string number() {
        return is_unusual() ? std::vector<std::string>{"1e2", " 3 ", "&#52;", "-0",
                                                       "0.1234567890123456789"}[static_cast<std::size_t>(
                                  random_.integer(0, 4))]
                            : fmt::format("{}.{:03}", random_.integer(-99, 99), random_.integer(0, 999));
    }

    template <class Value>
    std::string attribute(std::string_view name, const Value& value) {
        const std::string_view quote = is_unusual() ? "'" : "\"";
        return fmt::format("{}={}{}{}", name, quote, value, quote);
    }

    std::string tag(std::string_view name, std::vector<std::string> attributes, bool whole) {
        if (is_unusual())
            attributes.push_back(std::vector<std::string>{
                "e:more=\"1\"", "other='a>b'", "z=\"&lt;\"",
                "xmlns:n=\"urn:n\" n:x='9'"}[static_cast<std::size_t>(random_.integer(0, 3))]);
        std::string text = "<" + prefixes_.slices + std::string(name);
        for (const std::string& attribute : attributes)
            text += " " + (is_unusual() ? end_of_line() : "") + attribute;
        if (whole && is_unusual())
            return text + "></" + prefixes_.slices + std::string(name) + ">";
        return text + (is_unusual() ? " " : "") + (whole ? "/>" : ">");
    }

    std::string end(std::string_view name) {
        return "</" + prefixes_.slices + std::string(name) + (is_unusual() ? "\n>" : ">");
    }

    std::string between() {
        return is_unusual()
                   ? std::vector<std::string>{"<!-- </" + prefixes_.slices + "slicestack> -->",
                                              "<![CDATA[<" + prefixes_.slices + "slice ztop=\"7\">]]>",
                                              "<?go on?>",
                                              "text",
                                              "",
                                              "<e:x><e:y/></e:x>"}[static_cast<std::size_t>(
                         random_.integer(0, 5))]
                   : end_of_line();
    }

    std::string end_of_line() {
        return std::vector<std::string>{"\n", "\r\n", "\r",
                                        ""}[static_cast<std::size_t>(random_.integer(0, 3))];
    }

    bool is_unusual() { return unusual_ != 0 && random_.integer(0, unusual_) == 0; }

    Random& random_;
    Prefixes prefixes_;
    std::int64_t unusual_;
    std::size_t body_ = 0;
};

/// Returns everything in the model, or the error.
std::string outcome(const std::string& text, unsigned threads) {
    const auto find = [](const ThreeMfElement& reference) {
        SliceStack stack;
        stack.slices.emplace_back().top = reference["slicestackid"].index();
        return std::make_shared<const SliceStack>(stack);
    };
    try {
        const ByteSource part = test::source_of(text);
        ReadLimits limits(part, LayerReadOptions{});
        Executor executor({.threads = threads});
        const SliceModel model = read_slice_model(part, find, limits, executor);
        std::string result;
        for (const auto& [id, stack] : model.stacks) {
            result += fmt::format("stack {} from {}\n", id, stack->bottom);
            for (const Slice& slice : stack->slices) {
                result += fmt::format("to {}:", slice.top);
                for (const RawLayer::Contour& contour : slice.raw.ends)
                    result += fmt::format(" {}{}", contour.end, contour.closed ? "" : " open");
                for (const Point2& p : slice.raw.points)
                    result += fmt::format(" {} {}", p.x, p.y);
                result += '\n';
            }
        }
        for (const std::string& warning : model.warnings)
            result += warning + '\n';
        return result;
    } catch (const Error& error) {
        return error.what();
    }
}

/// The declaration of a prefix within the root element makes the parser read everything.
std::string without_skimming(std::string text, std::size_t body) {
    return text.insert(body, "<e:declares xmlns:f=\"urn:f\"/>");
}

void expect_same_outcome(const std::string& text, std::size_t body, int round) {
    const std::string expected = outcome(without_skimming(text, body), 1);
    for (const unsigned threads : test::thread_counts())
        ASSERT_EQ(outcome(text, threads), expected) << threads << " threads, round " << round;
}

const std::vector<Prefixes> prefixes{{"", "s:"}, {"", "slices-2015:"}, {"c:", ""}, {"c:", "c.s:"}};

TEST(SliceModel3mf, IsThatOfAParserForAnyNumberOfThreads) {
    Random random(3);
    for (int round = 0; round < test::rounds_within_reason(16); ++round) {
        const std::int64_t unusual = std::vector<std::int64_t>{0, 30, 1000, 30000}[round % 4];
        Writer writer(random, prefixes[static_cast<std::size_t>(random.integer(0, 3))], unusual);
        const std::string text = writer.model();
        expect_same_outcome(text, writer.body(), round);
    }
}

TEST(SliceModel3mf, HasTheSameDefectForAnyNumberOfThreads) {
    Random random(4);
    for (int round = 0; round < test::rounds_within_reason(24); ++round) {
        Writer writer(random, prefixes[static_cast<std::size_t>(random.integer(0, 3))],
                      std::vector<std::int64_t>{0, 0, 1000, 30000}[round % 4]);
        std::string text = writer.model();
        for (std::int64_t n = random.integer(1, 2); n > 0; --n) {
            const auto at = static_cast<std::size_t>(random.integer(
                static_cast<std::int64_t>(writer.body()), static_cast<std::int64_t>(text.size()) - 1));
            const std::int64_t kind = random.integer(0, 5);
            if (kind == 0)
                text.resize(at);
            else if (kind == 1)
                text.erase(at, static_cast<std::size_t>(random.integer(1, 2000)));
            else if (kind == 2)
                text.insert(at, text.substr(at / 2, static_cast<std::size_t>(random.integer(1, 2000))));
            else
                text[at] = "\xff\0x<>/\"'&- \n=:9s"[random.integer(0, 15)];
        }
        expect_same_outcome(text, writer.body(), round);
    }
}

// Stacks that are read in pieces, and warnings and errors behind them, know their lines.
TEST(SliceModel3mf, KnowsLinesBehindSlicesThatWereReadWithoutAParser) {
    const std::string begin = fmt::format("<model xmlns=\"{}\" xmlns:s=\"{}\">", core, slices);
    const auto slice = [](int top, std::string_view last) {
        return fmt::format(
            "<s:slice ztop=\"{}\">\n<s:vertices><s:vertex x=\"0\" y=\"0\"/>\n<s:vertex x=\"1\" "
            "y=\"0\"/>\r\n<s:vertex x=\"0\" y=\"1\"/></s:vertices>\r<s:polygon startv=\"0\">"
            "<s:segment v2=\"1\"/><s:segment v2=\"2\"/><s:segment v2=\"{}\"/></s:polygon></s:slice>\n",
            top, last);
    };
    std::string stack = "<s:slicestack id=\"1\">";
    for (int top = 1; top <= 10000; ++top)
        stack += slice(top, top == 9000 ? "1" : "0");
    stack += "</s:slicestack>";
    for (const unsigned threads : {1U, 7U}) {
        EXPECT_NE(
            outcome(begin + stack + "</model>", threads).find("1 contour is open (first at line 45000)"),
            std::string::npos)
            << threads;
        EXPECT_EQ(outcome(begin + stack + "<object id=\"x\"/></model>", threads),
                  "x, line 50001: found id = 'x', expected a whole number")
            << threads;
    }
}

} // namespace
} // namespace lamella::slice_model_3mf_cases
