#pragma once

// Walking through JSON text, value by value, without keeping it.

#include <cstddef>
#include <string>
#include <string_view>

namespace lamella {

/// A cursor. Values are taken in the order in which they stand; errors are Error{input} with the line.
class JsonText {
  public:
    /// Of the bytes from `begin` on; places are counted from the first byte.
    JsonText(std::string_view text, std::string name, std::size_t begin = 0)
        : text_(text), name_(std::move(name)), at_(begin) {}

    /// Calls member(key) for each member of the object that is next; that takes its value.
    template <class Member>
    void object(const Member& member) {
        open('{');
        for (bool first = true; !closes('}', first); first = false) {
            const std::string key = string();
            expect(':');
            member(key);
        }
    }

    /// Calls element() for each element of the array that is next; that takes it.
    template <class Element>
    void array(const Element& element) {
        open('[');
        for (bool first = true; !closes(']', first); first = false)
            element();
    }

    /// The next value, which must be a string or a number.
    std::string string();
    double number();
    /// Whatever is next.
    void skip();

    /// Nothing but blanks may be left.
    void end();
    /// Bytes taken so far.
    [[nodiscard]] std::size_t at() const noexcept { return at_; }

    /// At the value that is next.
    [[noreturn]] void fail(const std::string& found, const std::string& expected) const;
    /// What stands here, for texts of errors.
    [[nodiscard]] std::string here() const;

  private:
    void skip_blanks();
    /// Behind blanks.
    [[nodiscard]] bool is_next(char c);
    void open(char bracket);
    void expect(char c);
    bool closes(char bracket, bool first);
    void append_escaped(std::string& to);
    unsigned hex4();

    std::string_view text_;
    std::string name_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

} // namespace lamella
