#include "lamella/contour/measure.hpp"

#include "container/decimal.hpp"
#include "container/quoted.hpp"
#include "core/counted.hpp"
#include "slices/engine/grid.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/engine/left_out.hpp"
#include "slices/engine/sequential_writer.hpp"
#include "system/atomic_directory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace lamella {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t per_number = most_integer_digits + 6;

// Returns the grid point at or below a coordinate. Coordinates relative to it are on the same grid as
// absolute ones.
std::int64_t steps_below(double mm) {
    constexpr double most = 1e15;
    return static_cast<std::int64_t>(std::clamp(std::floor(mm / text_step_mm + 1e-6), -most, most));
}

GridPoint steps_below(const Point3& p) {
    return {steps_below(p.x), steps_below(p.y)};
}

// Writes "1,2 3.5,4 ", relative to `origin`, with a space after each point but the last.
void put_points(std::span<const GridPoint> points, const GridPoint& origin, ByteBuffer& out) {
    char* at = out.room(points.size() * 2 * per_number);
    for (const GridPoint& p : points) {
        at = put_thousandths(at, p.x - origin.x);
        *at++ = ',';
        at = put_thousandths(at, p.y - origin.y);
        *at++ = ' ';
    }
    out.end_at(at - 1);
}

// Heights of thin layers need more than the four decimals that Slic3r writes.
std::string height_text(double mm) {
    return decimal_text(mm, 9, 4);
}

/// A ring of a layer with its signed area, which determines order, direction and rounding.
struct MeasuredRing {
    std::size_t contour;
    double area;
};

// In older browsers without `:has`, the first layer stays visible below the one that the address names.
constexpr std::string_view screen_style =
    "  <style>@media screen {\n"
    "    svg { background: #808080 }\n"
    "    [id^=layer] { display: none; transform: scale(1, -1); transform-origin: center }\n"
    "    #layer0, [id^=layer]:target { display: inline }\n"
    "    svg:has([id^=layer]:target) #layer0:not(:target) { display: none }\n"
    "    polyline { stroke: red; vector-effect: non-scaling-stroke }\n"
    "  }</style>\n";

constexpr Holds layered_svg_holds{.written_label = quotable, .labels_mark_vectors = true};

class LayeredSvgWriter final : public SequentialWriter {
  public:
    LayeredSvgWriter(const std::string& path, const LayerFileInfo& info)
        : SequentialWriter(path, info, header(info), layered_svg_holds), origin_(steps_below(info.box.min)) {
        for (const PartInfo& part : info.parts)
            exposed_.push_back(part.exposure.has_value());
        if (info.parts.size() == 1 && info.parts.front().label == PartInfo{}.label)
            return;
        for (const PartInfo& part : info.parts)
            part_heads_.push_back(fmt::format("    <g data-lamella-part=\"{}\" data-lamella-label=\"{}\">\n",
                                              part_heads_.size() + 1,
                                              xml_escaped(label_in_file(part, layered_svg_holds))));
    }

  private:
    // Importers that know Slic3r's files take coordinates as millimetres and ignore title and style. Browsers
    // apply the style: they show a single layer, selected by the address, with y upwards.
    static std::string header(const LayerFileInfo& info) {
        const Box3& box = info.box;
        const auto mm = [](std::int64_t steps) {
            return decimal_text(static_cast<double>(steps) * text_step_mm, 3, 0);
        };
        const GridPoint origin = steps_below(box.min);
        return fmt::format(
            "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\"?>\n"
            "<svg width=\"{0}mm\" height=\"{1}mm\" viewBox=\"0 0 {0} {1}\" "
            "xmlns=\"http://www.w3.org/2000/svg\" "
            "xmlns:svg=\"http://www.w3.org/2000/svg\" "
            "xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
            "xmlns:slic3r=\"http://slic3r.org/namespaces/slic3r\" "
            "data-lamella-origin=\"{2} {3}\"{4}>\n"
            "  <title>{5}; a browser shows one of them: add #layer1 to the address for another</title>\n"
            "{6}",
            decimal_text(box.max.x - box.min.x, 6, 0), decimal_text(box.max.y - box.min.y, 6, 0),
            mm(origin.x), mm(origin.y),
            info.rule == PlaneRule::section_above
                ? std::string()
                : fmt::format(" data-lamella-rule=\"{}\"", plane_rule_name(info.rule)),
            counted(info.layers, "layer"), screen_style);
    }

    std::string layer_header(const PlanePosition& place) override {
        return fmt::format(
            "  <g id=\"layer{}\" slic3r:z=\"{}\" slic3r:slice-z=\"{}\" slic3r:layer-height=\"{}\">\n",
            place.position, height_text(place.top), height_text(place.z),
            height_text(place.top - place.bottom));
    }

    void format(const Plane& plane, ByteBuffer& out) const override {
        for (std::size_t part = 0; part < plane.polylines.size(); ++part) {
            if (!part_heads_.empty())
                out.append(part_heads_[part]);
            format_part(plane.polylines[part], exposed_[part], out);
            if (!part_heads_.empty())
                out.append("    </g>\n");
        }
        out.append("  </g>\n");
    }

