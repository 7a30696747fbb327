#pragma once

// Names as strings of files. What is no printable UTF-8 stands there as \xNN.

#include <string>
#include <string_view>

namespace lamella {

/// As it stands there; what is longer than 64 KiB is cut.
[[nodiscard]] std::string quotable(std::string_view text);
/// The same for labels in binary formats; what is longer than 4 KiB is cut.
[[nodiscard]] std::string printable_label(std::string_view text);
/// With quotation marks.
[[nodiscard]] std::string json_quoted(std::string_view text);
/// The same, such that it can stand in an element of a page: no tag begins in it.
[[nodiscard]] std::string page_quoted(std::string_view text);
/// Without quotation marks, for text and attributes.
[[nodiscard]] std::string xml_escaped(std::string_view text);

} // namespace lamella
