#pragma once

// Sums up what is bare on parallel lines, as areas and as spots.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella {

/// A piece of a line.
struct Piece {
    double from;
    double to;
};

/// Sums up pieces of lines: all of them in one area, and only large spots of them in another one. Pieces of
/// neighbouring lines that overlap belong to the same spot.
class BareSum {
  public:
    explicit BareSum(double largest_tip) : largest_tip_(largest_tip) {}

    void add(double length) noexcept { sum_ += length; }
    /// Adds a piece of a spot, after those of the lines before and those before it on its line.
    void add_to_spot(std::size_t line, Piece piece) {
        if (line != line_) {
            end_line();
            if (line != line_ + 1)
                end_line(); // all spots have ended
            line_ = line;
        }
        const auto spot = static_cast<std::uint32_t>(spots_.size());
        spots_.push_back({spot, piece.to - piece.from});
        while (next_ < before_.size() && before_[next_].piece.to < piece.from)
            ++next_;
        for (std::size_t i = next_; i < before_.size() && before_[i].piece.from <= piece.to; ++i)
            join(before_[i].spot, spot);
        here_.push_back({piece, spot});
    }
    [[nodiscard]] double sum() {
        end_line();
        end_line();
        return sum_;
    }

  private:
    struct InSpot {
        Piece piece;
        std::uint32_t spot;
    };
    struct Spot {
        std::uint32_t parent; ///< itself, or a spot that it was joined to
        double size;
    };

    std::uint32_t root(std::uint32_t spot) {
        while (spots_[spot].parent != spot)
            spot = spots_[spot].parent = spots_[spots_[spot].parent].parent;
        return spot;
    }
    void join(std::uint32_t one, std::uint32_t other) {
        one = root(one);
        other = root(other);
        if (one == other)
            return;
        spots_[other].parent = one;
        spots_[one].size += spots_[other].size;
    }
    /// Makes the line the one before. Counts the spots that have no piece on it, and forgets them.
    void end_line() {
        std::vector<Spot> left;
        for (InSpot& piece : here_) {
            const std::uint32_t spot = root(piece.spot);
            if (spots_[spot].size > 0) { // not yet moved to `left`
                const auto number = static_cast<std::uint32_t>(left.size());
                left.push_back({number, spots_[spot].size});
                spots_[spot] = {spot, -static_cast<double>(number)};
            }
            piece.spot = static_cast<std::uint32_t>(-spots_[spot].size);
        }
        for (std::uint32_t spot = 0; spot < spots_.size(); ++spot)
            if (spots_[spot].parent == spot && spots_[spot].size > largest_tip_)
                sum_ += spots_[spot].size;
        spots_ = std::move(left);
        before_.swap(here_);
        here_.clear();
        next_ = 0;
    }

    double largest_tip_; ///< mm of lines
    double sum_ = 0;
    std::size_t line_ = 0;
    std::vector<InSpot> before_; ///< on the line before
    std::size_t next_ = 0;       ///< of these, the first one that further pieces may overlap
    std::vector<InSpot> here_;
    std::vector<Spot> spots_; ///< of both lines
};

} // namespace lamella
