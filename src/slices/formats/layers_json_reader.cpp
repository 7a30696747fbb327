#include "container/json_text.hpp"
#include "container/text_chunks.hpp"
#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "core/farthest.hpp"
#include "slices/engine/layer_readers.hpp"
#include "slices/engine/slice_engine.hpp"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace lamella {

namespace {

constexpr std::string_view format_name = "lamella layers";

void check_ascending(double below, double z, const JsonText& text) {
    if (!(below < z))
        text.fail(fmt::format("z = {} behind z = {}", z, below), "layers must ascend");
}

struct JsonLayer : RawLayer {
    std::optional<double> index; ///< if the file states it
    double bottom = 0;
    double top = 0;
    std::size_t end = 0; ///< offset at which it ends
};

/// Consecutive layers.
struct JsonPiece {
    std::vector<JsonLayer> layers = {};
    Findings found = {};
    std::exception_ptr error = nullptr; ///< the reason why the next layer is unreadable
    std::size_t stop = 0;               ///< offset of the next layer, or of the end of the array
    std::size_t end = 0;                ///< that of the next layer; behind the text if there is none
};

/// Reads a length in millimetres.
double length(JsonText& text) {
    const double value = text.number();
    if (is_too_far(value))
        text.fail(fmt::format("{}", value), fmt::format("lengths must lie within {} mm", farthest_mm));
    return value + 0.0;
}

/// Reads the layers of a piece.
class JsonPieceReader {
  public:
    JsonPieceReader(JsonText text, std::size_t parts, const Reading& reading)
        : text_(std::move(text)), parts_(parts), limits_(reading.limits), position_(reading, text_.at()) {}

    /// Reads layers up to the first one at or after `limit`.
    JsonPiece read(std::size_t limit) {
        try {
            bool more = true;
            do {
                read_layer();
                more = text_.next_element();
            } while (more && text_.at() < limit);
            piece_.stop = text_.at();
            piece_.end = more ? piece_.stop : std::string_view::npos;
        } catch (const Error&) {
            piece_.error = std::current_exception();
            piece_.end = std::string_view::npos;
        }
        position_.end(text_.at());
        return std::move(piece_);
    }

  private:
    void read_layer() {
        std::optional<double> z;
        std::optional<double> bottom;
        std::optional<double> top;
        JsonLayer layer;
        layer.begin = text_.at();
        std::uint32_t parts = 0;
        text_.object([&](const std::string& key) {
            if (key == "index")
                layer.index = text_.number();
            else if (key == "z")
                z = length(text_);
            else if (key == "bottom")
                bottom = length(text_);
            else if (key == "top")
                top = length(text_);
            else if (key == "parts")
                text_.array([&] { read_part(layer, parts++); });
            else
                text_.skip();
        });
        constexpr double most_index = 9e15;
        const double index = layer.index.value_or(0);
        if (!(index >= 0 && index <= most_index) || index != std::floor(index))
            text_.fail(fmt::format("the index {}", index), "it must be a whole number");
        if (!z || !bottom || !top || !(*bottom <= *z && *z <= *top))
            text_.fail("a layer that is not cut between its bottom and its top",
                       "z must lie between bottom and top");
        if (parts != parts_)
            text_.fail(fmt::format("a layer of {} parts", parts), fmt::format("the file has {}", parts_));
        if (!piece_.layers.empty())
            check_ascending(piece_.layers.back().z, *z, text_);
        layer.z = *z;
        layer.bottom = *bottom;
        layer.top = *top;
        layer.end = text_.at();
        limits_.make_room(piece_.layers, 1, at_byte(text_.at()));
        piece_.layers.push_back(std::move(layer));
    }

    void read_part(RawLayer& raw, std::uint32_t part) {
        if (part >= parts_)
            text_.fail(fmt::format("part {} of a layer", part + 1), fmt::format("the file has {}", parts_));
        text_.object([&](const std::string& key) {
            if (key == "rings" || key == "chains")
                text_.array([&] {
                    read_points(raw.points);
                    raw.end_contour(key == "rings", part, limits_, at_byte(text_.at()), piece_.found);
                });
            else if (key == "hatches")
                read_hatches(raw, part);
            else
                text_.skip();
        });
    }

