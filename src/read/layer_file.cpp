#include "lamella/read/layer_file.hpp"

#include "lamella/core/error.hpp"

#include "container/byte_source.hpp"
#include "container/text_place.hpp"
#include "read/common_layer.hpp"
#include "read/layered_svg.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace lamella {

namespace {

LayerFile read_source(const ByteSource& source, const Execution& execution) {
    const std::string_view bytes(reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size());
    if (is_common_layer(bytes))
        return read_common_layer(bytes, source.name, execution);
    if (is_svg(bytes))
        return read_layered_svg(bytes, source.name, execution);
    throw Error(
        ErrorKind::input,
        fmt::format("{}: found '{}' at its beginning; a slice file is expected: Common Layer Interface "
                    "($$HEADERSTART) or layered SVG (<svg)",
                    source.name, printable(bytes.substr(0, 16), 48)));
}

} // namespace

LayerStack LayerFile::merged() const {
    if (parts.size() == 1)
        return parts.front().layers;
    LayerStack all;
    for (std::size_t i = 0; !parts.empty() && i < parts.front().layers.size(); ++i) {
        const Layer& first = parts.front().layers[i];
        LayerBuilder builder;
        std::vector<Point2> hatches;
        for (const LayerPart& part : parts) {
            const Layer& layer = part.layers[i];
            for (std::size_t k = 0; k < layer.contours(); ++k) {
                for (const Point2& p : layer.contour(k))
                    builder.add_point(p);
                builder.end_contour(layer.closed(k));
            }
            hatches.insert(hatches.end(), layer.hatches.begin(), layer.hatches.end());
        }
        all.push_back(builder.finish(first.index, first.z, first.bottom, first.top));
        all.back().hatches = PointArray(std::move(hatches));
    }
    return all;
}

LayerFile read_layers(const std::string& path, const Execution& execution) {
    return read_source(open_bytes(path, execution.cancel), execution);
}

LayerFile read_layers(std::span<const std::byte> bytes, const std::string& name, const Execution& execution) {
    return read_source(copy_bytes(bytes, name), execution);
}

} // namespace lamella
