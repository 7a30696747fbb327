#include "container/decimal.hpp"
#include "container/quoted.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/engine/left_out.hpp"
#include "slices/engine/sequential_writer.hpp"

#include <fmt/format.h>

namespace lamella {

namespace {

// Writes "[1,2,3.5,4]": x and y in turn.
void put_numbers(std::span<const Point2> points, ByteBuffer& out) {
    char* at = out.room(points.size() * 2 * (most_double_digits + 1) + 2);
    *at++ = '[';
    for (const Point2& p : points) {
        at = put_shortest(at, p.x + 0.0);
        *at++ = ',';
        at = put_shortest(at, p.y + 0.0);
        *at++ = ',';
    }
    if (points.empty())
        ++at;
    at[-1] = ']';
    out.end_at(at);
}

constexpr Holds layers_json_holds{.hatches = true, .written_label = quotable, .labels_mark_vectors = true};

class LayersJsonWriter final : public SequentialWriter {
  public:
    LayersJsonWriter(const std::string& path, const LayerFileInfo& info)
        : SequentialWriter(path, info, header(info), layers_json_holds) {}

  private:
    static std::string header(const LayerFileInfo& info) {
        std::string text = "{\"format\":\"lamella layers\",\"version\":1,\"units\":\"mm\",\"parts\":[";
        for (const PartInfo& part : info.parts)
            text += fmt::format("{{\"label\":{}}},", json_quoted(label_in_file(part, layers_json_holds)));
        text.back() = ']';
        if (info.rule != PlaneRule::section_above)
            text += fmt::format(",\"rule\":\"{}\"", plane_rule_name(info.rule));
        return text + ",\"layers\":[";
    }

    std::string layer_header(const PlanePosition& place) override {
        return fmt::format("{}{{\"index\":{},\"z\":{},\"bottom\":{},\"top\":{},\"parts\":[",
                           place.position == 0 ? "\n" : ",\n", place.index, shortest_text(place.z),
                           shortest_text(place.bottom), shortest_text(place.top));
    }

    void format(const Plane& plane, ByteBuffer& out) const override {
        for (std::size_t part = 0; part < plane.polylines.size(); ++part) {
            const Layer& layer = plane.polylines[part];
            const std::span<const Point2> hatches = plane.hatches[part].span();
            out.append(part == 0 ? "{\"rings\":[" : ",{\"rings\":[");
            put_contours(layer, 0, layer.rings, out);
            if (layer.open_chains() > 0) {
                out.append("],\"chains\":[");
                put_contours(layer, layer.rings, layer.contours(), out);
            }
            out.append("]");
            if (!hatches.empty()) {
                out.append(",\"hatches\":");
                put_numbers(hatches, out);
            }
            out.append("}");
        }
        out.append("]}");
    }

    static void put_contours(const Layer& layer, std::size_t begin, std::size_t end, ByteBuffer& out) {
        for (std::size_t i = begin; i < end; ++i) {
            if (i > begin)
                out.append(",");
            put_numbers(layer.contour(i), out);
        }
    }

    std::string tail() override { return "\n]}\n"; }
};

} // namespace

std::unique_ptr<LayerWriter> open_layers_json(const std::string& path, const LayerFileInfo& info,
                                              const LayerWriteOptions& /*options*/) {
    return std::make_unique<LayersJsonWriter>(path, info);
}

} // namespace lamella
