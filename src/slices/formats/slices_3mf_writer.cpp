// The package has one model. For each part of the file, it contains a slice stack and an object that uses the
// stack. The stacks come before the objects, because readers read the model once from begin to end. A layer
// is formatted and compressed in `prepare` and only appended in order.

#include "lamella/contour/measure.hpp"

#include "container/byte_buffer.hpp"
#include "container/byte_store.hpp"
#include "container/decimal.hpp"
#include "container/quoted.hpp"
#include "slices/engine/grid.hpp"
#include "slices/engine/layer_writers.hpp"
#include "slices/engine/written_heights.hpp"
#include "slices/formats/package_3mf.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

namespace {

constexpr std::string_view model_begin =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<model unit=\"millimeter\" xml:lang=\"en-US\" "
    "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
    "xmlns:s=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\" requiredextensions=\"s\">\n"
    "<resources>\n";

/// One <s:slice>.
void put_slice(const Layer& layer, const WriterGrid& grid, ByteBuffer& out) {
    out.append(fmt::format("<s:slice ztop=\"{}\"", decimal_text(layer.top)));
    constexpr std::string_view x_before = "<s:vertex x=\"";
    constexpr std::string_view y_before = "\" y=\"";
    constexpr std::string_view vertex_end = "\"/>\n";
    constexpr std::size_t per_vertex =
        x_before.size() + y_before.size() + vertex_end.size() + 2 * (most_integer_digits + 6);
    std::vector<std::size_t> ends; // index of the vertex after each ring
    std::vector<GridPoint> scratch;
    std::size_t vertices = 0;
    for (std::size_t i = 0; i < layer.rings; ++i) {
        const auto points =
            grid.snap(layer.contour(i), true, ring_area(layer.contour(i)), layer.index, scratch);
        if (points.empty())
            continue;
        if (vertices == 0)
            out.append(">\n<s:vertices>\n");
        char* at = out.room(points.size() * per_vertex);
        for (const GridPoint& p : points) {
            at = put_thousandths(put_text(at, x_before), p.x);
            at = put_thousandths(put_text(at, y_before), p.y);
            at = put_text(at, vertex_end);
        }
        out.end_at(at);
        vertices += points.size();
        ends.push_back(vertices);
    }
    if (vertices == 0) {
        out.append("/>\n");
        return;
    }
    out.append("</s:vertices>\n");
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
        constexpr std::string_view before = "<s:segment v2=\"";
        constexpr std::string_view after = "\"/>\n";
        out.append(fmt::format("<s:polygon startv=\"{}\">\n", begin));
        char* at = out.room((end - begin) * (before.size() + most_integer_digits + after.size()));
        for (std::size_t v = begin + 1; v < end; ++v)
            at = put_text(put_integer(put_text(at, before), std::uint64_t{v}), after);
        at = put_text(put_integer(put_text(at, before), std::uint64_t{begin}), after);
        out.end_at(at);
        out.append("</s:polygon>\n");
        begin = end;
    }
    out.append("</s:slice>\n");
}

class Slices3mfWriter final : public package_3mf::PackageWriter {
  public:
    Slices3mfWriter(const std::string& path, const LayerFileInfo& info)
        : PackageWriter(path, info,
                        {.open_chains = false, .gaps = false, .written_label = quotable, .supports = true}),
          info_(info) {
        heights_.add(in_text(info.bottom), info.bottom, "bottom", 0);
        zip().begin("3D/3dmodel.model", ZipMethod::deflated);
        append(std::string(model_begin) + stack_begin(0));
    }

    std::uint64_t bytes() const noexcept override {
        return PackageWriter::bytes() + (ended_ ? 0 : waiting_.size());
    }

  private:
    /// A chunk of a stack that waits.
    struct Later {
        std::uint64_t position; ///< in waiting_
        std::uint64_t bytes;
        std::uint64_t size; ///< as text
        std::uint64_t crc;
    };

