#include "lamella/core/error.hpp"

#include "container/text_chunks.hpp"
#include "fixtures/face_text.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace lamella::pieces_test {
namespace {

/// Words, and whether each stands between brackets: a parser that has to know what came before.
struct WordChunk : TextChunk {
    std::vector<std::string> words;
};

ChunkFormat<WordChunk> word_format(std::string_view text) {
    ChunkFormat<WordChunk> format;
    format.parse = [text](WordChunk& chunk, std::uint64_t most) {
        const char* const begin = text.data();
        const char* const end = begin + text.size();
        const char* at = skip_blanks(begin + chunk.begin, end);
        chunk.after = chunk.before;
        while (at < begin + chunk.limit && chunk.words.size() <= most) {
            const std::string_view word = word_at(at, end);
            if (word == "?") {
                chunk.fault = TextFault{static_cast<std::size_t>(at - begin), "another word"};
                break;
            }
            if (chunk.words.size() == most)
                break;
            if (word == "[" || word == "]")
                chunk.after = word == "[" ? 1 : 0;
            chunk.words.push_back((chunk.after != 0 ? "in " : "out ") + std::string(word));
            at = skip_blanks(at + word.size(), end);
        }
        chunk.end = static_cast<std::size_t>(at - begin);
    };
    // Anywhere, also within a word.
    format.find_cut = [](std::size_t from, std::size_t) {
        return from;
    };
    return format;
}

struct Outcome {
    std::vector<std::string> words;
    std::string error;
    std::uint64_t last_line = 0; ///< of the last word

    friend bool operator==(const Outcome&, const Outcome&) = default;
};

Outcome parse(const std::string& text, std::size_t chunk_bytes, std::size_t chunks_ahead, unsigned threads) {
    const ByteSource source = copy_bytes(std::as_bytes(std::span(text)), "words");
    const Execution execution{.threads = threads};
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::read, text.size());
    ChunkParser<WordChunk> parser(source, 0, word_format(source.text()), executor, progress, chunks_ahead,
                                  chunk_bytes);
    Outcome outcome;
    std::size_t end = 0;
    const std::vector<WordChunk> chunks = parser.rest([&](const WordChunk& chunk) {
        EXPECT_EQ(chunk.begin, end);
        end = chunk.end;
        outcome.words.insert(outcome.words.end(), chunk.words.begin(), chunk.words.end());
        if (!chunk.words.empty())
            outcome.last_line = parser.line_of_triangle(chunk, chunk.words.size() - 1);
    });
    try {
        if (chunks.back().fault)
            refuse_text(source, *chunks.back().fault);
    } catch (const Error& error) {
        outcome.error = error.what();
    }
    EXPECT_EQ(end == text.size(), outcome.error.empty());
    return outcome;
}

void expect_same_in_any_chunks(const std::string& text, const std::string& error = {}) {
    const Outcome whole = parse(text, text.size() + 1, 1, 1);
    EXPECT_EQ(whole.error, error);
    for (const std::size_t chunk_bytes : {1U, 2U, 3U, 7U, 64U})
        for (const std::size_t ahead : {1U, 2U, 1000U})
            for (const unsigned threads : {1U, 3U})
                EXPECT_EQ(parse(text, chunk_bytes, ahead, threads), whole)
                    << chunk_bytes << " bytes, " << ahead << " ahead";
}

std::string some_text() {
    std::mt19937 random(5);
    std::string text;
    for (int i = 0; i < 300; ++i)
        text += std::array{"a", "word", "[", "]", "\n", "\r\n", "long-one", "   "}[random() % 8] +
                std::string(random() % 3 == 0 ? "\n" : " ");
    return text;
}

TEST(TextChunks, OfAnySizeGiveWhatOnePieceGives) {
    expect_same_in_any_chunks(some_text());
    expect_same_in_any_chunks("one");
    expect_same_in_any_chunks("  \n");
    expect_same_in_any_chunks("[ a");
    expect_same_in_any_chunks(std::string(200, 'x') + " [" + std::string(200, ' ') + "y");
}

