#include "lamella/contour/measure.hpp"

#include "container/decimal.hpp"
#include "slices/engine/grid.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/engine/sequential_writer.hpp"

#include <fmt/format.h>

#include <string_view>
#include <vector>

namespace lamella {

namespace {

std::string length_text(double mm) {
    return decimal_text(mm, 9, 1);
}

class DxfWriter final : public SequentialWriter {
  public:
    DxfWriter(const std::string& path, const LayerFileInfo& info)
        : SequentialWriter(path, info, header(info), {.labels = false}), several_(info.parts.size() > 1) {}

  private:
    // Release 12 needs neither tables nor handles. It has no units; but readers look for $INSUNITS
    // nevertheless, and assume metres if it is absent.
    static std::string header(const LayerFileInfo& info) {
        const auto corner = [](std::string_view name, const Point3& p) {
            return fmt::format("  9\n{}\n 10\n{}\n 20\n{}\n 30\n{}\n", name, length_text(p.x),
                               length_text(p.y), length_text(p.z));
        };
        return "  0\nSECTION\n  2\nHEADER\n  9\n$ACADVER\n  1\nAC1009\n  9\n$INSUNITS\n 70\n4\n" +
               corner("$EXTMIN", info.box.min) + corner("$EXTMAX", info.box.max) +
               "  0\nENDSEC\n  0\nSECTION\n  2\nENTITIES\n";
    }

    std::string layer_header(const PlanePosition&) override { return {}; }

    void format(const Plane& plane, ByteBuffer& out) const override {
        for (std::size_t part = 0; part < plane.polylines.size(); ++part)
            format_part(plane.polylines[part], part, out);
    }

    // Returns a name of at most 31 letters, digits and underscores.
    [[nodiscard]] std::string layer_name(std::uint64_t index, std::size_t part) const {
        return several_ ? fmt::format("PART_{}_LAYER_{:05}", part + 1, index)
                        : fmt::format("LAYER_{:05}", index);
    }

    void format_part(const Layer& layer, std::size_t part, ByteBuffer& out) const {
        const std::string name = layer_name(layer.index, part);
        const std::string z = length_text(layer.z);
        const std::string end = fmt::format("  0\nSEQEND\n  8\n{}\n", name);
        const std::string vertex = fmt::format("  0\nVERTEX\n  8\n{}\n 10\n", name);
        const std::string vertex_end = fmt::format("\n 30\n{}\n", z);
        std::vector<GridPoint> scratch;
        for (std::size_t i = 0; i < layer.contours(); ++i) {
            const bool closed = layer.closed(i);
            const double area = closed ? ring_area(layer.contour(i)) : 0;
            const auto points = grid_.snap(layer.contour(i), closed, area, layer.index, scratch);
            if (points.empty())
                continue;
            out.append(fmt::format("  0\nPOLYLINE\n  8\n{}\n 66\n1\n 70\n{}\n 10\n0.0\n 20\n0.0\n 30\n{}\n",
                                   name, closed ? 1 : 0, z));
            constexpr std::size_t most_per_number = most_integer_digits + 6;
            char* at =
                out.room(points.size() * (vertex.size() + 2 * most_per_number + 8 + vertex_end.size()));
            for (const GridPoint& p : points) {
                at = put_real_thousandths(put_text(at, vertex), p.x);
                at = put_real_thousandths(put_text(at, "\n 20\n"), p.y);
                at = put_text(at, vertex_end);
            }
            out.end_at(at);
            out.append(end);
        }
    }

    std::string tail() override { return "  0\nENDSEC\n  0\nEOF\n"; }

    bool several_;
    WriterGrid grid_{text_step_mm, &rounding_loss()};
};

} // namespace

std::unique_ptr<LayerWriter> open_dxf(const std::string& path, const LayerFileInfo& info,
                                      const LayerWriteOptions& /*options*/) {
    return std::make_unique<DxfWriter>(path, info);
}

} // namespace lamella