    /// Returns a height rounded to nine decimals, in billionths of a millimetre.
    static double in_text(double mm) { return std::nearbyint(mm * 1e9); }

    static constexpr std::string_view stack_end = "</s:slicestack>\n";

    Write formatted(const Plane& plane) override {
        const std::shared_ptr<ByteBuffer> text = buffer();
        auto chunks = std::make_shared<std::vector<package_3mf::Chunk>>();
        for (const Layer& layer : plane.polylines) {
            text->clear();
            put_slice(layer, grid_, *text);
            chunks->push_back(compressed(text->view()));
        }
        return [this, chunks](const PlanePosition& position, Completions& after) {
            heights_.add(in_text(position.top), position.top, "top", position.index);
            zip().append(chunks->front().in_zip(), chunks, after);
            for (std::size_t part = 1; part < chunks->size(); ++part) {
                const package_3mf::Chunk& chunk = (*chunks)[part];
                const Later later{waiting_.size(), chunk.bytes.size(), chunk.size, chunk.crc};
                later_.add({reinterpret_cast<const char*>(&later), sizeof later});
                waiting_.add(chunk.bytes);
            }
        };
    }

    void end_file() override {
        ended_ = true;
        append(stack_end);
        const std::size_t parts = info_.parts.size();
        std::string bytes;
        for (std::size_t part = 1; part < parts; ++part) {
            append(stack_begin(part));
            for (std::uint64_t at = (part - 1) * sizeof(Later); at < later_.size();
                 at += (parts - 1) * sizeof(Later)) {
                Later chunk{};
                later_.read(at, {reinterpret_cast<char*>(&chunk), sizeof chunk});
                bytes.resize(chunk.bytes);
                waiting_.read(chunk.position, bytes);
                zip().append({bytes, chunk.size, static_cast<std::uint32_t>(chunk.crc)});
            }
            append(stack_end);
        }
        std::string items;
        for (std::size_t part = 0; part < info_.parts.size(); ++part) {
            const PartInfo& known = info_.parts[part];
            append(fmt::format("<object id=\"{}\" type=\"{}\" name=\"{}\" s:slicestackid=\"{}\" "
                               "s:meshresolution=\"lowres\">\n{}</object>\n",
                               object_id(part), known.support ? "solidsupport" : "model",
                               xml_escaped(known.label), stack_id(part),
                               package_3mf::box_mesh(known.box.empty() ? info_.box : known.box)));
            items += fmt::format("<item objectid=\"{}\"/>\n", object_id(part));
        }
        append(fmt::format("</resources>\n<build>\n{}</build>\n</model>\n", items));
        zip().end();
        zip().finish();
    }

    [[nodiscard]] static std::size_t stack_id(std::size_t part) { return part + 1; }
    [[nodiscard]] std::size_t object_id(std::size_t part) const { return info_.parts.size() + part + 1; }
    [[nodiscard]] std::string stack_begin(std::size_t part) const {
        return fmt::format("<s:slicestack id=\"{}\" zbottom=\"{}\">\n", stack_id(part),
                           decimal_text(info_.bottom));
    }

    void append(std::string_view text) { zip().append(compressed(text).in_zip()); }

    LayerFileInfo info_;
    WriterGrid grid_{text_step_mm, &rounding_loss()};
    /// The stacks of all parts except the first one, plane by plane. They wait until that is complete.
    ByteStore waiting_;
    ByteStore later_; ///< a Later for each chunk in waiting_
    bool ended_ = false;
    WrittenHeights heights_{"billionths of a millimetre", 1e-9, rounding_loss()};
};

} // namespace

std::unique_ptr<LayerWriter> open_slices_3mf(const std::string& path, const LayerFileInfo& info,
                                             const LayerWriteOptions& /*options*/) {
    return std::make_unique<Slices3mfWriter>(path, info);
}

} // namespace lamella