    void format_part(const Layer& layer, bool exposed, ByteBuffer& out) const {
        // Rings are painted one after the other, so each must come after the larger ones around it. Contours
        // of scan vectors keep their order.
        std::vector<MeasuredRing> rings;
        for (std::size_t i = 0; i < layer.rings; ++i)
            rings.push_back({i, ring_area(layer.contour(i))});
        if (!exposed)
            std::stable_sort(rings.begin(), rings.end(), [](const MeasuredRing& a, const MeasuredRing& b) {
                return std::abs(a.area) > std::abs(b.area);
            });
        std::vector<GridPoint> scratch;
        for (const MeasuredRing& ring : rings) {
            const auto points =
                grid_.snap(layer.contour(ring.contour), true, ring.area, layer.index, scratch);
            if (points.empty())
                continue;
            const bool hole = ring.area < 0;
            out.append(hole ? R"(    <polygon slic3r:type="hole" points=")"
                            : R"(    <polygon slic3r:type="contour" points=")");
            put_points(points, origin_, out);
            out.append(hole ? R"(" style="fill: black" />)"
                              "\n"
                            : R"(" style="fill: white" />)"
                              "\n");
        }
        // Open chains are kept but not painted: a projector would cure them.
        for (std::size_t i = layer.rings; i < layer.contours(); ++i) {
            const auto points = grid_.snap(layer.contour(i), false, 0, layer.index, scratch);
            if (points.empty())
                continue;
            out.append(R"(    <polyline slic3r:type="open" points=")");
            put_points(points, origin_, out);
            out.append("\" style=\"fill: none\" />\n");
        }
    }

    std::string tail() override { return "</svg>\n"; }

    GridPoint origin_;
    std::vector<bool> exposed_; ///< true for parts of scan vectors
    /// Empty for a single part without a label, which needs no group.
    std::vector<std::string> part_heads_;
    WriterGrid grid_{text_step_mm, &rounding_loss()};
};

// First bytes of each image. They identify a folder of images that may be replaced.
constexpr std::string_view image_magic =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- A layer cut by Lamella -->\n";

bool is_our_image(const fs::path& path) {
    const std::string name = path.filename().string();
    return name.starts_with("layer_") && name.ends_with(".svg") && begins_with_magic(path, image_magic);
}

class SvgLayersWriter final : public OrderedWriter {
  public:
    SvgLayersWriter(const std::string& path, const LayerFileInfo& info)
        : OrderedWriter(info, {.supports = true}, Ascending::z_and_index), directory_(path, is_our_image),
          header_(header(info)) {}

    std::uint64_t bytes() const noexcept override { return directory_.bytes(); }

  private:
    // Each layer has a file of its own, which can be written in any order.
    Write formatted(const Plane& plane) override {
        const std::shared_ptr<ByteBuffer> text = buffer();
        format(plane.polylines, *text);
        directory_.write(fmt::format("layer_{:05}.svg", plane.polylines.front().index), text->view());
        return [](const PlanePosition&, Completions&) {
        };
    }

    void end_file() override { directory_.commit(); }

    // Returns the header of an image in millimetres, with y upwards. All images have the same frame: the box
    // of the part and a margin.
    static std::string header(const LayerFileInfo& info) {
        const Box3& box = info.box;
        const double margin = 0.03 * std::max(box.max.x - box.min.x, box.max.y - box.min.y) + 0.1;
        const double width = box.max.x - box.min.x + 2 * margin;
        const double height = box.max.y - box.min.y + 2 * margin;
        const auto mm = [](double v) {
            return decimal_text(v, 3, 0);
        };
        return fmt::format("{0}<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{1}mm\" height=\"{2}mm\" "
                           "viewBox=\"{3} {4} {1} {2}\">\n"
                           "<rect x=\"{3}\" y=\"{4}\" width=\"{1}\" height=\"{2}\" fill=\"#fdfdfb\"/>\n",
                           image_magic, mm(width), mm(height), mm(box.min.x - margin),
                           mm(-box.max.y - margin));
    }

    void format(std::span<const Layer> parts, ByteBuffer& out) const {
        out.append(header_);
        out.append(fmt::format("<title>Layer {}, z = {} mm</title>\n", parts.front().index,
                               height_text(parts.front().z)));
        out.append("<g transform=\"scale(1,-1)\" stroke-width=\"1\" stroke-linejoin=\"round\">\n");
        for (const Layer& layer : parts)
            format_part(layer, out);
        out.append("</g>\n</svg>\n");
    }

    void format_part(const Layer& layer, ByteBuffer& out) const {
        std::vector<GridPoint> scratch;
        const auto put_path = [&](std::size_t begin, std::size_t end, std::string_view style) {
            bool empty = true;
            for (std::size_t i = begin; i < end; ++i) {
                const bool closed = layer.closed(i);
                const auto points = grid_.snap(layer.contour(i), closed, 0, layer.index, scratch);
                if (points.empty())
                    continue;
                if (empty)
                    out.append(fmt::format("<path {} vector-effect=\"non-scaling-stroke\" d=\"", style));
                empty = false;
                out.append("M");
                put_points(points, {}, out);
                out.append(closed ? "Z\n" : "\n");
            }
            if (!empty)
                out.append("\"/>\n");
        };
        put_path(0, layer.rings, R"(fill="#8fb3cc" fill-rule="evenodd" stroke="#1d4e6b")");
        put_path(layer.rings, layer.contours(), R"(fill="none" stroke="#d62728")");
    }

    AtomicDirectory directory_;
    std::string header_;
    WriterGrid grid_{text_step_mm, &rounding_loss()};
};

} // namespace

std::unique_ptr<LayerWriter> open_layered_svg(const std::string& path, const LayerFileInfo& info,
                                              const LayerWriteOptions& /*options*/) {
    return std::make_unique<LayeredSvgWriter>(path, info);
}

std::unique_ptr<LayerWriter> open_svg_layers(const std::string& path, const LayerFileInfo& info,
                                             const LayerWriteOptions& /*options*/) {
    return std::make_unique<SvgLayersWriter>(path, info);
}

} // namespace lamella
