#include "read/three_mf_part.hpp"

#include "lamella/core/error.hpp"

#include "container/text_place.hpp"
#include "core/executor.hpp"
#include "read/decimal_text.hpp"
#include "read/mesh_text.hpp"
#include "read/three_mf_terms.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace lamella {

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
    if (!(std::abs(map.determinant()) > 0))
        fail(found + ", which flattens what it is applied to", "one that can be undone");
    return map;
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

ByteSource unpack_part(const ZipReader& package, const std::string& name) {
    const ZipEntry* const entry = package.find(name);
    if (entry == nullptr)
        throw Error(ErrorKind::input, fmt::format("{}: found no part '{}', to which the package refers",
                                                  package.name(), printable(name, 100)));
    return package.read(*entry);
}

void parse_part(const ByteSource& part, const std::function<void(const ThreeMfElement&)>& start,
                const std::function<void(XmlName)>& end, Executor& executor) {
    XmlHandlers handlers;
    handlers.start = [&](XmlName name, const XmlAttributes& attributes, std::size_t line) {
        start({part.name, name, attributes, line});
    };
    handlers.end = end;
    handlers.progress = [&](std::size_t) {
        executor.check_cancelled();
    };
    parse_xml(part.text(), part.name, handlers, three_mf_rules);
}

} // namespace lamella
