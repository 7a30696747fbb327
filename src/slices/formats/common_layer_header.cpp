#include "slices/formats/common_layer_header.hpp"

#include "container/read_limits.hpp"
#include "container/xml.hpp"
#include "slices/formats/common_layer_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

namespace lamella {

namespace {

constexpr std::string_view end_command = "$$HEADEREND";

/// Returns the label at the beginning of a line, up to its closing quote or, without quotes, up to a comment
/// or command.
std::string_view label_of(std::string_view line) {
    line = trimmed(line);
    if (line.starts_with('"') && line.find('"', 1) != std::string_view::npos)
        return line.substr(1, line.find('"', 1) - 1);
    const std::size_t comment = line.find("//");
    if (comment != std::string_view::npos && line.find("//", comment + 2) != std::string_view::npos)
        line = line.substr(0, comment);
    return trimmed(line.substr(0, line.find("$$")));
}

/// Returns the part's number from "/1,name".
std::optional<std::int64_t> label_number(std::string_view line) {
    if (!line.starts_with('/'))
        return std::nullopt;
    line.remove_prefix(1);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
    return error == std::errc() ? std::optional(number) : std::nullopt;
}

/// Reads the six numbers of $$DIMENSION. The box is not important enough to refuse a file in which numbers
/// are missing or malformed.
std::optional<std::array<double, 6>> take_dimension(CommonLayerText& text,
                                                    std::vector<std::string>& warnings) {
    const std::size_t begin = text.at();
    std::array<double, 6> box{};
    for (std::size_t i = 0; i < box.size(); ++i) {
        if (!text.take(i == 0 ? "/" : ",") || !text.take_number(box[i])) {
            warnings.push_back(
                fmt::format("$$DIMENSION (line {}) has {} numbers and not six, two corners; it was left out",
                            text.line(begin), i));
            text.skip_to_command();
            return std::nullopt;
        }
    }
    return box;
}

} // namespace

CommonLayerHeader read_common_layer_header(std::string_view bytes, const std::string& name,
                                           ReadLimits& limits) {
    CommonLayerHeader header;
    CommonLayerText text(bytes, bytes.find(common_layer_start) + common_layer_start.size(), name);
    bool ascii = false;
    bool has_units = false;
    for (;;) {
        text.skip_blanks();
        if (text.done())
            text.fail("the end of the file", "the header must end with $$HEADEREND");
        if (text.take(end_command))
            break;
        if (!text.take("$$")) {
            text.skip_to_command(); // the standard allows other characters here, which are ignored
            continue;
        }
        const std::string_view command = text.take_command();
        if (command == "BINARY") {
            header.binary = true;
        } else if (command == "ASCII") {
            ascii = true;
        } else if (command == "ALIGN") {
            header.aligned = true;
        } else if (command == "UNITS") {
            text.expect('/', "the units");
            header.units_mm = text.last_number("the units");
            has_units = true;
            if (!(header.units_mm > 0))
                text.fail(fmt::format("units of {} mm", header.units_mm), "they must be above 0");
        } else if (command == "DIMENSION") {
            header.dimension = take_dimension(text, header.warnings);
        } else if (command == "LAYERS") {
            text.expect('/', "the number of layers");
            const double count = text.number("the number of layers");
            if (count >= 0 && count < 1e15)
                header.layers = static_cast<std::uint64_t>(count);
        } else if (command == "LABEL") {
            // The length is bounded because a file can be one line of many labels.
            constexpr std::size_t longest_line = std::size_t{1} << 13;
            std::string_view line = text.rest().substr(0, longest_line);
            line = line.substr(0, std::min(line.find('\n'), line.find('\r')));
            const std::size_t comma = line.find(',');
            if (const auto part = label_number(line); part && comma != std::string_view::npos) {
                const std::string_view label = label_of(line.substr(comma + 1));
                limits.add_bytes_at(node_bytes + label.size(), [&] { return text.line_text(); });
                header.labels.try_emplace(*part, label);
                if (!label.empty())
                    text.move_to(static_cast<std::size_t>(label.data() + label.size() - bytes.data()));
            }
            text.skip_to_command();
        } else if (command == "USERDATA") {
            // $$USERDATA/uid,length,bytes: the bytes can be anything.
            const std::size_t first = bytes.find(',', text.at());
            if (first == std::string_view::npos)
                text.fail("user data without a length", "it must read $$USERDATA/uid,length,data");
            text.move_to(first + 1);
            const double length = text.number("the length of the user data");
            text.expect(',', "the user data");
            if (!(length >= 0 && length <= static_cast<double>(bytes.size() - text.at())))
                text.fail(fmt::format("user data of {} bytes", length),
                          fmt::format("{} bytes are left in the file", bytes.size() - text.at()));
            text.move_to(text.at() + static_cast<std::size_t>(length));
        } else {
            text.skip_to_command(); // VERSION, DATE and other commands are not needed
        }
    }
    header.end = text.at();
    if (header.binary == ascii)
        text.fail(header.binary ? "both $$BINARY and $$ASCII" : "neither $$BINARY nor $$ASCII",
                  "the header must have one of them");
    if (!has_units)
        text.fail("no $$UNITS", "the header must say how many millimetres a unit is");
    return header;
}

} // namespace lamella
