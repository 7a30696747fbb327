#pragma once

// Conversions of names to strings in files. Bytes that are not printable UTF-8 become \xNN.

#include <string>
#include <string_view>

namespace lamella {

/// Returns the text with these replacements. Texts longer than 64 KiB are truncated.
[[nodiscard]] std::string quotable(std::string_view text);
/// Returns the same for labels in binary formats. Texts longer than 4 KiB are truncated.
[[nodiscard]] std::string printable_label(std::string_view text);
/// Returns a label in characters that all readers of the Common Layer Interface accept; others become '_'.
/// Readers differ on quotes, commas and letters beyond ASCII.
[[nodiscard]] std::string common_layer_label(std::string_view text);
/// Returns the text as a JSON string, with quotation marks.
[[nodiscard]] std::string json_quoted(std::string_view text);
/// Returns a JSON string for an element of an HTML page: no tag begins in it.
[[nodiscard]] std::string page_quoted(std::string_view text);
/// Returns the text escaped for XML text and attributes, without quotation marks.
[[nodiscard]] std::string xml_escaped(std::string_view text);

} // namespace lamella
