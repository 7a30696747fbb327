#include "meshes/three_mf_part.hpp"

#include "lamella/core/error.hpp"

#include "container/plain_values.hpp"
#include "container/read_limits.hpp"
#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "mesh/singular.hpp"
#include "meshes/three_mf_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace lamella {

namespace {

/// Extensions that a file may require although readers of meshes and slices ignore them.
constexpr std::array extensions = {
    three_mf::core,
    three_mf::production,
    three_mf::slices,
    three_mf::beams, // beams are refused
    three_mf::materials,
    three_mf::alternatives,
    std::string_view("http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07"),
};

constexpr std::array<std::pair<std::string_view, ThreeMfObjectType>, 5> types = {{
    {"model", ThreeMfObjectType::model},
    {"solidsupport", ThreeMfObjectType::solid_support},
    {"support", ThreeMfObjectType::support},
    {"surface", ThreeMfObjectType::surface},
    {"other", ThreeMfObjectType::other},
}};

/// `line` is the first one of the text.
XmlHandlers xml_handlers(const ByteSource& part, const ThreeMfHandlers& handlers, const ThreeMfSpaces& spaces,
                         std::uint64_t line, const Executor& executor) {
    XmlHandlers of_xml{
        .start =
            [&, line](XmlName name, const XmlAttributes& attributes, std::size_t line_of_text) {
                handlers.start(
                    {part.name, name, attributes, static_cast<std::size_t>(line + line_of_text - 1), spaces});
            },
        .end = handlers.end,
        .progress =
            [&](std::size_t) {
                executor.check_cancelled();
            }};
    if (handlers.skim) {
        of_xml.many = {handlers.many};
        of_xml.skim = handlers.skim;
    }
    return of_xml;
}

} // namespace

std::uint32_t ThreeMfValue::index() const {
    require();
    std::uint32_t value = 0;
    if (read_index(text.data(), text.data() + text.size(), value) != text.data() + text.size() ||
        text.empty())
        refuse("a whole number");
    return value;
}

std::int32_t ThreeMfValue::whole() const {
    require();
    std::int32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        refuse("a whole number");
    return value;
}

double ThreeMfValue::number() const {
    require();
    double value = 0;
    if (read_decimal(text.data(), text.data() + text.size(), value) != text.data() + text.size() ||
        text.empty() || !(std::abs(value) <= farthest_coordinate))
        refuse(fmt::format("a number within {}", farthest_coordinate));
    return value;
}

void ThreeMfValue::require() const {
    if (!is_there)
        element.fail(fmt::format("an element without {}", name), "a number there");
}

void ThreeMfValue::refuse(std::string_view expected) const {
    element.fail(fmt::format("{} = '{}'", name, printable(text, 40)), expected);
}

ThreeMfValue ThreeMfElement::operator[](std::string_view attribute) const {
    const std::string_view text = attributes.find(attribute);
    return {*this, attribute, trimmed(text), text.data() != nullptr};
}

ThreeMfValue ThreeMfElement::operator[](XmlName attribute) const {
    const std::string_view text = attributes.find(attribute);
    return {*this, attribute.local, trimmed(text), text.data() != nullptr};
}

double ThreeMfElement::unit_mm() const {
    const ThreeMfValue unit = (*this)["unit"];
    if (!unit.is_there)
        return 1;
    constexpr std::array<std::pair<std::string_view, double>, 6> units{{{"micron", 0.001},
                                                                        {"millimeter", 1},
                                                                        {"centimeter", 10},
                                                                        {"inch", 25.4},
                                                                        {"foot", 304.8},
                                                                        {"meter", 1000}}};
    for (const auto& [known, mm] : units)
        if (known == unit.text)
            return mm;
    fail(fmt::format("unit '{}'", printable(unit.text, 40)),
         "micron, millimeter, centimeter, inch, foot or meter");
}

