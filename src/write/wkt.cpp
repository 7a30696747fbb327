#include "write/wkt.hpp"

#include "write/decimal.hpp"
#include "write/grid_polygons.hpp"
#include "write/quoted.hpp"
#include "write/sequential_writer.hpp"

#include <fmt/format.h>

#include <string_view>
#include <vector>

namespace lamella {

namespace {

// "(1 2,3.5 4,1 2)"; a ring ends with its first point once more.
void put_points(std::span<const GridPoint> points, bool closed, ByteBuffer& out) {
    constexpr std::size_t per_point = 2 * (most_integer_digits + 6) + 2;
    char* at = out.room((points.size() + 1) * per_point + 2);
    const auto put = [&](const GridPoint& p) {
        at = put_thousandths(at, p.x);
        *at++ = ' ';
        at = put_thousandths(at, p.y);
        *at++ = ',';
    };
    *at++ = '(';
    for (const GridPoint& p : points)
        put(p);
    if (closed)
        put(points.front());
    at[-1] = ')';
    out.end_at(at);
}

class WktWriter final : public SequentialWriter {
  public:
    WktWriter(const std::string& path, const LayerFileInfo& info)
        : SequentialWriter(path, info, "WKT,z,bottom,top,layer,part,label\n",
                           {.open_chains = true, .hatches = false}) {
        for (const PartInfo& part : info.parts)
            labels_.push_back(csv_quoted(part.label));
    }

  private:
    std::string layer_head(const Place&) override { return {}; }

    void format(std::span<const Layer> parts, ByteBuffer& out) const override {
        for (std::size_t part = 0; part < parts.size(); ++part)
            format_part(parts[part], part, out);
    }

    void format_part(const Layer& layer, std::size_t part, ByteBuffer& out) const {
        const Nesting nested = nesting(layer);
        const std::string columns =
            fmt::format("\",{},{},{},{},{},{}\n", decimal_text(layer.z), decimal_text(layer.bottom),
                        decimal_text(layer.top), layer.index, part + 1, labels_[part]);
        std::vector<GridPoint> scratch;
        out.append("\"MULTIPOLYGON ");
        bool any = false;
        for_each_polygon(layer, nested, grid_, scratch, [&](bool first, std::span<const GridPoint> points) {
            if (first)
                out.append(any ? "),(" : "((");
            else
                out.append(",");
            put_points(points, true, out);
            any = true;
        });
        out.append(any ? "))" : "EMPTY");
        out.append(columns);
        any = false;
        for_each_line(layer, nested, grid_, scratch, [&](std::span<const GridPoint> points, bool closed) {
            out.append(any ? "," : "\"MULTILINESTRING (");
            put_points(points, closed, out);
            any = true;
        });
        if (any) {
            out.append(")");
            out.append(columns);
        }
    }

    std::vector<std::string> labels_;
    WriterGrid grid_{text_step_mm, &rounding_loss()};
};

} // namespace

std::unique_ptr<LayerWriter> open_wkt(const std::string& path, const LayerFileInfo& info,
                                      const LayerWriteOptions& /*options*/) {
    return std::make_unique<WktWriter>(path, info);
}

} // namespace lamella
