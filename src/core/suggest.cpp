#include "lamella/core/suggest.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lamella {
namespace {

/// Returns the number of letters to insert, remove, replace or swap with their neighbour (restricted
/// Damerau-Levenshtein distance).
std::size_t changed_letters(std::string_view a, std::string_view b) {
    const std::size_t width = b.size() + 1;
    std::vector<std::size_t> table((a.size() + 1) * width);
    for (std::size_t i = 0; i <= a.size(); ++i) {
        for (std::size_t j = 0; j <= b.size(); ++j) {
            std::size_t& cell = table[i * width + j];
            if (i == 0 || j == 0) {
                cell = i + j;
                continue;
            }
            const std::size_t replaced = table[(i - 1) * width + j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            const std::size_t changed = std::min(table[(i - 1) * width + j], table[i * width + j - 1]) + 1;
            cell = std::min(replaced, changed);
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                cell = std::min(cell, table[(i - 2) * width + j - 2] + 1);
        }
    }
    return table.back();
}

} // namespace

std::string nearest(std::string_view word, std::span<const std::string> candidates) {
    // Longer words are not mistyped names, and the size of the table is proportional to the square of the
    // length.
    constexpr std::size_t longest = 64;
    if (word.size() > longest)
        return {};
    std::string best;
    std::size_t least = std::max<std::size_t>(word.size() / 3, 1) + 1;
    for (const std::string& candidate : candidates) {
        // A word that is the beginning of a name suggests that name.
        const bool begun = word.size() >= 3 && candidate.starts_with(word);
        const std::size_t d = begun ? 1 : changed_letters(word, candidate);
        if (d < least) {
            least = d;
            best = candidate;
        }
    }
    return best;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> candidates) {
    const std::string meant = nearest(word, candidates);
    return meant.empty() ? "" : "; did you mean " + meant + "?";
}

} // namespace lamella
