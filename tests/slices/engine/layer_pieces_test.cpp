#include "container/text_position.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"
#include "slices/engine/layer_pieces.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace lamella::layer_pieces_cases {
namespace {

using test::Random;

/// The offsets of the words of a piece of a text, which are "layers".
struct Piece {
    std::vector<std::size_t> words;
    std::size_t end = 0;
};

Piece read_words(const std::string& text, std::size_t begin, std::size_t limit) {
    Piece piece;
    std::size_t at = begin;
    while (at < text.size() && (at < limit || at == begin)) {
        if (text[at] == '!')
            throw Error(ErrorKind::input, fmt::format("byte {}", at));
        piece.words.push_back(at);
        at = std::min(text.find(' ', at), text.size() - 1) + 1;
    }
    piece.end = at;
    return piece;
}

/// Returns the offsets of all words, or the error.
std::string outcome(const std::string& text, const PieceBegins& begins, unsigned threads) {
    Executor executor({.threads = threads});
    std::string found;
    try {
        read_pieces(
            begins, text.size(), executor,
            [&](std::size_t begin, std::size_t limit) { return read_words(text, begin, limit); },
            [&](Piece&& piece) {
                for (const std::size_t word : piece.words)
                    found += fmt::format("{} ", word);
            });
    } catch (const Error& error) {
        return error.what();
    }
    return found;
}

TEST(LayerPieces, GiveTheResultOfOneThreadWhereverTheyAreThoughtToBegin) {
    Random random(441);
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        std::string text;
        for (std::int64_t n = random.integer(1, 200); n > 0; --n)
            text += random.integer(0, 4) == 0 ? ' ' : random.integer(0, 150) == 0 ? '!' : 'x';
        PieceBegins begins{0};
        for (std::size_t at = 1; at < text.size(); ++at)
            if (random.integer(0, 9) == 0)
                begins.push_back(at);
        const std::string expected = outcome(text, {0}, 1);
        for (const unsigned threads : {1U, 2U, 7U})
            EXPECT_EQ(outcome(text, begins, threads), expected) << text;
    }
}

TEST(LayerPieces, OfTextsKnowTheirLines) {
    Random random(442);
    for (int round = 0; round < test::rounds_within_reason(20); ++round) {
        std::string text;
        while (text.size() < 3 * layer_piece_bytes)
            text += std::string(static_cast<std::size_t>(random.integer(0, 2000)), 'x') +
                    std::vector<std::string>{"\n", "\r\n", "\r", "LAYER"}[random.integer(0, 3)];
        const auto begin = static_cast<std::size_t>(random.integer(0, 5000));
        for (const unsigned threads : {1U, 3U}) {
            Executor executor({.threads = threads});
            const TextPieces pieces = find_text_pieces(text, begin, "LAYER", executor);
            EXPECT_GE(pieces.begins().size(), 3U);
            EXPECT_EQ(pieces.begins().front(), begin);
            for (const std::size_t at : pieces.begins()) {
                EXPECT_EQ(pieces.line(at), line_at(text, at));
                EXPECT_TRUE(at == begin || text.substr(at, 5) == "LAYER");
            }
            EXPECT_EQ(pieces.line(begin + 7), line_at(text, begin + 7));
        }
    }
}

} // namespace
} // namespace lamella::layer_pieces_cases
