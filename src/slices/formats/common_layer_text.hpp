#pragma once

#include "lamella/core/error.hpp"

#include "container/coordinate_text.hpp"
#include "container/decimal_text.hpp"
#include "container/text_position.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace lamella {

/// A cursor over the text of a Common Layer Interface file. Its errors contain the number of the line.
class CommonLayerText {
  public:
    CommonLayerText(std::string_view text, std::size_t at, const std::string& name)
        : text_(text), at_(at), name_(name) {}

    [[nodiscard]] bool done() const { return at_ >= text_.size(); }
    [[nodiscard]] std::size_t at() const { return at_; }
    void move_to(std::size_t at) { at_ = at; }
    [[nodiscard]] std::string_view rest() const { return text_.substr(at_); }

    /// Skips blanks and // comments //.
    void skip_blanks() {
        while (!done()) {
            if (is_blank(text_[at_])) {
                ++at_;
            } else if (rest().starts_with("//")) {
                const std::size_t close = text_.find("//", at_ + 2);
                if (close == std::string_view::npos)
                    fail("a comment that does not end", "it must close with //");
                at_ = close + 2;
            } else {
                return;
            }
        }
    }

    /// Skips to the next command on this line, or to its end. Comments contain no commands.
    void skip_to_command() {
        bool in_comment = false;
        for (; !done() && !is_line_end(text_[at_]); ++at_) {
            if (rest().starts_with("//")) {
                in_comment = !in_comment;
                ++at_;
            } else if (!in_comment && rest().starts_with("$$")) {
                return;
            }
        }
    }

    bool take(std::string_view token) {
        if (!rest().starts_with(token))
            return false;
        at_ += token.size();
        return true;
    }

    /// Takes the letters of a command after "$$".
    std::string_view take_command() {
        const std::size_t begin = at_;
        while (!done() &&
               ((text_[at_] >= 'A' && text_[at_] <= 'Z') || (text_[at_] >= 'a' && text_[at_] <= 'z')))
            ++at_;
        return text_.substr(begin, at_ - begin);
    }

    double number(const char* what) {
        const std::size_t before = at_;
        skip_blanks();
        double value = 0;
        const char* const to = read_decimal(text_.data() + at_, text_.data() + text_.size(), value);
        if (to == nullptr)
            fail_behind(before, rest().substr(0, rest().find_first_of(", \t\r\n")),
                        fmt::format("{} must be a number", what));
        at_ = static_cast<std::size_t>(to - text_.data());
        return value;
    }

    /// Takes a number if there is one; otherwise skips only the blanks.
    bool take_number(double& value) {
        skip_spaces();
        const char* const to = read_decimal(text_.data() + at_, text_.data() + text_.size(), value);
        if (to == nullptr)
            return false;
        at_ = static_cast<std::size_t>(to - text_.data());
        skip_spaces();
        return true;
    }

    /// Takes a number, after which a blank, a comment or a command must follow, so that the rest of "1,5" or
    /// "1.5abc" is not silently skipped.
    double last_number(const char* what) {
        const std::size_t before = at_;
        skip_blanks();
        const std::size_t begin = at_;
        at_ = before;
        const double value = number(what);
        const bool ends =
            done() || is_blank(text_[at_]) || rest().starts_with("//") || rest().starts_with("$$");
        if (!ends) {
            at_ = begin;
            fail(fmt::format("'{}'", printable(rest().substr(0, rest().find_first_of(" \t\r\n")), 40)),
                 fmt::format("{} must be a number with a decimal point", what));
        }
        return value;
    }

    void expect(char separator, const char* what) {
        const std::size_t before = at_;
        skip_blanks();
        if (done() || text_[at_] != separator)
            fail_behind(before, rest().substr(0, 1),
                        fmt::format("'{}' must stand before {}", separator, what));
        ++at_;
    }

    /// Reports that a number is missing after offset `before`. A list of numbers may continue on the next
    /// line; if a command follows there instead, the error refers to `before`, where the list ends.
    [[noreturn]] void fail_behind(std::size_t before, std::string_view found, const std::string& expected) {
        const std::string_view blanks = text_.substr(before, at_ - before);
        if (done())
            fail("the end of the file", expected);
        if (rest().starts_with("$$") && blanks.find_first_of("\r\n") != std::string_view::npos) {
            at_ = before;
            fail("the end of the line", expected);
        }
        fail(fmt::format("'{}'", printable(found, 40)), expected);
    }

    [[nodiscard]] std::uint64_t line(std::size_t at) const { return line_at(text_, at); }
    /// Returns "line 12" for the position of the cursor.
    [[nodiscard]] std::string line_text() const { return fmt::format("line {}", line(at_)); }

    [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
        throw Error(ErrorKind::input,
                    fmt::format("{}, line {}: found {}; {}", name_, line_at(text_, at_), found, expected));
    }

  private:
    /// Skips blanks within the line.
    void skip_spaces() {
        while (!done() && is_blank(text_[at_]) && !is_line_end(text_[at_]))
            ++at_;
    }

    std::string_view text_;
    std::size_t at_;
    const std::string& name_;
};

} // namespace lamella