    void read_hatches(RawLayer& raw, std::uint32_t part) {
        const std::size_t begin = raw.hatches.size();
        read_points(raw.hatches);
        if ((raw.hatches.size() - begin) % 2 != 0)
            text_.fail("half a hatch line", "each must have two points");
        raw.end_hatches(part, limits_, at_byte(text_.at()));
    }

    // Reads x and y alternately.
    void read_points(std::vector<Point2>& to) {
        bool half = false;
        text_.array([&] {
            const double value = length(text_);
            position_.reached(text_.at());
            if (half) {
                to.back().y = value;
            } else {
                limits_.make_room(to, 1, at_byte(text_.at()));
                to.push_back({value, 0});
            }
            half = !half;
        });
        if (half)
            text_.fail("an x without its y", "coordinates must come in pairs");
    }

    JsonText text_;
    std::size_t parts_; ///< number of those of the file
    ReadLimits& limits_;
    ReadPosition position_;
    JsonPiece piece_;
};

/// The list of layers in a document.
class JsonLayers {
  public:
    using Piece = JsonPiece;

    /// `text` is before the first layer. `file` has its parts, and must live until all layers are read.
    JsonLayers(std::string_view bytes, JsonText text, const LayerFile& file)
        : bytes_(bytes), name_(file.path), begin_(text.at()), depth_(text.depth()), parts_(file.parts.size()),
          file_(file), text_(std::move(text)) {}

    [[nodiscard]] PieceBegins begins(Executor& executor) const {
        return find_text_pieces(bytes_, begin_, beginning_of_layers(), executor).begins();
    }
    [[nodiscard]] std::size_t end() const { return bytes_.size(); }
    [[nodiscard]] JsonPiece parse(std::size_t begin, std::size_t limit, const Reading& reading) const {
        return JsonPieceReader(JsonText(bytes_, name_, begin, depth_), parts_, reading).read(limit);
    }
    [[nodiscard]] static RawLayer layer(JsonPiece&& piece) {
        if (piece.error) // such as a limit
            std::rethrow_exception(piece.error);
        return only_layer(std::move(piece.layers));
    }

    void append(JsonPiece&& piece, ReadLimits& limits) {
        for (std::size_t i = 0; i < piece.layers.size(); ++i) {
            JsonLayer& layer = piece.layers[i];
            text_.move_to(layer.end);
            if (i == 0 && !layers_.empty())
                check_ascending(layers_.back().z, layer.z, text_);
            check_part_planes(file_, layers_.size() + i + 1, bytes_.size());
            layer.index = layer.index.value_or(static_cast<double>(layers_.size() + i));
        }
        if (piece.error)
            std::rethrow_exception(piece.error);
        text_.move_to(piece.stop);
        found_.add(piece.found);
        append_layers(layers_, std::move(piece.layers), limits);
    }

    /// Returns the offset behind the layers.
    [[nodiscard]] std::size_t stop() const { return text_.at(); }
    [[nodiscard]] const Findings& found() const { return found_; }
    [[nodiscard]] std::vector<JsonLayer> take_layers() { return std::move(layers_); }

  private:
    /// Returns the text with which the first layer begins, up to the name of its first member. Other layers
    /// probably begin alike.
    [[nodiscard]] std::string_view beginning_of_layers() const {
        constexpr std::size_t longest = 256;
        const std::string_view text = bytes_.substr(begin_, longest);
        const std::size_t name = text.find('"');
        return text.substr(0, name == std::string_view::npos ? longest : text.find('"', name + 1));
    }

    std::string_view bytes_;
    std::string name_;
    std::size_t begin_;
    int depth_;
    std::size_t parts_;
    const LayerFile& file_;
    JsonText text_;
    std::vector<JsonLayer> layers_;
    Findings found_;
};

class LayersJsonReader {
  public:
    LayersJsonReader(std::string_view bytes, LayerFile& file, ReadLimits& limits, const Execution& execution)
        : bytes_(bytes), text_(bytes, file.path, after_byte_order_mark(bytes)), file_(file), limits_(limits),
          execution_(execution) {}

