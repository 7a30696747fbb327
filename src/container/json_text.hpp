#pragma once

// Reads JSON text value by value without storing it.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace lamella {

/// A cursor in a JSON text, which reads values in the order of the text. All errors are Error{input} with the
/// number of the line.
class JsonText {
  public:
    /// Reads the text from byte `begin` on; lines and `at` count from the first byte of the text. `depth` is
    /// the number of objects and arrays around it.
    JsonText(std::string_view text, std::string name, std::size_t begin = 0, int depth = 0)
        : text_(text), name_(std::move(name)), at_(begin), depth_(depth) {}

    /// Calls member(key) for each member of the next value, an object. `member` must read the member's value.
    template <class Member>
    void object(const Member& member) {
        open('{');
        for (bool first = true; !closes('}', first); first = false) {
            const std::string key = string();
            expect(':');
            member(key);
        }
    }

    /// Calls element() for each element of the next value, an array. `element` must read the element.
    template <class Element>
    void array(const Element& element) {
        open('[');
        for (bool first = true; !closes(']', first); first = false)
            element();
    }

    /// Moves from the end of an element of an array to the next element. Returns false at the end of the
    /// array, which is not read.
    bool next_element();

    /// Reads the next value, which must be a string. Of long strings, only the first 64 KB or slightly more are
    /// returned.
    std::string string();
    /// Reads the next value, which must be a number.
    double number();
    /// Skips the next value, of any type.
    void skip();

    /// Requires that only blanks remain.
    void end();
    /// Returns the offset of the next byte.
    [[nodiscard]] std::size_t at() const noexcept { return at_; }
    void move_to(std::size_t at) noexcept { at_ = at; }
    [[nodiscard]] int depth() const noexcept { return depth_; }

    /// Throws Error{input} with the number of the line of the next value.
    [[noreturn]] void fail(const std::string& found, const std::string& expected) const;
    /// Describes the text at the cursor, for error messages.
    [[nodiscard]] std::string here() const;

    void skip_blanks();

  private:
    /// Skips blanks first.
    [[nodiscard]] bool is_next(char c);
    void open(char bracket);
    void expect(char c);
    bool closes(char bracket, bool first);
    void append_escaped(std::string& to);
    unsigned hex4();

    std::string_view text_;
    std::string name_;
    std::size_t at_;
    int depth_;
};

} // namespace lamella
