#pragma once

// What all readers of 3MF packages share: which part is the root, a part as a stream of elements, and the
// values of their attributes.

#include "lamella/mesh/transform.hpp"

#include "container/xml.hpp"
#include "core/byte_source.hpp"
#include "read/opc_package.hpp"
#include "read/read_limits.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace lamella {

class Executor;
struct ThreeMfElement;

enum class ThreeMfObjectType { model, solid_support, support, surface, other };

/// An object that is put somewhere: a component of another one, or an item of the build.
struct ThreeMfUse {
    std::uint32_t object = 0; ///< its id
    std::string part;         ///< where it is defined; empty for the part that uses it
    Transform placement;      ///< lengths in millimetres
    bool printable = true;
    std::size_t line = 0;
};

/// What an attribute of an element says. What is wrong with it is Error{input}, as ThreeMfElement::fail has
/// it.
struct ThreeMfValue {
    const ThreeMfElement& element;
    std::string_view name;
    std::string_view text; ///< without the blanks around it
    bool is_there;

    /// A whole number from 0 on; of either sign.
    [[nodiscard]] std::uint32_t index() const;
    [[nodiscard]] std::int32_t whole() const;
    /// A number within `farthest_coordinate`.
    [[nodiscard]] double number() const;
    [[nodiscard]] double number_or(double absent) const { return is_there ? number() : absent; }

  private:
    void require() const;
    [[noreturn]] void refuse(std::string_view expected) const;
};

/// An element of a part; it lives for the length of a call.
struct ThreeMfElement {
    const std::string& document; ///< the part, as errors call it
    XmlName name;
    const XmlAttributes& attributes;
    std::size_t line;
    const std::map<std::string, std::string>& spaces; ///< by the prefixes that the root element declares

    [[nodiscard]] ThreeMfValue operator[](std::string_view attribute) const;
    [[nodiscard]] ThreeMfValue operator[](XmlName attribute) const;

    /// The millimetres of the unit of a <model>.
    [[nodiscard]] double unit_mm() const;
    /// How a component or an item of the build is placed, in the unit of the model: twelve numbers, row by
    /// row of a matrix that rows are multiplied with from the left. Where there are none, nothing moves.
    [[nodiscard]] Transform transform() const;

    /// The extensions that a <model> requires. Refuses those that readers of meshes and slices do not know.
    [[nodiscard]] std::set<std::string> required_extensions() const;
    /// Of an <object>.
    [[nodiscard]] ThreeMfObjectType object_type() const;
    /// What a <component> or an <item> of the build says, in a part of that unit.
    [[nodiscard]] ThreeMfUse use(double unit_mm) const;

    /// Throws Error{input}: "x, part 'y', line 7: found `found`, expected `expected`".
    [[noreturn]] void fail(std::string_view found, std::string_view expected) const;
    [[nodiscard]] auto place() const { return at_line(line); }
};

/// The part that the package names as its model, or the usual one where it names none.
[[nodiscard]] std::string root_model(const ZipReader& package);

/// Unpacks a part. Throws Error{input} when there is none of this name.
[[nodiscard]] ByteSource unpack_part(const ZipReader& package, const std::string& name);

/// Parses a part; `start` gets each element, `end` the name of each that ends.
void parse_part(const ByteSource& part, const std::function<void(const ThreeMfElement&)>& start,
                const std::function<void(XmlName)>& end, Executor& executor);

/// How each part of a 3MF package must be written.
inline constexpr XmlRules three_mf_rules{.namespaces = true, .utf8_only = true, .no_document_type = true};

} // namespace lamella
