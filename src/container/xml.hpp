#pragma once

// Reads XML as a stream of elements.

#include "container/xml_cursor.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// The name of an element or attribute. If namespaces are resolved, `space` is the URI of its namespace
/// (empty for none) and `local` the name in it; otherwise `space` is empty and `local` is the name as
/// written, including the prefix.
struct XmlName {
    std::string_view space;
    std::string_view local;

    friend bool operator==(const XmlName&, const XmlName&) = default;
};

/// An element's attributes in the order of the file.
class XmlAttributes {
  public:
    explicit XmlAttributes(const char** pairs) : pairs_(pairs) {}

    /// Returns the value of the attribute, or a view whose data() is null if there is none. An attribute
    /// without a prefix is in no namespace.
    [[nodiscard]] std::string_view find(std::string_view local) const noexcept;
    [[nodiscard]] std::string_view find(XmlName name) const noexcept;

  private:
    const char** pairs_; // name, value, ..., null
};

/// Callbacks of the parser. Those with a default may be omitted.
struct XmlHandlers {
    /// `line` counts from 1. Views are valid during the call.
    std::function<void(XmlName name, const XmlAttributes& attributes, std::size_t line)> start;
    std::function<void(XmlName name)> end;
    /// Called every few megabytes with the number of bytes read since the last call; may throw to stop the
    /// parser.
    std::function<void(std::size_t bytes)> progress = {};
    /// Called with the size of an incomplete tag or text before the parser takes memory for more of it.
    std::function<void(std::size_t bytes)> hold = {};
    /// Text between tags; one text may take several calls.
    std::function<void(std::string_view text)> text = {};
    /// Called with each prefix (empty for the default namespace) and namespace that the root element declares,
    /// before its `start`.
    std::function<void(std::string_view prefix, std::string_view space)> declare = {};

    /// Called before `start` of each element within the root, or, by parse_xml_elements, within the parent,
    /// with its offset in the document, which must be UTF-8.
    std::function<void(std::size_t position)> element = {};

    /// Beginnings of the tags of numerous elements, such as "<vertex", which a handler can read faster than
    /// the parser. If such a tag follows another tag, with only blanks between them, and all namespaces are
    /// declared by the root element, `skim` is called with a cursor before it. The parser continues where
    /// `skim` leaves the cursor, within the elements that the cursor has entered. The handler guarantees that
    /// the elements before are well-formed. If they are not the rest of their parent, `skim` is not called
    /// again for a while.
    std::vector<std::string_view> many = {};
    std::function<void(XmlCursor& cursor)> skim = {};
};

struct XmlRules {
    /// Resolves namespaces (see XmlName).
    bool namespaces = false;
    /// Refuses encodings other than UTF-8, even if only the document declares them.
    bool utf8_only = false;
    /// Refuses any document type declaration; otherwise only those with definitions of their own are refused.
    bool no_document_type = false;
};

/// Returns the text without blanks at its beginning and end, which have no meaning in most XML files.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// Parses a whole document. An exception of a handler ends parsing and is rethrown. Throws Error{input} with
/// file, line and reason if the document is malformed, or has entities of its own, nesting deeper than 256,
/// an element of more than 1000 attributes, or a tag or comment longer than 64 MB.
void parse_xml(std::string_view bytes, const std::string& name, const XmlHandlers& handlers,
               const XmlRules& rules = {});

/// Parses elements of a document in UTF-8 that follow each other within one element, their parent: those from
/// `begin`, where an element begins, up to the first one at or after `limit`, or to the end of the parent.
/// Returns the offset of either. `parent` is the parent's start tag, with all namespaces that are declared
/// there. Lines count from `begin`. Otherwise like parse_xml.
[[nodiscard]] std::size_t parse_xml_elements(std::string_view document, std::size_t begin, std::size_t limit,
                                             std::string_view parent, const std::string& name,
                                             const XmlHandlers& handlers, const XmlRules& rules = {});

} // namespace lamella