    void read() {
        limits_.keep_text_in_memory(bytes_.size());
        text_.object([&](const std::string& key) {
            if (key == "format")
                check_format();
            else if (key == "version")
                check_version();
            else if (key == "units")
                check_units();
            else if (key == "parts")
                read_parts();
            else if (key == "rule")
                read_rule();
            else if (key == "layers")
                read_layers();
            else
                text_.skip();
        });
        text_.end();
        if (!known_)
            text_.fail("no \"format\"", fmt::format("it must be \"{}\"", format_name));
        if (!layers_)
            text_.fail("no layer", "a slice file must have at least one");
        std::vector<JsonLayer> layers = layers_->take_layers();
        std::vector<PlacedLayer> planes;
        planes.reserve(layers.size());
        for (JsonLayer& layer : layers)
            planes.push_back(
                {&layer, static_cast<std::uint64_t>(*layer.index), layer.z, layer.bottom, layer.top});
        add_layers(file_, planes, limits_, execution_, parsing_again<JsonLayers>(layers_));
        append_to(layers_->found(), file_.warnings);
    }

  private:
    void check_format() {
        const std::string name = text_.string();
        if (name != format_name)
            text_.fail(fmt::format("the format '{}'", printable(name, 40)),
                       fmt::format("of JSON files, '{}' is read", format_name));
        known_ = true;
    }

    void check_version() {
        const double version = text_.number();
        if (version != 1)
            text_.fail(fmt::format("version {}", version), "version 1 is read");
    }

    void check_units() {
        if (const std::string units = text_.string(); units != "mm")
            text_.fail(fmt::format("units of '{}'", printable(units, 40)), "lengths are read in 'mm'");
    }

    void read_rule() {
        const std::string name = text_.string();
        const std::optional<PlaneRule> rule = plane_rule(name);
        if (!rule)
            text_.fail(fmt::format("the rule '{}'", printable(name, 40)),
                       "planes are cut by section_above or section_below");
        file_.rule = *rule;
    }

    // Parts precede the layers, because all have the same planes.
    void read_parts() {
        if (!file_.parts.empty())
            text_.fail("\"parts\" a second time", "they must come once, before the layers");
        ReadLabels labels;
        text_.array([&] {
            std::string label;
            text_.object([&](const std::string& key) {
                if (key == "label")
                    label = text_.string();
                else
                    text_.skip();
            });
            limits_.make_room(file_.parts, 1, at_byte(text_.at()));
            label = labels.of(label);
            file_.parts.push_back({.label = label, .box = {}, .exposure = labelled_exposure(label)});
        });
        labels.append_to(file_.warnings);
    }

    void read_layers() {
        if (!known_ || file_.parts.empty())
            text_.fail("layers", "\"format\" and \"parts\" must come before them");
        if (layers_)
            text_.fail("\"layers\" a second time", "they must come once");
        text_.array([&] {
            text_.skip_blanks();
            layers_ = std::make_shared<JsonLayers>(bytes_, text_, file_);
            read_layers_of(*layers_, limits_, execution_, bytes_.size());
            text_.move_to(layers_->stop());
        });
    }

    std::string_view bytes_;
    JsonText text_;
    LayerFile& file_;
    ReadLimits& limits_;
    const Execution& execution_;
    bool known_ = false;
    std::shared_ptr<JsonLayers> layers_;
};

} // namespace

bool is_json(std::string_view bytes) {
    const std::size_t first = bytes.find_first_not_of(" \t\r\n", after_byte_order_mark(bytes));
    return first != std::string_view::npos && bytes[first] == '{';
}

LayerFile read_layers_json(std::string_view bytes, const std::string& name, ReadLimits& limits,
                           const Execution& execution) {
    LayerFile file = layer_file(name, "json", 1);
    LayersJsonReader(bytes, file, limits, execution).read();
    return file;
}

} // namespace lamella
