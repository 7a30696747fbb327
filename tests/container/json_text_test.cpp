#include "container/json_text.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace lamella::json_text_cases {
namespace {

using test::Random;

/// A value of any type.
struct Value {
    enum class Kind { text, number, array, object, word } kind = Kind::word;
    std::string text;
    double number = 0;
    std::vector<std::pair<std::string, Value>> members; ///< of an array: without keys

    friend bool operator==(const Value&, const Value&) = default;
};

Value random_value(Random& random, int depth) {
    Value value;
    value.kind = static_cast<Value::Kind>(random.integer(0, depth > 0 ? 4 : 1));
    if (value.kind == Value::Kind::word)
        value.kind = Value::Kind::number;
    if (value.kind == Value::Kind::text)
        for (std::int64_t n = random.integer(0, 6); n > 0; --n)
            value.text +=
                std::vector<std::string>{"a", "\"", "\\", "\n", "\x01", "é", "😀", "/"}[random.bits() % 8];
    if (value.kind == Value::Kind::number)
        value.number =
            random.integer(0, 1) == 0 ? static_cast<double>(random.integer(-99, 99)) : random.real(-1e9, 1e9);
    if (value.kind == Value::Kind::array || value.kind == Value::Kind::object)
        for (std::int64_t n = random.integer(0, 4); n > 0; --n)
            value.members.emplace_back(value.kind == Value::Kind::array ? "" : fmt::format("key{}", n),
                                       random_value(random, depth - 1));
    return value;
}

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            result += '\\';
        if (static_cast<unsigned char>(c) < 0x20)
            result += fmt::format("\\u{:04x}", static_cast<int>(c));
        else
            result += c;
    }
    return result + '"';
}

std::string written(const Value& value, Random& random) {
    const auto blank = [&] {
        return std::vector<std::string>{"", " ", "\n", "\t\r\n"}[random.bits() % 4];
    };
    if (value.kind == Value::Kind::text)
        return blank() + quoted(value.text);
    if (value.kind == Value::Kind::number)
        return blank() + fmt::format("{}", value.number);
    const bool object = value.kind == Value::Kind::object;
    std::string text = blank() + (object ? "{" : "[");
    for (std::size_t i = 0; i < value.members.size(); ++i) {
        text += (i == 0 ? "" : ",") + blank();
        if (object)
            text += quoted(value.members[i].first) + blank() + ":";
        text += written(value.members[i].second, random) + blank();
    }
    return text + blank() + (object ? "}" : "]");
}

/// Reads a value whose types are those of `like`.
Value read_like(const Value& like, JsonText& text) {
    Value value{.kind = like.kind, .text = {}, .number = 0, .members = {}};
    if (like.kind == Value::Kind::text)
        value.text = text.string();
    else if (like.kind == Value::Kind::number)
        value.number = text.number();
    else if (like.kind == Value::Kind::array)
        text.array([&] {
            value.members.emplace_back("", read_like(like.members.at(value.members.size()).second, text));
        });
    else
        text.object([&](const std::string& key) {
            value.members.emplace_back(key, read_like(like.members.at(value.members.size()).second, text));
        });
    return value;
}

TEST(JsonText, ReadsTheValuesThatWereWritten) {
    Random random(601);
    for (int round = 0; round < test::rounds_within_reason(1000); ++round) {
        const Value value = random_value(random, 4);
        const std::string text = written(value, random) + "\n ";
        JsonText json(text, "x");
        EXPECT_EQ(read_like(value, json), value) << text;
        json.end();
        EXPECT_EQ(json.at(), text.size());
        JsonText again(text, "x");
        again.skip();
        again.end();
        // Cut off, it is no value any more, except for a number.
        const std::string part = text.substr(0, text.size() - 3);
        if (value.kind != Value::Kind::number && text.find_last_of("}]\"") > part.size() - 1) {
            JsonText cut(part, "x");
            EXPECT_THROW(cut.skip(), Error) << part;
        }
    }
}

TEST(JsonText, SkipsWordsAndReadsEscapes) {
    JsonText words("[true, false ,null]", "x");
    words.skip();
    words.end();
    JsonText escapes(R"("\u00e9\ud83d\ude00\/\b\f\n\r\t\"\\")", "x");
    EXPECT_EQ(escapes.string(), "é😀/\b\f\n\r\t\"\\");
    JsonText later("abc 7", "x", 3);
    EXPECT_EQ(later.number(), 7);
}

TEST(JsonText, NamesTheLineOfWhatIsWrong) {
    const auto expect = [](const std::string& text, const char* part) {
        test::expect_error(ErrorKind::input, {"x, line 2: ", part}, [&] {
            const std::string second_line = "\n" + text;
            JsonText json(second_line, "x");
            json.skip();
            json.end();
        });
    };
    expect("{\"a\" 1}", "':' is expected");
    expect("{\"a\":1 \"b\":2}", "',' is expected");
    expect("{1:2}", "a string is expected");
    expect("[1,2", "',' is expected");
    expect("[1,]", "a number is expected");
    expect("1 2", "the file must end here");
    expect("nan", "a number is expected");
    expect("1e999", "a number is expected");
    expect("\"a\tb\"", "must be escaped");
    expect("\"a", "must end with a quotation mark");
    expect("\"\\x\"", "no such escape sequence");
    expect("\"\\u12g4\"", "four hexadecimal digits");
    expect("\"\\ud800\"", "half a surrogate pair");
    expect("\"\\udc00\"", "half a surrogate pair");
    expect("\"\\ud800\\u0041\"", "half a surrogate pair");
    expect(std::string(65, '['), "nested deeper than 64");
}

} // namespace
} // namespace lamella::json_text_cases
