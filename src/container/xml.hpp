#pragma once

// Reading XML as a stream of elements.

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

/// An element's attributes in the order of the file, names with their prefix as written.
class XmlAttributes {
  public:
    explicit XmlAttributes(const char** pairs) : pairs_(pairs) {}

    /// The value, or an empty view without data() when there is no such attribute.
    [[nodiscard]] std::string_view find(std::string_view name) const noexcept;

  private:
    const char** pairs_; // name, value, ..., null
};

struct XmlHandlers {
    /// `line` counts from 1. Views live for the length of the call.
    std::function<void(std::string_view name, const XmlAttributes& attributes, std::size_t line)> start;
    std::function<void(std::string_view name)> end;
    /// Called for each few megabytes with the bytes read since the last time; may throw to stop.
    std::function<void(std::size_t bytes)> progress;
};

/// Parses a whole document. Text between elements is passed over. A document type declaration, and with it
/// every entity of the document's own, is refused, and so is nesting deeper than 256. What the handlers throw
/// ends parsing and is thrown again. Throws Error{input} with file, line and what is wrong.
void parse_xml(std::string_view bytes, const std::string& name, const XmlHandlers& handlers);

} // namespace lamella
