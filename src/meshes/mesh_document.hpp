#pragma once

// Reads XML documents with meshes, element by element, and lists of vertices and triangles by
// `meshes/mesh_text`.

#include "lamella/core/error.hpp"
#include "lamella/mesh/indexed_mesh.hpp"

#include "container/read_limits.hpp"
#include "container/xml.hpp"
#include "meshes/mesh_text.hpp"

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

/// Reads a document; its `objects` have a `mesh` each. A `Where` is the parent of an element:
/// `outside` of the root element, the `vertices` or `triangles` of the last object, ...
template <class Document, class Where>
class MeshDocumentReader {
  public:
    MeshDocumentReader(const MeshDocumentReader&) = delete;
    MeshDocumentReader& operator=(const MeshDocumentReader&) = delete;
    /// Subtracts the document from the limits, unless take() was called.
    virtual ~MeshDocumentReader() { limits_.give_back(triangles_, bytes_); }

  protected:
    /// `name` is the document's name in errors; positions in it are lines, preceded by `part`. The threads
    /// read vertices and triangles.
    MeshDocumentReader(const std::string& name, const std::string& part, Executor& executor,
                       ReadLimits& limits)
        : name_(name), part_(part), executor_(executor), limits_(limits) {}

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
        handlers.many = {form.vertex.tag, form.triangle.tag};
        handlers.skim = [this, &form](XmlCursor& cursor) {
            if (in() == Where::vertices)
                read_plain(cursor, form.vertex, object().mesh.vertices, 0);
            else if (in() == Where::triangles)
                read_plain(cursor, form.triangle, object().mesh.triangles, 1);
        };
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
        make_room(items, 1);
        items.push_back(std::move(item));
    }

    void add(const Point3& vertex) { append(object().mesh.vertices, vertex); }
    void add(const TriangleIndices& triangle) {
        count(0, 1);
        append(object().mesh.triangles, triangle);
    }

    /// Removes the mesh of the last object.
    void drop_mesh() {
        const IndexedMesh mesh = std::exchange(object().mesh, {});
        give_back(mesh.triangles.size(), mesh.vertices.capacity() * sizeof(Point3) +
                                             mesh.triangles.capacity() * sizeof(TriangleIndices));
    }

  private:
    template <class T>
    void make_room(std::vector<T>& items, std::size_t more) {
        const std::size_t room = items.capacity();
        limits_.make_room(items, more, [this] { return here(); });
        bytes_ += (items.capacity() - room) * sizeof(T);
    }

    void give_back(std::uint64_t triangles, std::uint64_t bytes) {
        count_open();
        triangles_ -= triangles;
        bytes_ -= bytes;
        limits_.give_back(triangles, bytes);
    }

    /// Reads a list as far as it is plain. `triangles` is 1 if the items are triangles, otherwise 0.
    template <class Item>
    void read_plain(XmlCursor& cursor, const MeshTextKind<Item>& kind, std::vector<Item>& items,
                    std::uint64_t triangles) {
        std::size_t expected = items.size();
        read_list(
            cursor, kind, object().mesh.vertices.size(), items,
            [&](std::size_t more) {
                expected += more;
                count(0, more * triangles);
                make_room(items, more);
            },
            executor_);
        if (items.size() < expected)
            give_back((expected - items.size()) * triangles, 0);
    }

    void count_open() {
        triangles_ += open_triangles_;
        bytes_ += open_bytes_;
        limits_.add_triangles(std::exchange(open_triangles_, 0), here());
        limits_.add_bytes(std::exchange(open_bytes_, 0), here());
    }

    const std::string& name_;
    const std::string part_;
    Executor& executor_;
    ReadLimits& limits_;
    std::uint64_t open_triangles_ = 0; ///< not yet counted in the limits
    std::uint64_t open_bytes_ = 0;
    std::uint64_t triangles_ = 0;
    std::uint64_t bytes_ = 0;
    Document document_;
    std::size_t line_ = 1;
    std::vector<Where> where_{Where::outside};
};

} // namespace lamella