TEST(TextChunks, NameTheLineOfTheFirstFaultWhereverItStands) {
    const std::string text = some_text();
    expect_same_in_any_chunks("? " + text, "words: line 1: found '?', expected another word");
    expect_same_in_any_chunks("a\n\r\n\r?\n" + text + "? ",
                              "words: line 4: found '?', expected another word");
    const ByteSource source = copy_bytes(std::as_bytes(std::span(text)), "words");
    expect_same_in_any_chunks(text + " ?", fmt::format("words: line {}: found '?', expected another word",
                                                       line_of(source, text.size())));
}

TEST(TextChunks, ReportWhatTheFaultFound) {
    const std::string text = "a b\nc";
    const ByteSource source = copy_bytes(std::as_bytes(std::span(text)), "words");
    const auto error = [&](const TextFault& fault) -> std::string {
        try {
            refuse_text(source, fault);
        } catch (const Error& refused) {
            return refused.what();
        }
    };
    EXPECT_EQ(error({0, "x"}), "words: line 1: found 'a', expected x");
    EXPECT_EQ(error({3, "x"}), "words: line 1: found the end of the line, expected x");
    EXPECT_EQ(error({5, "x"}), "words: line 2: found the end of the file, expected x");
    EXPECT_EQ(error({4, "this is wrong", false}), "words: line 2: this is wrong");
}

TEST(TextChunks, BeginWithTheFirstWordOfALine) {
    const std::string_view text = "a\\\n b\\\r\n c\r\n\n  d\re";
    EXPECT_EQ(find_line(text, 1, text.size()), text.find('d'));
    EXPECT_EQ(find_line(text, text.find('d'), text.size()), text.find('e'));
    EXPECT_EQ(find_line(text, text.find('d'), text.find('e')), nowhere);
    EXPECT_EQ(find_line(text, text.find('e'), text.size()), nowhere);
}

TEST(TextChunks, EndWhereTheProgressFunctionThrows) {
    const std::string text = some_text();
    const ByteSource source = copy_bytes(std::as_bytes(std::span(text)), "words");
    std::size_t reports = 0;
    const Execution execution{.threads = 1, .progress = [&](const Progress& progress) {
                                  reports += progress.done == progress.total ? 0 : 1;
                                  if (progress.done > progress.total / 2)
                                      throw Error(ErrorKind::cancelled, "enough");
                              }};
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::read, text.size());
    ChunkParser<WordChunk> parser(source, 0, word_format(source.text()), executor, progress, 4, 8);
    EXPECT_THROW(static_cast<void>(parser.rest([](const WordChunk&) {})), Error);
    EXPECT_GT(reports, 10U);
}

/// A fault in the first and in the last megabyte of a text of lines.
TEST(TextChunks, OfLinesNameTheLineOfAFault) {
    std::string vertices;
    constexpr int rows = 150'000;
    for (int i = 0; i < rows; ++i)
        vertices += fmt::format("v {} 0.25 1\n", i);
    for (const int bad : {1, rows - 1}) {
        std::string text = vertices;
        const std::string line = fmt::format("v {} 0.25 1\n", bad);
        const std::size_t at = text.find("\n" + line) + 1;
        text.replace(at, line.size(), "v 1 bad 1\n");
        const std::string error = fmt::format("line {}: found 'bad', expected a number", bad + 1);
        EXPECT_EQ(mesh_test::error_of(text, "part.obj"), "part.obj: " + error);
        std::string off = fmt::format("OFF {} 1 0\n", rows);
        for (std::size_t i = 0; i < text.size(); i = text.find('\n', i) + 1)
            off += text.substr(i + 2, text.find('\n', i) - i - 1);
        EXPECT_EQ(mesh_test::error_of(off + "3 0 1 2\n", "part.off"),
                  fmt::format("part.off: line {}: found 'bad', expected a number", bad + 2));
    }
}

} // namespace
} // namespace lamella::pieces_test
