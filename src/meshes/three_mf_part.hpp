#pragma once

// Code shared by all readers of 3MF packages: the root part, a part as a stream of elements, and the values
// of attributes.

#include "lamella/mesh/transform.hpp"

#include "container/opc_package.hpp"
#include "container/read_limits.hpp"
#include "container/xml.hpp"
#include "system/byte_source.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

class ReadLimits;

class Executor;
struct ThreeMfElement;

/// Namespaces by the prefixes that the root element of a part declares.
using ThreeMfSpaces = std::map<std::string, std::string>;

enum class ThreeMfObjectType { model, solid_support, support, surface, other };

/// A placed object: a component of another object, or an item of the build.
struct ThreeMfUse {
    std::uint32_t object = 0; ///< its id
    std::string part;         ///< part that defines it; empty for the part that uses it
    Transform placement;      ///< lengths in millimetres
    bool printable = true;
    std::size_t line = 0;
};

/// The value of an attribute of an element. If it is invalid, the functions throw the Error{input} of
/// ThreeMfElement::fail.
struct ThreeMfValue {
    const ThreeMfElement& element;
    std::string_view name;
    std::string_view text; ///< without the blanks around it
    bool is_there;

    /// These functions return an integer, which must not be negative in the first one.
    [[nodiscard]] std::uint32_t index() const;
    [[nodiscard]] std::int32_t whole() const;
    /// Returns a number within `farthest_coordinate`.
    [[nodiscard]] double number() const;
    [[nodiscard]] double number_or(double absent) const { return is_there ? number() : absent; }

  private:
    void require() const;
    [[noreturn]] void refuse(std::string_view expected) const;
};

/// An element of a part; valid during a call.
struct ThreeMfElement {
    const std::string& document; ///< name of the part in errors
    XmlName name;
    const XmlAttributes& attributes;
    std::size_t line;
    const ThreeMfSpaces& spaces;

    [[nodiscard]] ThreeMfValue operator[](std::string_view attribute) const;
    [[nodiscard]] ThreeMfValue operator[](XmlName attribute) const;

    /// Returns the unit of a <model> in millimetres.
    [[nodiscard]] double unit_mm() const;
    /// Returns the placement of a component or an item of the build, in the unit of the model; the identity
    /// if there is none. The attribute has the twelve numbers of a matrix M, row by row; a row vector v is
    /// mapped to v M.
    [[nodiscard]] Transform transform() const;

    /// Returns the extensions that a <model> requires. Throws Error{input} for extensions that the readers do
    /// not support.
    [[nodiscard]] std::set<std::string> required_extensions() const;
    /// Returns the type of an <object>.
    [[nodiscard]] ThreeMfObjectType object_type() const;
    /// Returns the contents of a <component> or an <item> of the build, in a part with this unit.
    [[nodiscard]] ThreeMfUse use(double unit_mm) const;

    /// Reads the values of the attributes `names`, and returns true.
    template <std::size_t count>
    bool take(const std::array<std::string_view, count>& names, std::array<double, count>& values) const {
        for (std::size_t k = 0; k < count; ++k)
            values[k] = (*this)[names[k]].number();
        return true;
    }
    template <std::size_t count>
    bool take(const std::array<std::string_view, count>& names, std::span<std::uint32_t> values) const {
        for (std::size_t k = 0; k < count; ++k)
            values[k] = (*this)[names[k]].index();
        return true;
    }

    /// Throws Error{input}: "x, part 'y', line 7: found `found`, expected `expected`".
    [[noreturn]] void fail(std::string_view found, std::string_view expected) const;
    [[nodiscard]] auto location() const { return at_line(line); }
};

/// Returns the name of the part that the package declares as its model, or the usual name if it declares
/// none.
[[nodiscard]] std::string root_model(const ZipReader& package);

/// Unpacks a part within the limits (see `unpacked_entry`). Throws Error{input} if there is no part with this
/// name.
[[nodiscard]] ByteSource unpack_part(const ZipReader& package, const std::string& name, ReadLimits& limits,
                                     Executor* helpers = nullptr);

/// Functions that are called for each element, and with the name of each element that ends.
struct ThreeMfHandlers {
    std::function<void(const ThreeMfElement&)> start;
    std::function<void(XmlName)> end = [](XmlName) {
    };
    /// Beginning of the tags of numerous elements, and a function that reads them; see XmlHandlers.
    std::string_view many = {};
    std::function<void(XmlCursor&)> skim = {};
};

/// Parses a part.
void parse_part(const ByteSource& part, const ThreeMfHandlers& handlers, const Executor& executor);

/// Parses elements of a part from `begin`, which is on line `line`, as parse_xml_elements does. `parent` is
/// the name of their parent as written. No namespace of `spaces` may need references.
[[nodiscard]] std::size_t parse_part_elements(const ByteSource& part, std::size_t begin, std::size_t limit,
                                              std::string_view parent, const ThreeMfSpaces& spaces,
                                              std::uint64_t line, const ThreeMfHandlers& handlers,
                                              const Executor& executor);

/// Rules of XML that each part of a 3MF package must satisfy.
inline constexpr XmlRules three_mf_rules{.namespaces = true, .utf8_only = true, .no_document_type = true};

} // namespace lamella
