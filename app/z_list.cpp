#include "z_list.hpp"

#include "lamella/core/error.hpp"

#include "numbers.hpp"
#include "standard_streams.hpp"
#include "text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <string_view>

namespace lamella::app {
namespace {

void append(std::vector<double>& z, double value, const std::string& location) {
    if (!z.empty() && !(value > z.back()))
        throw Error(ErrorKind::usage,
                    fmt::format("{}: {} is not above the height before it, {}; heights must ascend", location,
                                value, z.back()));
    z.push_back(value);
}

std::vector<double> from_json(const std::string& name, std::string_view content) {
    std::vector<double> z;
    const nlohmann::json list = nlohmann::json::parse(content, nullptr, false);
    if (!list.is_array())
        throw Error(ErrorKind::usage, fmt::format("{}: begins as a JSON list but is none", name));
    for (const nlohmann::json& item : list) {
        if (!item.is_number())
            throw Error(ErrorKind::usage,
                        fmt::format("{}: item {} of the list is not a number", name, z.size() + 1));
        append(z, item.get<double>(), fmt::format("{}: item {}", name, z.size() + 1));
    }
    return z;
}

std::vector<double> from_lines(const std::string& name, std::string_view content) {
    std::vector<double> z;
    std::size_t line = 0;
    while (!content.empty()) {
        ++line;
        const std::size_t end = content.find('\n');
        std::string_view text = content.substr(0, end);
        content.remove_prefix(end == std::string_view::npos ? content.size() : end + 1);
        text = text.substr(0, text.find('#'));
        while (!text.empty() && (text.back() == '\r' || text.back() == ' ' || text.back() == '\t'))
            text.remove_suffix(1);
        if (text.empty())
            continue;
        const std::string location = fmt::format("{}:{}", name, line);
        double value = 0;
        try {
            value = parse_number(text);
        } catch (const Error& error) {
            throw Error(error.kind(), fmt::format("{}: {}", location, error.what()));
        }
        append(z, value, location);
    }
    return z;
}

} // namespace

std::vector<double> read_z_list(const std::string& path) {
    const std::string content = read_text_file(path);
    const std::string name = input_name(path);
    const std::size_t first = content.find_first_not_of(" \t\r\n");
    std::vector<double> z = first != std::string::npos && content[first] == '[' ? from_json(name, content)
                                                                                : from_lines(name, content);
    if (z.empty())
        throw Error(ErrorKind::input, fmt::format("{}: lists no height to cut at", name));
    return z;
}

} // namespace lamella::app
