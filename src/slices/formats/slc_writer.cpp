#include "lamella/core/error.hpp"

#include "container/decimal.hpp"
#include "slices/engine/float_contour.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/engine/sequential_writer.hpp"
#include "slices/engine/written_heights.hpp"
#include "slices/formats/slc_format.hpp"

#include <fmt/format.h>

#include <bit>

namespace lamella {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as memory has them");

float single(double mm) {
    return static_cast<float>(mm) + 0.0F;
}

class SlcWriter final : public SequentialWriter {
  public:
    SlcWriter(const std::string& path, const LayerFileInfo& info)
        : SequentialWriter(path, info, header(info), {.open_chains = false, .gaps = false, .labels = false}),
          bottom_(info.bottom) {}

  private:
    // Returns a single line that ends with a space. Otherwise readers that split the line at spaces would
    // append the line end to the last number.
    static std::string header(const LayerFileInfo& info) {
        const Box3& box = info.box;
        const auto range = [](double low, double high) {
            return decimal_text(low, 6, 6) + ',' + decimal_text(high, 6, 6) + ' ';
        };
        return "-SLCVER 2.0 -UNIT MM -TYPE PART -PACKAGE LAMELLA -EXTENTS " + range(box.min.x, box.max.x) +
               range(box.min.y, box.max.y) + range(box.min.z, box.max.z) + "\r\n\x1a" +
               std::string(slc::reserved, '\0');
    }

    // Returns a table with one entry. Since every layer is in the file, heights are unambiguous even if
    // thicknesses differ.
    static std::string sampling_table(double bottom, double thickness) {
        constexpr float line_width_compensation = 0;
        constexpr float unused = 0;
        std::string table(1, '\1');
        for (const float value : {single(bottom), single(thickness), line_width_compensation, unused})
            table += bytes_of(value);
        return table;
    }

    std::string layer_header(const PlanePosition& plane) override {
        std::string bytes;
        if (plane.position == 0)
            bytes = sampling_table(plane.bottom, plane.top - plane.bottom);
        heights_.add(single(plane.bottom), plane.bottom, "bottom", plane.index);
        bytes += bytes_of(single(plane.bottom));
        last_ = plane;
        return bytes;
    }

    void format(const Plane& plane, ByteBuffer& out) const override {
        std::size_t room = sizeof(std::uint32_t);
        for (const Layer& layer : plane.polylines)
            room +=
                layer.rings * (boundary_header + float_point_size) + layer.points.size() * float_point_size;
        char* const begin = out.room(room);
        char* at = begin + sizeof(std::uint32_t);
        std::size_t boundaries = 0;
        for (const Layer& layer : plane.polylines) {
            for (std::size_t i = 0; i < layer.rings; ++i) {
                const FloatContour listed =
                    floats_.put(layer.contour(i), true, layer.index, at + boundary_header);
                if (listed.points == 0)
                    continue;
                put_count(at, listed.points, layer.index);
                put_count(at + sizeof(std::uint32_t), 0, layer.index); // gaps
                at += boundary_header + listed.points * float_point_size;
                ++boundaries;
            }
        }
        put_count(begin, boundaries, plane.polylines.front().index);
        out.end_at(at);
    }

    std::string tail() override {
        if (heights_.empty())
            return sampling_table(bottom_, 0) + bytes_of(single(bottom_)) + bytes_of(slc::no_more_layers);
        heights_.add(single(last_.top), last_.top, "top", last_.index);
        std::string bytes = bytes_of(single(last_.top));
        bytes += bytes_of(slc::no_more_layers);
        return bytes;
    }

    static void put_count(char* out, std::size_t count, std::uint64_t layer) {
        if (count >= slc::no_more_layers)
            throw Error(ErrorKind::limit,
                        fmt::format("layer {} has {} points or contours at a place where the format counts "
                                    "to 2^32 - 2",
                                    layer, count));
        put_value(out, static_cast<std::uint32_t>(count));
    }

    static constexpr std::size_t boundary_header = 2 * sizeof(std::uint32_t);

    FloatContours floats_{1.0, &rounding_loss()};
    double bottom_;
    PlanePosition last_;
    WrittenHeights heights_{"single precision", 1, rounding_loss()};
};

} // namespace

std::unique_ptr<LayerWriter> open_slc(const std::string& path, const LayerFileInfo& info,
                                      const LayerWriteOptions& /*options*/) {
    return std::make_unique<SlcWriter>(path, info);
}

} // namespace lamella
