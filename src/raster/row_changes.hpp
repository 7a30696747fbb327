#pragma once

// Changes of coverage along rows of pixels.

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace lamella {

/// The changes of coverage from one column to the next, for each of a few rows. Only columns with changes
/// cost time: one bit per column marks a change, and the values of other columns are never read. A row has
/// two columns more than the image.
class RowChanges {
  public:
    RowChanges(std::uint32_t width, std::uint32_t rows)
        : columns_(std::size_t{width} + 2), words_(columns_ / 64 + 1), changes_(new double[columns_ * rows]),
          changed_(words_ * rows), touched_(rows) {}

    /// A row, to which changes can be added.
    class Row {
      public:
        void add(std::size_t column, double by) noexcept {
            std::uint64_t& bits = changed_[column / 64];
            const std::uint64_t bit = std::uint64_t{1} << (column % 64);
            changes_[column] = ((bits & bit) != 0 ? changes_[column] : 0) + by;
            bits |= bit;
        }

        /// Adds one change to each of several columns, from `column` on.
        template <std::same_as<double>... Changes>
        void add_from(std::size_t column, Changes... by) noexcept {
            const std::size_t first = column % 64;
            if (first + sizeof...(by) <= 64) { // their bits are in one word, which is read once
                std::uint64_t& bits = changed_[column / 64];
                const std::uint64_t before = bits >> first;
                std::size_t i = 0;
                ((changes_[column + i] = ((before >> i & 1) != 0 ? changes_[column + i] : 0) + by, ++i), ...);
                bits |= ((std::uint64_t{1} << sizeof...(by)) - 1) << first;
            } else {
                (add(column++, by), ...);
            }
        }

      private:
        friend RowChanges;
        Row(double* changes, std::uint64_t* changed) noexcept : changes_(changes), changed_(changed) {}

        double* changes_;
        std::uint64_t* changed_;
    };
    [[nodiscard]] Row row(std::uint32_t row) noexcept {
        touched_[row] = 1;
        return {changes_.get() + columns_ * row, changed_.data() + words_ * row};
    }
    /// Returns whether anything was added since the row was cleared.
    [[nodiscard]] bool touched(std::uint32_t row) const noexcept { return touched_[row] != 0; }

    /// Calls found(column, change) from left to right.
    template <class Found>
    void for_each(std::uint32_t row, const Found& found) const {
        if (!touched(row))
            return;
        const double* const changes = changes_.get() + columns_ * row;
        const std::uint64_t* const changed = changed_.data() + words_ * row;
        for (std::size_t word = 0; word < words_; ++word) {
            for (std::uint64_t bits = changed[word]; bits != 0; bits &= bits - 1) {
                const std::size_t column = 64 * word + static_cast<std::size_t>(std::countr_zero(bits));
                found(column, changes[column]);
            }
        }
    }
    void clear(std::uint32_t row) noexcept {
        if (std::exchange(touched_[row], std::uint8_t{0}) != 0)
            std::fill_n(changed_.begin() + static_cast<std::ptrdiff_t>(words_ * row), words_,
                        std::uint64_t{0});
    }

  private:
    std::size_t columns_;
    std::size_t words_;
    std::unique_ptr<double[]> changes_;
    std::vector<std::uint64_t> changed_;
    std::vector<std::uint8_t> touched_;
};

} // namespace lamella
