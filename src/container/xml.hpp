#pragma once

// Reads XML as a stream of elements.

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
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

    /// Returns the value, or an empty view without data() if there is no such attribute. An attribute without
    /// a prefix is in no namespace.
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
    /// Called after every few megabytes with the number of bytes read since the last call; may throw to stop.
    std::function<void(std::size_t bytes)> progress = {};
    /// Text between tags; one text may take several calls.
    std::function<void(std::string_view text)> text = {};
    /// A prefix (empty for the default one) and its namespace; called before the element that declares them
    /// starts.
    std::function<void(std::string_view prefix, std::string_view space)> declare = {};

    /// Reads numerous elements without the parser. If one of the tags in `many` (such as "<vertex") follows
    /// another tag, with only blanks between them, `skim` is called with the whole document and the offset of
    /// that tag. It returns how many bytes from there the parser must skip; the handler guarantees that these
    /// are whole, well-formed elements. If it returns 0, the parser reads the elements, and `skim` may not be
    /// called again for a while.
    std::vector<std::string_view> many = {};
    std::function<std::size_t(std::string_view document, std::size_t position)> skim = {};
};

struct XmlRules {
    /// Resolves namespaces (see XmlName).
    bool namespaces = false;
    /// Refuses encodings other than UTF-8, even if only the document declares them.
    bool utf8_only = false;
    /// Refuses any document type declaration; otherwise only those with definitions of their own are refused.
    bool no_document_type = false;
};

/// Returns the text without the blanks around it, which carry no meaning in most XML files.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// Parses a whole document. An exception of a handler ends parsing and is rethrown. Throws Error{input} with
/// file, line and reason if the document is malformed, or has entities of its own, nesting deeper than 256,
/// an element of more than 1000 attributes, or a tag or comment longer than 64 MB.
void parse_xml(std::string_view bytes, const std::string& name, const XmlHandlers& handlers,
               const XmlRules& rules = {});

} // namespace lamella
