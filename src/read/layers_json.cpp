#include "container/json_text.hpp"
#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "core/farthest.hpp"
#include "read/layer_assembly.hpp"
#include "read/layer_pieces.hpp"
#include "read/layer_readers.hpp"
#include "read/read_limits.hpp"
#include "read/text_chunks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <exception>
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
    DroppedContours dropped = {};
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
    JsonPieceReader(JsonText text, std::size_t parts, ReadLimits& limits, const Executor& executor,
                    ProgressMeter& progress)
        : text_(std::move(text)), parts_(parts), limits_(limits), executor_(executor), progress_(progress),
          reported_(text_.at()) {}

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
        report_progress();
        drop_contents(piece_.layers, limits_);
        return std::move(piece_);
    }

  private:
    void read_layer() {
        executor_.check_cancelled();
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
        report_progress();
    }

    void report_progress() {
        progress_.add(text_.at() - reported_);
        reported_ = text_.at();
    }

    void read_part(RawLayer& raw, std::uint32_t part) {
        if (part >= parts_)
            text_.fail(fmt::format("part {} of a layer", part + 1), fmt::format("the file has {}", parts_));
        text_.object([&](const std::string& key) {
            if (key == "rings" || key == "chains")
                text_.array([&] {
                    read_points(raw.points);
                    raw.end_contour(key == "rings", part, limits_, at_byte(text_.at()), piece_.dropped);
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
            constexpr std::size_t chunk = std::size_t{1} << 22;
            if (text_.at() - reported_ > chunk) {
                executor_.check_cancelled();
                report_progress();
            }
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
    const Executor& executor_;
    ProgressMeter& progress_;
    std::size_t reported_;
    JsonPiece piece_;
};

class LayersJsonReader {
  public:
    LayersJsonReader(std::string_view bytes, LayerFile& file, ReadLimits& limits, const Execution& execution)
        : bytes_(bytes), text_(bytes, file.path, after_byte_order_mark(bytes)), file_(file), limits_(limits),
          executor_(execution), progress_(execution, Stage::read, bytes.size()) {}

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
        if (layers_.empty())
            text_.fail("no layer", "a slice file must have at least one");
        std::vector<PlacedLayer> planes;
        planes.reserve(layers_.size());
        for (JsonLayer& layer : layers_)
            planes.push_back(
                {&layer, static_cast<std::uint64_t>(*layer.index), layer.z, layer.bottom, layer.top});
        add_layers(file_, planes, limits_, executor_,
                   [bytes = bytes_, name = file_.path, depth = depth_of_layers_,
                    parts = file_.parts.size()](std::size_t begin, ReadLimits& limits) {
                       const Execution silent{.threads = 1};
                       const Executor executor(silent);
                       ProgressMeter progress(silent, Stage::read, bytes.size());
                       return only_layer(JsonPieceReader(JsonText(bytes, name, begin, depth), parts, limits,
                                                         executor, progress)
                                             .read(begin + 1)
                                             .layers);
                   });
        dropped_.append_to(file_.warnings);
        progress_.finish();
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
            file_.parts.push_back({label, {}, labelled_exposure(label)});
        });
        labels.append_to(file_.warnings);
    }

    void read_layers() {
        if (!known_ || file_.parts.empty())
            text_.fail("layers", "\"format\" and \"parts\" must come before them");
        if (!layers_.empty())
            text_.fail("\"layers\" a second time", "they must come once");
        text_.array([&] {
            text_.skip_blanks();
            depth_of_layers_ = text_.depth();
            const PieceBegins begins =
                find_text_pieces(bytes_, text_.at(), beginning_of_layers(), executor_).begins();
            read_pieces(
                begins, bytes_.size(), executor_,
                [&](std::size_t begin, std::size_t limit) {
                    return JsonPieceReader(JsonText(bytes_, file_.path, begin, text_.depth()),
                                           file_.parts.size(), limits_, executor_, progress_)
                        .read(limit);
                },
                [&](JsonPiece&& piece) { take(std::move(piece)); });
        });
    }

    /// Returns the text with which the first layer begins, up to the name of its first member. Other layers
    /// probably begin alike.
    [[nodiscard]] std::string_view beginning_of_layers() const {
        constexpr std::size_t longest = 256;
        const std::string_view text = bytes_.substr(text_.at(), longest);
        const std::size_t name = text.find('"');
        return text.substr(0, name == std::string_view::npos ? longest : text.find('"', name + 1));
    }

    void take(JsonPiece&& piece) {
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
        dropped_.add(piece.dropped);
        append_layers(layers_, std::move(piece.layers), limits_);
    }

    std::string_view bytes_;
    JsonText text_;
    LayerFile& file_;
    ReadLimits& limits_;
    Executor executor_;
    ProgressMeter progress_;
    bool known_ = false;
    int depth_of_layers_ = 0;
    std::vector<JsonLayer> layers_;
    DroppedContours dropped_;
};

} // namespace

bool is_json(std::string_view bytes) {
    const std::size_t first = bytes.find_first_not_of(" \t\r\n", after_byte_order_mark(bytes));
    return first != std::string_view::npos && bytes[first] == '{';
}

LayerFile read_layers_json(std::string_view bytes, const std::string& name, ReadLimits& limits,
                           const Execution& execution) {
    LayerFile file{.path = name, .format = "json", .units_mm = 1};
    LayersJsonReader(bytes, file, limits, execution).read();
    return file;
}

} // namespace lamella
