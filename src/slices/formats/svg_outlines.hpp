#pragma once

// Reads the elements that draw the layers of an SVG document: polygons, polylines and paths of straight
// lines.

#include "lamella/core/point.hpp"
#include "lamella/findings/findings.hpp"

#include "container/read_limits.hpp"
#include "container/xml.hpp"
#include "slices/engine/layer_assembly.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lamella {

/// An element of a document; valid during a call.
struct SvgElement {
    const std::string& document; ///< its name
    std::string_view name;       ///< as written
    const XmlAttributes& attributes;
    std::size_t line;

    /// Returns the name without its prefix.
    [[nodiscard]] std::string_view local() const;
    /// Returns the value of an attribute, or a view whose data() is null if there is none.
    [[nodiscard]] std::string_view operator[](std::string_view attribute) const {
        return attributes.find(attribute);
    }
    /// Returns the number that is the value of an attribute, if the element has it.
    [[nodiscard]] std::optional<double> number(std::string_view attribute) const;
    /// Returns whether the element fills its outlines by the even-odd rule; `inherited` is that of its
    /// parent.
    [[nodiscard]] bool is_even_odd(bool inherited) const;

    [[nodiscard]] auto location() const { return at_line(line); }
    [[noreturn]] void fail(const std::string& text) const;
};

/// The coordinates of a document.
class SvgCanvas {
  public:
    SvgCanvas() = default;
    explicit SvgCanvas(const SvgElement& root);

    /// Returns a point of an element in millimetres of the part.
    [[nodiscard]] Point2 placed(const Point2& point, const SvgElement& element) const;
    /// The same for a point of a path, in which Slic3r inverts the y axis.
    [[nodiscard]] Point2 placed_in_path(const Point2& point, const SvgElement& element) const {
        return placed({point.x, height_ - (point.y - corner_.y) + corner_.y}, element);
    }
    /// Returns a warning if the scale is unknown, otherwise "".
    [[nodiscard]] const std::string& warning() const { return warning_; }

  private:
    void read_scale(const SvgElement& root);

    double height_ = 0; ///< of the document, in units of its coordinates
    double scale_ = 1;  ///< millimetres per unit
    Point2 corner_;     ///< of the view box, in units
    Point2 origin_; ///< origin of the part in Lamella's own files; in other files coordinates are relative to
                    ///< a corner of the part
    std::string warning_;
};

/// The layer and the part to which outlines are added.
struct SvgDrawing {
    const SvgCanvas& canvas;
    RawLayer& layer;
    std::uint32_t part;
    ReadLimits& limits;
    Findings& found;
};

/// Adds a polygon, which is closed, or a polyline.
void add_svg_points(const SvgElement& element, bool closed, const SvgDrawing& to);
/// Adds straight outlines of a path: M, L, H, V and Z in both cases. `even_odd` is the rule of the layer.
void add_svg_path(const SvgElement& element, bool even_odd, const SvgDrawing& to);

} // namespace lamella
