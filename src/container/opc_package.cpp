#include "container/opc_package.hpp"

#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "container/xml.hpp"

#include <fmt/format.h>

#include <optional>

namespace lamella {

namespace {

/// Largest number of relationships of a part; each takes memory.
constexpr std::size_t most_relationships = std::size_t{1} << 20;

constexpr std::string_view relationships_space =
    "http://schemas.openxmlformats.org/package/2006/relationships";

/// Returns the name of the part that lists the relationships of `part`.
std::string list_of(std::string_view part) {
    const std::size_t slash = part.rfind('/');
    const std::size_t folder = slash == std::string_view::npos ? 0 : slash + 1;
    return fmt::format("{}_rels/{}.rels", part.substr(0, folder), part.substr(folder));
}

std::optional<int> hex_digit(char c) {
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return std::nullopt;
}

/// Decodes %20 and the like.
std::string decoded(std::string_view reference) {
    std::string text;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        if (reference[i] == '%' && i + 2 < reference.size()) {
            const auto high = hex_digit(reference[i + 1]);
            const auto low = hex_digit(reference[i + 2]);
            if (high && low) {
                text += static_cast<char>(*high * 16 + *low);
                i += 2;
                continue;
            }
        }
        text += reference[i];
    }
    return text;
}

/// Returns the name of the part that a reference in `part` refers to.
std::string resolved(std::string_view part, std::string_view reference) {
    std::string path(reference);
    if (!path.starts_with('/')) {
        const std::size_t slash = part.rfind('/');
        if (slash != std::string_view::npos)
            path.insert(0, part.substr(0, slash + 1));
    }
    // Resolves "." and "..".
    std::vector<std::string_view> steps;
    const std::string_view view = path;
    for (std::size_t at = 0; at <= view.size();) {
        const std::size_t end = std::min(view.find('/', at), view.size());
        const std::string_view step = view.substr(at, end - at);
        at = end + 1;
        if (step == ".." && !steps.empty())
            steps.pop_back();
        else if (!step.empty() && step != "." && step != "..")
            steps.push_back(step);
    }
    return fmt::format("{}", fmt::join(steps, "/"));
}

} // namespace

std::vector<OpcRelationship> opc_relationships(const ZipReader& package, std::string_view part) {
    std::vector<OpcRelationship> found;
    const ZipEntry* const entry = package.find(list_of(part));
    if (entry == nullptr)
        return found;
    const ByteSource source = package.read(*entry);
    XmlHandlers handlers;
    handlers.start = [&](XmlName name, const XmlAttributes& attributes, std::size_t line) {
        if (name != XmlName{relationships_space, "Relationship"})
            return;
        const std::string_view target = attributes.find("Target");
        const std::string_view type = attributes.find("Type");
        if (target.data() == nullptr || type.data() == nullptr)
            throw Error(ErrorKind::input,
                        fmt::format("{}, line {}: found a relationship without {}, expected "
                                    "Type and Target",
                                    source.name, line, type.data() == nullptr ? "Type" : "Target"));
        if (found.size() == most_relationships)
            throw Error(ErrorKind::input,
                        fmt::format("{}, line {}: found more than {} relationships of one part", source.name,
                                    line, most_relationships));
        const bool external = attributes.find("TargetMode") == "External";
        found.push_back({std::string(type),
                         external ? std::string(target) : opc_resolved(package, part, target), external,
                         line});
    };
    handlers.end = [](XmlName) {
    };
    parse_xml(source.text(), source.name, handlers,
              {.namespaces = true, .utf8_only = true, .no_document_type = true});
    return found;
}

std::string opc_resolved(const ZipReader& package, std::string_view part, std::string_view reference) {
    std::string name = resolved(part, reference);
    return package.find(name) != nullptr ? name : resolved(part, decoded(reference));
}

} // namespace lamella
