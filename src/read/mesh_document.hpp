#pragma once

// Reads XML documents with meshes, element by element. Sequences of vertices and triangles may be skipped and
// left to `read/mesh_text`.

#include "lamella/core/error.hpp"
#include "lamella/mesh/indexed_mesh.hpp"

#include "container/xml.hpp"
#include "read/mesh_text.hpp"
#include "read/read_limits.hpp"

#include <fmt/format.h>

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

/// The function that handles an element in a certain parent. It returns the kind of the element, as the
/// parent of the elements in it.
template <class Where, class Step>
struct ElementRule {
    Where in;
    std::string_view element;
    Step step;
};

/// Returns the function, or null if the element has no meaning in this parent.
template <class Where, class Step, std::size_t count>
[[nodiscard]] Step step_for(const std::array<ElementRule<Where, Step>, count>& rules, Where in,
                            std::string_view element) {
    for (const ElementRule<Where, Step>& rule : rules)
        if (rule.in == in && rule.element == element)
            return rule.step;
    return nullptr;
}

/// Reads a document; its `objects` have a `mesh` and a `text` each. A `Where` is the parent of an element:
/// `outside` of the root element, the `vertices` or `triangles` of the last object, ...
template <class Document, class Where>
class MeshDocumentReader {
  public:
    MeshDocumentReader(const MeshDocumentReader&) = delete;
    MeshDocumentReader& operator=(const MeshDocumentReader&) = delete;
    /// Subtracts the document from the limits, unless take() was called.
    virtual ~MeshDocumentReader() { limits_.give_back(triangles_, bytes_); }

  protected:
    /// `name` is the document's name in errors; positions in it are lines, preceded by `part`. If `skim` is
    /// not null, sequences of vertices and triangles are left unread in `text`; its threads find their ends.
    MeshDocumentReader(const std::string& name, const std::string& part, Executor* skim, ReadLimits& limits)
        : name_(name), part_(part), skim_(skim), limits_(limits) {}

    /// Returns the kind of the element.
    virtual Where start(XmlName name, const XmlAttributes& attributes) = 0;
    virtual void end(Where ended) = 0;

    /// Parses the text; sets the handlers that `handlers` lacks.
    void parse(std::string_view text, const MeshTextForm& form, XmlHandlers handlers,
               const XmlRules& rules = {}) {
        handlers.start = [this](XmlName name, const XmlAttributes& attributes, std::size_t line) {
            line_ = line;
            where_.push_back(start(name, attributes));
        };
        handlers.end = [this](XmlName) {
            assert(where_.size() > 1);
            const Where ended = in();
            where_.pop_back();
            end(ended);
        };
        if (skim_ != nullptr) {
            handlers.many = {form.vertex.tag, form.triangle.tag};
            handlers.skim = [this, &form](XmlCursor& cursor) {
                skim(cursor, form);
            };
        }
        parse_xml(text, name_, handlers, rules);
    }

    /// Returns the document, which remains counted in the limits.
    [[nodiscard]] Document take() {
        assert(where_.size() == 1); // no element is open
        count_open();
        triangles_ = bytes_ = 0;
        return std::move(document_);
    }

    [[nodiscard]] Where in() const { return where_.back(); }
    [[nodiscard]] std::size_t line() const { return line_; }
    [[nodiscard]] Document& document() { return document_; }
    [[nodiscard]] auto& object() { return document_.objects.back(); }

    [[noreturn]] void fail(const std::string& what) const {
        throw Error(ErrorKind::input, fmt::format("{}, line {}: {}", name_, line_, what));
    }

    [[nodiscard]] std::string here() const { return fmt::format("{}line {}", part_, line_); }

    /// Counts memory; must be called before it is allocated. All threads share the limits, so the limits are
    /// updated only once for several elements.
    void count(std::uint64_t bytes, std::uint64_t triangles = 0) {
        constexpr std::uint64_t enough = 1 << 16;
        open_triangles_ += triangles;
        open_bytes_ += bytes;
        if (open_bytes_ >= enough || open_triangles_ >= enough)
            count_open();
    }

    /// Appends an item to a list of the document. Counts the memory of the list as it grows.
    template <class T>
    void append(std::vector<T>& items, T item) {
        if (items.size() == items.capacity()) {
            const std::size_t room = items.capacity();
            limits_.make_room(items, 1, [this] { return here(); });
            bytes_ += (items.capacity() - room) * sizeof(T);
        }
        items.push_back(std::move(item));
    }

    void add(const Point3& vertex) {
        require_all_by_parser();
        append(object().mesh.vertices, vertex);
    }
    void add(const TriangleIndices& triangle) {
        require_all_by_parser();
        count(0, 1);
        append(object().mesh.triangles, triangle);
    }

  private:
    void skim(XmlCursor& cursor, const MeshTextForm& form) {
        const bool vertices = in() == Where::vertices;
        if (!vertices && in() != Where::triangles)
            return;
        MeshText& text = object().text;
        text.location = here();
        text.prefixes.assign(cursor.prefixes().begin(), cursor.prefixes().end());
        take_run(cursor, vertices ? form.vertex.end_of_list : form.triangle.end_of_list,
                 vertices ? text.vertices : text.triangles, *skim_);
    }

    /// Fails if the document is skimmed, because the order of vertices would be lost if the parser read some
    /// of them.
    void require_all_by_parser() const {
        if (skim_ != nullptr)
            fail("found a mesh that is not written plainly");
    }

    void count_open() {
        triangles_ += open_triangles_;
        bytes_ += open_bytes_;
        limits_.add_triangles(std::exchange(open_triangles_, 0), here());
        limits_.add_bytes(std::exchange(open_bytes_, 0), here());
    }

    const std::string& name_;
    const std::string part_;
    Executor* const skim_;
    ReadLimits& limits_;
    std::uint64_t open_triangles_ = 0; ///< not yet counted in the limits
    std::uint64_t open_bytes_ = 0;
    std::uint64_t triangles_ = 0;
    std::uint64_t bytes_ = 0;
    Document document_;
    std::size_t line_ = 1;
    std::vector<Where> where_{Where::outside};
};

/// Returns `read(true)`, which skims, or `read(false)` if that fails, because the document may be valid
/// although it cannot be skimmed.
template <class Read>
[[nodiscard]] auto skimmed_or_parsed(const Read& read) {
    try {
        return read(true);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::input)
            throw;
    }
    return read(false);
}

} // namespace lamella
