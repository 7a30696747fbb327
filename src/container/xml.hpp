#pragma once

// Reading XML as a stream of elements.

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

/// The name of an element or attribute. Where namespaces are resolved, `space` is the URI of its namespace
/// (empty for none) and `local` the name in it; elsewhere `space` is empty and `local` the name as written,
/// prefix and all.
struct XmlName {
    std::string_view space;
    std::string_view local;

    friend bool operator==(const XmlName&, const XmlName&) = default;
};

/// An element's attributes in the order of the file.
class XmlAttributes {
  public:
    explicit XmlAttributes(const char** pairs) : pairs_(pairs) {}

    /// The value, or an empty view without data() when there is no such attribute. An attribute without a
    /// prefix is in no namespace.
    [[nodiscard]] std::string_view find(std::string_view local) const noexcept;
    [[nodiscard]] std::string_view find(XmlName name) const noexcept;

  private:
    const char** pairs_; // name, value, ..., null
};

/// What may be left out is called only where it is given.
struct XmlHandlers {
    /// `line` counts from 1. Views live for the length of the call.
    std::function<void(XmlName name, const XmlAttributes& attributes, std::size_t line)> start;
    std::function<void(XmlName name)> end;
    /// Called for each few megabytes with the bytes read since the last time; may throw to stop.
    std::function<void(std::size_t bytes)> progress = {};
    /// Text between tags, in pieces.
    std::function<void(std::string_view text)> text = {};
    /// A prefix (empty for the default one) and its namespace, before the element that declares it starts.
    std::function<void(std::string_view prefix, std::string_view space)> declare = {};

    /// Elements that come in such numbers that they are read otherwise: where one of the tags in `many` (such
    /// as "<vertex") follows another tag, nothing but blanks between them, `skim` gets the whole document and
    /// the place of that tag, and says how many bytes from there on the parser is not to see: whole elements,
    /// well-formed, which is the handler's promise. 0 lets the parser read them; then `skim` may not be asked
    /// again for a while.
    std::vector<std::string_view> many = {};
    std::function<std::size_t(std::string_view document, std::size_t place)> skim = {};
};

struct XmlRules {
    /// Resolve namespaces (see XmlName).
    bool namespaces = false;
    /// Refuse encodings other than UTF-8, also when only the document says that it has one.
    bool utf8_only = false;
    /// Refuse any document type declaration; else only those with definitions of their own.
    bool no_document_type = false;
};

/// A value without the blanks around it, which say nothing in most XML files.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// Parses a whole document. Refused are entities of the document's own, nesting deeper than 256, elements of
/// more than 1000 attributes, and tags and comments longer than 64 MB. What the handlers throw ends parsing
/// and is thrown again. Throws Error{input} with file, line and what is wrong.
void parse_xml(std::string_view bytes, const std::string& name, const XmlHandlers& handlers,
               const XmlRules& rules = {});

} // namespace lamella
