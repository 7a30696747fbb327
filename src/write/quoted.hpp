#pragma once

// Names as strings of files. Bytes that are not printable UTF-8 become \xNN.

#include <string>
#include <string_view>

namespace lamella {

/// Returns the text with these replacements; texts longer than 64 KiB are cut.
[[nodiscard]] std::string quotable(std::string_view text);
/// Does the same for labels in binary formats; texts longer than 4 KiB are cut.
[[nodiscard]] std::string printable_label(std::string_view text);
/// Returns the text as a JSON string, with quotation marks.
[[nodiscard]] std::string json_quoted(std::string_view text);
/// Returns the same for an element of a page: no tag begins in it.
[[nodiscard]] std::string page_quoted(std::string_view text);
/// Returns the text escaped for XML text and attributes, without quotation marks.
[[nodiscard]] std::string xml_escaped(std::string_view text);

} // namespace lamella
