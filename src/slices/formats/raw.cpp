// Each layer is a header of seven numbers and its arrays, as memory has them, so that programs take layers
// from a pipe as they come, without parsing numbers.

#include "container/quoted.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/engine/sequential_writer.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as memory has them");

constexpr std::size_t alignment = 8; ///< of layers and of doubles in them

template <class T>
void append_values(std::span<const T> values, ByteBuffer& out) {
    out.append({reinterpret_cast<const char*>(values.data()), values.size_bytes()});
}

void pad(ByteBuffer& out) {
    static constexpr char zeros[alignment] = {};
    out.append({zeros, (alignment - out.view().size() % alignment) % alignment});
}

class RawWriter final : public SequentialWriter {
  public:
    RawWriter(const std::string& path, const LayerFileInfo& info)
        : SequentialWriter(path, info, header(info), {.hatches = true, .written_label = quotable}) {}

  private:
    static std::string header(const LayerFileInfo& info) {
        std::string text = fmt::format("{{\"units\":\"mm\",\"layers\":{},\"parts\":[", info.layers);
        for (const PartInfo& part : info.parts)
            text += fmt::format("{{\"label\":{}}},", json_quoted(part.label));
        text.back() = ']';
        text += fmt::format(",\"rule\":\"{}\"}}", plane_rule_name(info.rule));
        text.resize((text.size() + alignment - 1) / alignment * alignment, ' ');
        return "lamella\n" + bytes_of(std::uint64_t{text.size()}) + text;
    }

    std::string layer_header(const PlanePosition& place) override {
        return bytes_of(place.index) + bytes_of(place.z) + bytes_of(place.bottom) + bytes_of(place.top);
    }

    void format(const Plane& plane, ByteBuffer& out) const override {
        std::uint64_t contours = 0;
        std::uint64_t points = 0;
        std::uint64_t lines = 0;
        for (std::size_t part = 0; part < plane.polylines.size(); ++part) {
            contours += plane.polylines[part].contours();
            points += plane.polylines[part].points.size();
            lines += plane.hatches[part].span().size() / 2;
        }
        out.append(bytes_of(contours) + bytes_of(points) + bytes_of(lines));
        for (const Layer& layer : plane.polylines)
            append_values(layer.points.span(), out);
        for (std::size_t part = 0; part < plane.polylines.size(); ++part)
            append_values(plane.hatches[part].span(), out);
        put_ends(plane, out);
        pad(out);
    }

    /// The number of points up to the end of each contour, the part of each, the part of each hatch line, and
    /// whether each contour is a ring.
    static void put_ends(const Plane& plane, ByteBuffer& out) {
        std::vector<std::uint32_t> ends;
        std::vector<std::uint32_t> contour_parts;
        std::vector<std::uint32_t> line_parts;
        std::string closed;
        std::uint64_t before = 0;
        for (std::size_t part = 0; part < plane.polylines.size(); ++part) {
            const Layer& layer = plane.polylines[part];
            for (std::size_t i = 1; i < layer.offsets.size(); ++i)
                ends.push_back(static_cast<std::uint32_t>(before + layer.offsets[i]));
            before += layer.points.size();
            contour_parts.resize(ends.size(), static_cast<std::uint32_t>(part));
            line_parts.resize(line_parts.size() + plane.hatches[part].span().size() / 2,
                              static_cast<std::uint32_t>(part));
            closed.append(layer.rings, '\1').append(layer.open_chains(), '\0');
        }
        append_values(std::span<const std::uint32_t>(ends), out);
        append_values(std::span<const std::uint32_t>(contour_parts), out);
        append_values(std::span<const std::uint32_t>(line_parts), out);
        out.append(closed);
    }
};

} // namespace

std::unique_ptr<LayerWriter> open_raw(const std::string& path, const LayerFileInfo& info,
                                      const LayerWriteOptions& /*options*/) {
    return std::make_unique<RawWriter>(path, info);
}

} // namespace lamella