Transform ThreeMfElement::transform() const {
    Transform map;
    const ThreeMfValue numbers = (*this)["transform"];
    if (!numbers.is_there)
        return map;
    const std::string found = fmt::format("transform '{}'", printable(numbers.text, 200));
    std::array<double, 12> m{};
    std::string_view rest = numbers.text;
    for (double& number : m) {
        const char* const end = rest.data() + rest.size();
        const char* const stop = read_decimal(rest.data(), end, number);
        if (stop == nullptr || !(std::abs(number) <= farthest_coordinate) ||
            (stop != end && !trimmed({stop, 1}).empty()))
            fail(found, "12 numbers with blanks between them");
        rest = trimmed(rest.substr(static_cast<std::size_t>(stop - rest.data())));
    }
    if (!rest.empty())
        fail(found, "12 numbers and no more");
    for (std::size_t to = 0; to < 3; ++to) {
        for (std::size_t from = 0; from < 3; ++from)
            map.linear[to][from] = m[3 * from + to];
        map.offset[to] = m[9 + to];
    }
    if (singular(map))
        fail(found + ", which flattens what it is applied to", "one that can be undone");
    return map;
}

std::set<std::string> ThreeMfElement::required_extensions() const {
    std::set<std::string> required;
    std::string_view prefixes = (*this)["requiredextensions"].text;
    while (!prefixes.empty()) {
        const std::string prefix(prefixes.substr(0, prefixes.find_first_of(" \t\r\n")));
        prefixes = trimmed(prefixes.substr(prefix.size()));
        const auto space = spaces.find(prefix);
        if (space == spaces.end())
            fail(fmt::format("that the file requires the extension '{}' without saying what that is",
                             printable(prefix, 40)),
                 "a prefix that it declares");
        if (std::find(extensions.begin(), extensions.end(), space->second) == extensions.end())
            fail(fmt::format("that the file requires the extension '{}' ({}), which is not known here",
                             printable(prefix, 40), printable(space->second, 200)),
                 "none, or one that can be done without");
        required.insert(space->second);
    }
    return required;
}

ThreeMfObjectType ThreeMfElement::object_type() const {
    const ThreeMfValue type = (*this)["type"];
    if (!type.is_there)
        return ThreeMfObjectType::model;
    for (const auto& [word, known] : types)
        if (word == type.text)
            return known;
    fail(fmt::format("an object of type '{}'", printable(type.text, 40)),
         "model, solidsupport, support, surface or other");
}

ThreeMfUse ThreeMfElement::use(double unit_mm) const {
    ThreeMfUse use{.object = (*this)["objectid"].index(),
                   .part = std::string((*this)[XmlName{three_mf::production, "path"}].text),
                   .placement = transform(),
                   .printable = (*this)["printable"].text != "0",
                   .line = line};
    for (double& offset : use.placement.offset)
        offset *= unit_mm;
    return use;
}

void ThreeMfElement::fail(std::string_view found, std::string_view expected) const {
    throw Error(ErrorKind::input,
                fmt::format("{}, line {}: found {}, expected {}", document, line, found, expected));
}

std::string root_model(const ZipReader& package) {
    for (const OpcRelationship& relationship : opc_relationships(package, ""))
        if (relationship.type == three_mf::model_type && !relationship.external)
            return relationship.target;
    return std::string(three_mf::usual_root);
}

ByteSource unpack_part(const ZipReader& package, const std::string& name, ReadLimits& limits,
                       Executor* helpers) {
    const ZipEntry* const entry = package.find(name);
    if (entry == nullptr)
        throw Error(ErrorKind::input, fmt::format("{}: found no part '{}', to which the package refers",
                                                  package.name(), printable(name, 100)));
    return unpacked_entry(package, *entry, limits, helpers);
}

void parse_part(const ByteSource& part, const ThreeMfHandlers& handlers, const Executor& executor) {
    ThreeMfSpaces spaces;
    XmlHandlers of_xml = xml_handlers(part, handlers, spaces, 1, executor);
    of_xml.declare = [&](std::string_view prefix, std::string_view space) {
        spaces.emplace(prefix, space);
    };
    parse_xml(part.text(), part.name, of_xml, three_mf_rules);
}

std::size_t parse_part_elements(const ByteSource& part, std::size_t begin, std::size_t limit,
                                std::string_view parent, const ThreeMfSpaces& spaces, std::uint64_t line,
                                const ThreeMfHandlers& handlers, const Executor& executor) {
    std::string tag = fmt::format("<{}", parent);
    for (const auto& [prefix, space] : spaces)
        tag += fmt::format(" xmlns{}{}=\"{}\"", prefix.empty() ? "" : ":", prefix, space);
    tag += '>';
    return parse_xml_elements(part.text(), begin, limit, tag, part.name,
                              xml_handlers(part, handlers, spaces, line, executor), three_mf_rules);
}

} // namespace lamella
